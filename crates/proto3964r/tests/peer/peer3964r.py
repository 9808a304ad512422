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
* At start-up, what came in before is discarded and a NAK sent. A NAK that crosses a STX makes
  the partner repeat the STX, and the second one counts as data: 3964R rejects that block, plain
  3964 delivers it. For exact comparisons in plain 3964 use --no-startup-nak.
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


# Byte-level vectors: configuration, stimulus, bytes expected, events expected. In the stimulus,
# a line of bytes is one read ("!" marks a line error), +N lets time pass, "hold" blocks the
# output line; "@N" in an expectation is the time of what follows. Default: low priority, 3964R.
Vector = Tuple[str, Config, str, str, str]
LOW, HIGH, PLAIN = Config(), Config(high=True), Config(with_bcc=False, qvz=550)
RK_SEND = "00 00 41 44 05 0A 00 02 FF FF 12 34 AB CD"
EUCHNER = "6C A5 D5 C3 C8 CE C5 D2"
BLOCK = "41 10 03 52"
VECTORS: List[Vector] = [
    ("1 one byte", LOW, "02, 41 10 03 52", "10 10", "received 41"),
    ("2 empty", LOW, "02, 10 03 13", "10 10", "received"),
    ("3 DLE", LOW, "02, 10 10 10 03 13", "10 10", "received 10"),
    ("4 ETX is data", LOW, "02, 03 10 03 10", "10 10", "received 03"),
    ("5 BCC=STX", LOW, "02, 11 10 03 02", "10 10", "received 11"),
    ("6 BCC=NAK", LOW, "02, 06 10 03 15", "10 10", "received 06"),
    ("7 BCC=ETX", LOW, "02, 41 51 10 03 03", "10 10", "received 41 51"),
    ("9 control characters", LOW, "02, 02 10 10 03 10 10 10 10 15 10 03 07", "10 10",
     "received 02 10 03 10 10 15"),
    ("10 DLE ETX is data", LOW, "02, 10 10 03 10 03 10", "10 10", "received 10 03"),
    ("11 three DLE", LOW, "02, 10 10 10 03 13", "10 10", "received 10"),
    ("14 send DLE", LOW, "send 01 10 02, 10, 10", "02 01 10 10 02 10 03 10", "sent 3"),
    ("15 send final DLE", LOW, "send 41 10, 10, 10", "02 41 10 10 10 03 52", "sent 2"),
    ("16 BCC=DLE single", LOW, "send 03, 10, 10", "02 03 10 03 10", "sent 1"),
    ("17 send 3964", PLAIN, "send 41, 10, 10", "02 41 10 03", "sent 1"),
    ("18 receive 3964", PLAIN, "02, 41 10 03", "10 10", "received 41"),
    ("19 one read", LOW, "02 41 10 03 52", "10 10", "received 41"),
    ("21 send empty", LOW, "send, 10, 10", "02 10 03 13", "sent 0"),
    ("22 stray DLE", LOW, "send 41, 10, 10, 10, +220", f"02 {BLOCK} @220 15",
     "sent 1 @220 error noise"),
    ("23 wrong BCC, repeat", LOW, "02, 41 10 03 00, +100, 02, 41 10 03 52", "10 15 @100 10 10",
     "error bcc @100 received 41"),
    ("24 BWZ", LOW, "02, 41 10 03 00, +3999, +1", "10 15",
     "error bcc @4000 receive-failed bwz 1"),
    ("26 DLE illegal", LOW, "02, 10 41 10 03 42", "10 15", "error dle"),
    ("27 line error", LOW, "02, 41 42! 10 03 10", "10 15", "error line"),
    ("28 ZVZ in data", LOW, "02, 41 42, +219, +1", "10 @220 15", "@220 error zvz"),
    ("29 ZVZ after DLE", LOW, "02, +220", "10 @220 15", "@220 error zvz"),
    ("30 ZVZ before BCC", LOW, "02, 41 10 03, +220", "10 @220 15", "@220 error zvz"),
    ("32 overlong", replace(LOW, max_block=4), "02, 41 42 43 44 45 10 03 52", "10 15",
     "error overflow"),
    ("34 buffer freed", LOW, "full, 02, +399, free", "@399 10", ""),
    ("35 no buffer", LOW, "full, 02, +400", "@400 15", "@400 error nobuf"),
    ("36 noise", LOW, "41, +219, +1, 02", "@220 15 10", "@220 error noise"),
    ("38 NAK in idle", LOW, "15, +1000", "", ""),
    ("39 DLE in idle", LOW, "10, +220", "@220 15", "@220 error noise"),
    ("41 NAK to STX", LOW, "send 55, 15, 10, 10", "02 02 55 10 03 46", "sent 1"),
    ("43 garbage to STX", LOW, "send 41, 55, 10, 10", f"02 02 {BLOCK}", "sent 1"),
    ("44 no answer", LOW, "send 41, +12000",
     "02 @2000 02 @4000 02 @6000 02 @8000 02 @10000 02 @12000 15", "@12000 failed setup timeout 6"),
    ("45 no answer to block", LOW, "send 41" + ", 10, +2000" * 6,
     f"02 {BLOCK} " + "".join(f"@{t} 02 {BLOCK} " for t in range(2000, 12000, 2000)) + "@12000 15",
     "@12000 failed transfer timeout 6"),
    ("46 NAK to block", LOW, "send 41" + ", 10, 15" * 6, f"02 {BLOCK} " * 6 + "15",
     "failed transfer nak 6"),
    ("49 QVZ of 3964", PLAIN, "send 41, +549, +1", "02 @550 02", ""),
    ("50 collision, low", LOW, "send 41, 02, 42 10 03 51, 10, 10", f"02 10 10 02 {BLOCK}",
     "collision 1 received 42 sent 1"),
    ("51 collision, high", HIGH, "send 41, 02, +10, 10, 10", f"02 @10 {BLOCK}",
     "collision 1 @10 sent 1"),
    ("53 both high", HIGH, "send 41, 02, +2000, 02, +2000", "02 @2000 02 @4000 02",
     "collision 1 @2000 collision 2"),
    ("56 LED 7", LOW, "send 37, 10, 10", "02 37 10 03 24", "sent 1"),
    ("57 text", LOW, f"send {EUCHNER}, 10, 10", f"02 {EUCHNER} 10 03 DD", "sent 8"),
    ("58 status", LOW, "send 23, 10, 10, 02, 30 41 51 10 03 33", "02 23 10 03 30 10 10",
     "sent 1 received 30 41 51"),
    ("59 RK512 SEND", LOW, f"send {RK_SEND}, 10, 10, 02, 00 00 00 00 10 03 13",
     f"02 {RK_SEND} 10 03 5B 10 10", "sent 14 received 00 00 00 00"),
    # Rules of the text without a numbered vector
    ("NAK within the block", LOW, "send 41, hold, 10, 15, go, 10, 10", f"02 02 {BLOCK}", "sent 1"),
    ("character within the block", LOW, "send 41, hold, 10, 55, +219, go, +1, 10, 10",
     f"02 @220 15 02 {BLOCK}", "@220 sent 1"),
    ("six bad blocks", LOW, "02, 41 10 03 00, " * 6 + "+9000", "10 15 " * 6,
     "error bcc " * 6 + "receive-failed attempts 6"),
    ("job survives a failed reception", LOW, "send 41, 02, 42, +220, 10, 10",
     f"02 10 @220 15 02 {BLOCK}", "collision 1 @220 error zvz sent 1"),
    ("a burst is one attempt", LOW, "send 41, 55 56 57 58, 10, 10", f"02 02 {BLOCK}", "sent 1"),
]


