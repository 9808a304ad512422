#!/usr/bin/env python3
"""An independent Siemens 3964(R) station, to test other implementations against.

Derived from the published description of the procedure alone (Siemens point-to-point manuals:
frame, times, counters, transmitter, receiver, initialisation conflict), not from any other
program, so that a misreading on one side shows as a disagreement between the two. `Station` is
the procedure without input or output: symbols and the time in milliseconds go in, bytes and
event lines come out. `Port` and `run` connect it to a terminal device.

Where the manuals leave a choice, this station decides:

* ZVZ elapsed in a block: NAK, then idle; neither BWZ nor the counter of rejected blocks runs on.
* Own jobs wait while a repeat is expected (BWZ) and while noise dies away.
* A bad answer to STX or to a block: the rest of the same read is dropped, so that one burst
  costs one attempt; only a STX in it is heeded, and only by the low priority.
* A request that yielded in a collision spends a setup attempt; a good reception refunds it.
* The cause reported with a failure is the first error of the job; BREAK fails the running job.

Standard input takes one job per line in hexadecimal ("-" is the empty telegram, blank lines are
skipped). Event lines on standard output:

    received [HEX ..]                   a telegram, payload only
    sent LENGTH                         a job acknowledged
    failed setup|transfer CAUSE COUNT   a job given up; timeout nak char early-dle line break ..
    error CAUSE                         bcc dle line overflow zvz noise nobuf break
    receive-failed bwz|attempts COUNT   no (good) repeat after COUNT rejected blocks
    collision COUNT                     STX met STX, COUNT times with no telegram in between
"""
from __future__ import annotations

import argparse
import enum
import fcntl
import os
import random
import select
import struct
import sys
import termios
import time
from collections import deque
from dataclasses import dataclass, replace
from functools import reduce
from operator import xor
from typing import Deque, Iterable, List, Optional, Tuple

STX, ETX, DLE, NAK = 0x02, 0x03, 0x10, 0x15
LINE_ERROR = 0x100  # flag on a symbol: received with a parity, framing or overrun error
BREAK = 0x200  # a symbol of its own


@dataclass(frozen=True)
class Config:
    """Times in milliseconds; `setup_attempts` and `transfer_attempts` are totals."""

    high: bool = False
    with_bcc: bool = True
    qvz: int = 2000
    zvz: int = 220
    bwz: int = 4000
    setup_attempts: int = 6
    transfer_attempts: int = 6
    max_block: int = 1024

    @property
    def buffer_wait(self) -> int:
        return min(400, self.qvz - 10)


@dataclass
class Job:
    payload: bytes
    setups: int = 0  # STX sent for the present block
    blocks: int = 0  # blocks begun
    cause: Optional[str] = None  # the first error


class State(enum.Enum):
    IDLE = enum.auto()
    NOISE = enum.auto()  # something unexpected came in idle: wait for silence
    NO_BUFFER = enum.auto()  # STX seen, nowhere to put the block yet
    DATA = enum.auto()
    AFTER_DLE = enum.auto()  # the last byte of the block was an unpaired DLE
    CHECK = enum.auto()  # DLE ETX seen, the BCC is due
    SETUP = enum.auto()  # STX sent, DLE awaited
    SENDING = enum.auto()
    DISTURBED = enum.auto()  # the partner interrupted our block: wait for silence
    ANSWER = enum.auto()  # block sent, DLE awaited
    RETRY = enum.auto()  # an attempt failed: the next begins when this input is used up


RECEIVING = (State.DATA, State.AFTER_DLE, State.CHECK)
TRANSMITTING = (State.SETUP, State.SENDING, State.DISTURBED, State.ANSWER, State.RETRY)


def encode(payload: bytes, with_bcc: bool) -> bytes:
    """The block as it stands on the wire behind the STX."""
    body = payload.replace(b"\x10", b"\x10\x10") + bytes((DLE, ETX))
    return body + bytes((reduce(xor, body),)) if with_bcc else body