def simulate(config: Config, stimulus: str) -> Tuple[str, str]:
    """Run one stimulus against a simulated clock: bytes sent and events."""
    station, now, held = Station(config), 0, False
    logs: Tuple[List[str], List[str]] = ([], [])
    marks = [0, 0]

    def collect() -> None:
        texts: Tuple[List[str], List[str]] = ([], list(station.events))
        station.events.clear()
        if not held:
            texts[0].extend(f"{byte:02X}" for byte in station.output)
            station.output.clear()
            station.drained(now)
        for which, text in enumerate(texts):
            if text and marks[which] != now:
                logs[which].append(f"@{now}")
                marks[which] = now
            logs[which].extend(text)

    for step in filter(None, stimulus.split(", ")):
        word, _, rest = step.partition(" ")
        if word == "send":
            station.send(bytes.fromhex(rest), now)
        elif word in ("full", "free"):
            station.set_buffer_free(word == "free", now)
        elif word in ("hold", "go"):
            held = word == "hold"
        elif word.startswith("+"):
            end = now + int(word)
            while (due := station.deadline()) is not None and due <= end:
                now = due
                station.tick(now)
                collect()
            now = end
        else:
            station.receive((int(t[:2], 16) | LINE_ERROR * t.endswith("!") for t in step.split()),
                            now)
        collect()
    return " ".join(logs[0]), " ".join(logs[1])