class Station:
    """One end of the link. Call `drained` whenever all of `output` has left the station."""

    def __init__(self, config: Config) -> None:
        self.config = config
        self.state = State.IDLE
        self.output = bytearray()
        self.purge = False  # bytes already handed over are void, too
        self.events: List[str] = []
        self.jobs: Deque[Job] = deque()
        self.buffer_free = True
        self.received = 0
        self.failed = 0
        self._timer: Optional[int] = None
        self._repeat_due: Optional[int] = None  # end of BWZ
        self._rejected = 0
        self._collisions = 0
        self._payload = bytearray()
        self._check = 0
        self._fault: Optional[str] = None

    def start(self) -> None:
        """Bring the partner to idle; for the start-up of a station."""
        self.output.append(NAK)

    def send(self, payload: bytes, now: int) -> None:
        self.jobs.append(Job(payload))
        self._settle(now)

    def set_buffer_free(self, free: bool, now: int) -> None:
        self.buffer_free = free
        if free and self.state is State.NO_BUFFER:
            self._open_block(now)

    def deadline(self) -> Optional[int]:
        return min((t for t in (self._timer, self._repeat_due) if t is not None), default=None)

    def receive(self, symbols: Iterable[int], now: int) -> None:
        """What one read delivered: bytes, or byte values marked LINE_ERROR, or BREAK."""
        for symbol in symbols:
            if symbol == BREAK:
                self._break()
            elif self.state in RECEIVING:
                self._on_block(symbol, now)
            elif self.state in TRANSMITTING:
                self._on_answer(symbol, now)
            else:
                self._on_idle(symbol, now)
        self._settle(now)

    def tick(self, now: int) -> None:
        if self._repeat_due is not None and self._repeat_due <= now:
            self.events.append(f"receive-failed bwz {self._rejected}")
            self._repeat_due, self._rejected = None, 0
        if self._timer is not None and self._timer <= now:
            self._expire()
        self._settle(now)

    def drained(self, now: int) -> None:
        if self.state is State.SENDING and not self.output:
            self._enter(State.ANSWER, now + self.config.qvz)

    def _enter(self, state: State, timer: Optional[int] = None) -> None:
        self.state, self._timer = state, timer

    def _refuse(self, cause: str) -> None:
        self.output.append(NAK)
        self.events.append(f"error {cause}")
        self._enter(State.IDLE)

    def _expire(self) -> None:
        if self.state is State.NOISE:
            self._refuse("noise")
        elif self.state is State.NO_BUFFER:
            self._refuse("nobuf")
        elif self.state in RECEIVING:
            self._rejected = 0
            self._refuse("zvz")
        elif self.state is State.SETUP:
            self._retry("timeout")
        elif self.state is State.ANSWER:
            self._retry("timeout", block_lost=True)
        elif self.state is State.DISTURBED:
            if self.jobs[0].blocks < self.config.transfer_attempts:
                self.output.append(NAK)  # else giving up sends it
            self._enter(State.RETRY)

    def _break(self) -> None:
        self.events.append("error break")
        if self.state in TRANSMITTING:
            self.jobs[0].cause = self.jobs[0].cause or "break"
            self._withdraw_block()
            self._give_up("setup" if self.state is State.SETUP else "transfer")
        self._repeat_due, self._rejected = None, 0
        self._enter(State.IDLE)

    # Receiver

    def _on_idle(self, symbol: int, now: int) -> None:
        if self.state is State.NOISE:
            self._timer = now + self.config.zvz
        elif symbol == STX:
            if self.state is State.IDLE:
                self._on_request(now)
        elif symbol == NAK:
            self._enter(State.IDLE)
        else:
            self._enter(State.NOISE, now + self.config.zvz)

    def _on_request(self, now: int) -> None:
        self._repeat_due = None
        if self.buffer_free:
            self._open_block(now)
        else:
            self._enter(State.NO_BUFFER, now + self.config.buffer_wait)

    def _open_block(self, now: int) -> None:
        self._payload.clear()
        self._check, self._fault = 0, None
        self.output.append(DLE)
        self._enter(State.DATA, now + self.config.zvz)

    def _on_block(self, symbol: int, now: int) -> None:
        value = symbol & 0xFF
        if symbol & LINE_ERROR:
            self._note("line")
        self._timer = now + self.config.zvz
        if self.state is State.CHECK:
            if value != self._check:
                self._note("bcc")
            self._close_block(now)
            return
        self._check ^= value
        if self.state is State.DATA and value == DLE:
            self.state = State.AFTER_DLE
        elif self.state is State.AFTER_DLE and value == ETX:
            self.state = State.CHECK
            if not self.config.with_bcc:
                self._close_block(now)
        else:
            if self.state is State.AFTER_DLE and value != DLE:
                self._note("dle")
            self.state = State.DATA
            if len(self._payload) < self.config.max_block:
                self._payload.append(value)
            else:
                self._note("overflow")

    def _note(self, fault: str) -> None:
        self._fault = self._fault or fault

    def _close_block(self, now: int) -> None:
        if self._fault is not None:
            self._refuse(self._fault)
            self._rejected += 1
            if self._rejected < self.config.transfer_attempts:
                self._repeat_due = now + self.config.bwz
            else:
                self.events.append(f"receive-failed attempts {self._rejected}")
                self._rejected = 0
            return
        self.output.append(DLE)
        self.events.append(" ".join(["received"] + [f"{byte:02X}" for byte in self._payload]))
        self.received += 1
        self._rejected = self._collisions = 0
        if self.jobs:
            self.jobs[0].setups = 0
        self._enter(State.IDLE)

    # Transmitter

    def _settle(self, now: int) -> None:
        """Begin what is due now that the input is used up."""
        while self.state is State.RETRY or (
            self.state is State.IDLE and self.jobs and self._repeat_due is None
        ):
            job = self.jobs[0]
            if job.blocks >= self.config.transfer_attempts:
                self.output.append(NAK)
                self._give_up("transfer")
            elif job.setups >= self.config.setup_attempts:
                self.output.append(NAK)
                self._give_up("setup")
            else:
                job.setups += 1
                self.output.append(STX)
                self._enter(State.SETUP, now + self.config.qvz)

    def _give_up(self, phase: str) -> None:
        job = self.jobs.popleft()
        count = job.setups if phase == "setup" else job.blocks
        self.events.append(f"failed {phase} {job.cause or 'collision'} {count}")
        self.failed += 1
        self._enter(State.IDLE)

    def _retry(self, cause: str, block_lost: bool = False) -> None:
        job = self.jobs[0]
        job.cause = job.cause or cause
        if block_lost:
            job.setups = 0
        self._enter(State.RETRY)

    def _withdraw_block(self) -> None:
        if self.state is State.SENDING:
            self.output.clear()
            self.purge = True

    def _on_answer(self, symbol: int, now: int) -> None:
        job = self.jobs[0]
        cause = "line" if symbol & LINE_ERROR else "nak" if symbol == NAK else "char"
        if self.state is State.RETRY:
            if symbol == STX and not self.config.high:
                self._on_request(now)
        elif self.state is State.SETUP:
            if symbol == DLE:
                job.blocks += 1
                self.output += encode(job.payload, self.config.with_bcc)
                self._enter(State.SENDING)
            elif symbol == STX:
                self._collisions += 1
                self.events.append(f"collision {self._collisions}")
                if not self.config.high:
                    self._on_request(now)
            else:
                self._retry(cause)
        elif self.state is State.SENDING:
            self._withdraw_block()
            self._retry("early-dle" if symbol == DLE else cause, block_lost=True)
            if symbol != NAK:
                self._enter(State.DISTURBED, now + self.config.zvz)
        elif self.state is State.DISTURBED:
            self._timer = now + self.config.zvz
        elif symbol == DLE:
            self.events.append(f"sent {len(job.payload)}")
            self.jobs.popleft()
            self._collisions = 0
            self._enter(State.IDLE)
        else:
            self._retry(cause, block_lost=True)