def self_test() -> int:
    failed = 0
    for name, config, stimulus, *expected in VECTORS:
        result = simulate(config, stimulus)
        if result != (expected[0].strip(), expected[1].strip()):
            failed += 1
            print(f"{name}: expected {expected}, got {list(result)}")
    print(f"{len(VECTORS) - failed} passed, {failed} failed")
    return 1 if failed else 0


class Port:
    """A terminal device in raw mode; line errors arrive marked, output can be withdrawn."""

    def __init__(self, path: str, baud: int, parity: str, damage: float, seed: int) -> None:
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        speed = getattr(termios, f"B{baud}")
        cflag = termios.CS8 | termios.CREAD | termios.CLOCAL
        cflag |= {"none": 0, "even": termios.PARENB, "odd": termios.PARENB | termios.PARODD}[parity]
        control = termios.tcgetattr(self.fd)[6]
        control[termios.VMIN], control[termios.VTIME] = 1, 0
        iflag = termios.INPCK | termios.PARMRK  # line errors as FF 00 x, a data FF doubled
        mode = [iflag, 0, cflag, 0, speed, speed, control]
        termios.tcsetattr(self.fd, termios.TCSANOW, mode)
        self._damage, self._random = damage, random.Random(seed)
        self._waiting = bytearray()
        self._marked = bytearray()

    def read(self) -> List[int]:
        try:
            data = os.read(self.fd, 4096)
        except BlockingIOError:
            return []
        if not data:
            raise OSError("the line was hung up")
        symbols: List[int] = []
        for byte in data:
            self._marked.append(byte)
            if self._marked[0] == 0xFF and bytes(self._marked[1:]) in (b"", b"\0"):
                continue  # the mark is incomplete
            damaged = len(self._marked) == 3
            symbols.append(BREAK if damaged and not byte else byte | LINE_ERROR * damaged)
            self._marked.clear()
        return symbols

    def write(self, station: Station) -> bool:
        """Hand over what the line can take; true once everything has left."""
        if station.purge:
            termios.tcflush(self.fd, termios.TCOFLUSH)
            self._waiting.clear()
            station.purge = False
        for byte in station.output:
            hit = self._random.random() < self._damage
            self._waiting.append(byte ^ (1 << self._random.randrange(8) if hit else 0))
        station.output.clear()
        while self._waiting and self._queued() < 32:
            try:
                del self._waiting[: os.write(self.fd, self._waiting[:32])]
            except BlockingIOError:
                break
        return not self._waiting and self._queued() == 0

    def _queued(self) -> int:
        return int(struct.unpack("i", fcntl.ioctl(self.fd, termios.TIOCOUTQ, bytes(4)))[0])


def clock() -> int:
    return time.monotonic_ns() // 1_000_000


def run(options: argparse.Namespace, config: Config) -> int:
    port = Port(options.port, options.baud, options.parity, options.damage, options.seed)
    station = Station(config)
    if options.startup_nak:
        termios.tcflush(port.fd, termios.TCIFLUSH)  # a request the NAK calls off is not a request
        station.start()
    end = clock() + int(options.seconds * 1000) if options.seconds is not None else None
    lines, stdin_open, bad_input = bytearray(), True, False
    finished_at: Optional[int] = None
    while True:
        now = clock()
        station.tick(now)
        left = port.write(station)
        if left:
            station.drained(now)
        for event in station.events:
            print(event, flush=True)
        station.events.clear()
        met = not stdin_open and not station.jobs and station.received >= options.expect
        if not (met and left and station.state not in RECEIVING):
            finished_at = None
        elif finished_at is None:
            finished_at = now
        over = finished_at is not None and now - finished_at >= options.linger_ms
        if over or (end is not None and now >= end):
            if left:
                termios.tcdrain(port.fd)
            return 0 if met and not station.failed and not bad_input else 1
        finish = None if finished_at is None else finished_at + options.linger_ms
        poll = None if left else now + 2
        due = [t for t in (station.deadline(), end, finish, poll) if t is not None]
        timeout = max(0, min(due) - now) / 1000 if due else None
        sources = [port.fd, 0] if stdin_open else [port.fd]
        ready, _, _ = select.select(sources, [], [], timeout)
        if port.fd in ready:
            station.receive(port.read(), clock())
        if 0 in ready:
            data = os.read(0, 65536)
            stdin_open = bool(data)
            *complete, rest = bytes(lines + (data or b"\n")).decode("latin-1").split("\n")
            lines[:] = rest.encode("latin-1")
            for line in filter(None, map(str.strip, complete)):
                try:
                    station.send(b"" if line == "-" else bytes.fromhex(line), clock())
                except ValueError:
                    print(f"not a hexadecimal line: {line}", file=sys.stderr)
                    bad_input = True


def main() -> int:
    parser = argparse.ArgumentParser(description="A Siemens 3964(R) station for tests")
    add = parser.add_argument
    add("--self-test", action="store_true", help="run the byte-level vectors and exit")
    add("--port", help="path of the serial device or pseudo-terminal")
    add("--baud", type=int, default=9600)
    add("--parity", choices=("none", "even", "odd"), default="none")
    add("--priority", choices=("high", "low"), default="low")
    add("--protocol", choices=("3964r", "3964"), default="3964r")
    add("--qvz-ms", type=int, help="acknowledgement time (3964R 2000, 3964 550)")
    add("--zvz-ms", type=int, default=Config.zvz, help="character time")
    add("--bwz-ms", type=int, default=Config.bwz, help="block waiting time")
    add("--setup-attempts", type=int, default=Config.setup_attempts)
    add("--transfer-attempts", type=int, default=Config.transfer_attempts)
    add("--max-block", type=int, default=Config.max_block, help="longest payload accepted")
    add("--no-startup-nak", dest="startup_nak", action="store_false")
    add("--expect", type=int, default=0, help="stay until so many telegrams are received")
    add("--seconds", type=float, help="stay no longer than this")
    add("--linger-ms", type=int, default=0, help="go on answering this long when finished")
    add("--damage", type=float, default=0.0, help="chance that an outgoing byte has a bit flipped")
    add("--seed", type=int, default=0, help="of the damage")
    options = parser.parse_args()
    if options.self_test:
        return self_test()
    if options.port is None:
        parser.error("--port is required")
    with_bcc = options.protocol == "3964r"
    qvz = options.qvz_ms or (2000 if with_bcc else 550)
    config = Config(
        options.priority == "high", with_bcc, qvz, options.zvz_ms, options.bwz_ms,
        options.setup_attempts, options.transfer_attempts, options.max_block)
    try:
        return run(options, config)
    except OSError as error:
        print(f"{options.port}: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
