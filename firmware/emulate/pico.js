// A Raspberry Pi Pico that runs a machine's firmware, by `rp2040js`: the pins of the drivers are
// recorded with their cycle, the switches are where they are, the line takes its time.
//
// Of its own: PIO and processor go on together, cycle by cycle (`rp2040js` runs the PIO beside the
// time); the UART; SEV; a transmit FIFO that is joined. There is no boot ROM: it starts where the
// second stage of the boot would go on.

import { FIFO, RP2040 } from "rp2040js";
import { loadedSegments } from "./elf.js";
import { CHARACTER_ERRORS, Pl011 } from "./pl011.js";
import { Switches } from "./switches.js";

export const CYCLES_PER_SECOND = 125_000_000;
const CYCLE_NANOS = 1e9 / CYCLES_PER_SECOND;

const FLASH = 0x10000000;
const RAM = 0x20000000;
/** Behind the second stage of the boot. */
const VECTORS = 0x10000100;
const UART0 = 0x40034;
const UART0_IRQ = 20;

/** The first of the pins in a row: STEP and DIR of each axis, then the home switches, closed to ground. */
const FIRST_PIN = 2;

const TRANSMIT_JOINED = 1 << 30;
const JOINED_FIFO = 8;
/** JMP X-- without delay; its target is in the low bits. */
const COUNTS_DOWN = 0x0040;

export class Pico {
  #program;
  #rp2040;
  #core;
  #clock;
  #pio;
  /** The one of the PIO that the firmware uses. */
  #machine;
  #uart;
  #switches;
  #driverPins;
  #switchPins;
  /** The cycle in which the next instruction begins. */
  #now = 0;
  /** While the PIO is stepped: the cycle it is in. */
  #cycle = 0;
  #levels = 0;
  #edges = [];
  #sent = [];
  /** Characters on their way in: `{ end, byte, errors }`, in cycles. */
  #coming = [];

  /**
   * @param {Uint8Array} program an ELF of `firmware/rp2040`
   * @param {number[]} fromSwitches steps of each axis from where its switch closes: as many as it has axes
   */
  constructor(program, fromSwitches = [500, 300], bounceCycles = 0) {
    this.#program = loadedSegments(program);
    const axes = fromSwitches.length;
    this.#driverPins = Array.from({ length: 2 * axes }, (_, index) => FIRST_PIN + index);
    this.#switchPins = Array.from({ length: axes }, (_, index) => FIRST_PIN + 2 * axes + index);
    this.#switches = new Switches(fromSwitches, bounceCycles);
    this.#start(0);
  }

  get switches() {
    return this.#switches;
  }

  /** Cycles since it was switched on for the first time; in the middle of an instruction those of an alarm. */
  get cycle() {
    return Math.round(this.#clock.nanos / CYCLE_NANOS);
  }

  /** Edges since the last call: `[cycle, levels]`, STEP and DIR of each axis from bit 0 on. */
  takeEdges() {
    return this.#edges.splice(0);
  }

  /** What has been sent since the last call: `[cycle, byte]`, when the stop bit ends. */
  takeSent() {
    return this.#sent.splice(0);
  }

  /** A character on the line whose stop bit ends at a cycle; `errors` of `CHARACTER_ERRORS`. */
  receive(end, byte, error = undefined) {
    this.#coming.push({ end, byte, errors: error ? CHARACTER_ERRORS[error] : 0 });
  }

  /** The supply fails and comes back at once: all pins are inputs, memory is lost. */
  powerCycle() {
    this.#start(this.cycle);
  }

  #start(cycle) {
    const rp2040 = new RP2040();
    const quiet = () => {};
    rp2040.logger = { debug: quiet, warn: quiet, error: quiet, info: (_, text) => this.#hear(text) };
    rp2040.onBreak = (code) => {
      throw new Error(`the program has stopped at ${rp2040.core.PC.toString(16)}: code ${code}`);
    };
    for (const { address, bytes } of this.#program) {
      rp2040.flash.set(bytes, address - FLASH);
    }
    const [core, clock, pio] = [rp2040.core, rp2040.clock, rp2040.pio[0]];
    clock.tick(cycle * CYCLE_NANOS);
    this.#now = cycle;
    writeMemoryFirst(rp2040);
    this.#uart = new Pl011(rp2040, "UART0", UART0_IRQ);
    this.#uart.onByte = (byte) => this.#sent.push([this.cycle, byte]);
    rp2040.peripherals[UART0] = this.#uart;
    // It would step by itself, whatever the time.
    pio.run = quiet;
    for (const pin of this.#driverPins) {
      rp2040.gpio[pin].addListener(() => this.#pinsChanged());
    }
    [this.#rp2040, this.#core, this.#clock, this.#pio] = [rp2040, core, clock, pio];
    this.#machine = pio.machines[0];
    this.#cycle = cycle;
    this.#pinsChanged();
    core.VTOR = VECTORS;
    core.reset();
  }

  /** What the emulator says of instructions that it does not carry out. */
  #hear(text) {
    if (text === "SEV") {
      this.#core.eventRegistered = true;
    }
  }

  #pinsChanged() {
    // Inputs are pulled down by the drivers.
    const levels = this.#driverPins.reduce((levels, pin, bit) => {
      const { outputEnable, outputValue } = this.#rp2040.gpio[pin];
      return levels | (outputEnable && outputValue ? 1 << bit : 0);
    }, 0);
    if (levels !== this.#levels) {
      this.#levels = levels;
      this.#edges.push([this.#cycle, levels]);
      this.#switches.drive(levels, this.#cycle);
    }
  }

  #look() {
    this.#switchPins.forEach((pin, axis) => {
      const isOpen = !this.#switches.isClosed(axis, this.cycle);
      const gpio = this.#rp2040.gpio[pin];
      if (gpio.rawInputValue !== isOpen) {
        gpio.setInputValue(isOpen);
      }
    });
  }

  /** Goes on to a cycle, or until a byte has been sent. */
  run(until) {
    const core = this.#core;
    const sent = this.#sent;
    while (sent.length === 0 && this.#now < until) {
      // Between two looks nothing comes from outside.
      const outside = Math.min(until, this.#now + 12500, this.#coming[0]?.end ?? Infinity);
      this.#look();
      while (sent.length === 0 && this.#now < outside) {
        if (core.waiting) {
          this.#sleep(outside);
        } else {
          this.#pass(core.executeInstruction());
        }
      }
      while (this.#coming[0]?.end <= this.#now) {
        const { byte, errors } = this.#coming.shift();
        this.#uart.receive(byte, errors);
      }
    }
  }

  /** Until something may wake the processor. */
  #sleep(until) {
    if (this.#core.eventRegistered) {
      this.#core.eventRegistered = false;
      this.#core.waiting = false;
      return;
    }
    const alarm = this.#clock.nextAlarm ? Math.ceil(this.#clock.nextAlarm.nanos / CYCLE_NANOS) : Infinity;
    const cycles = Math.max(1, Math.min(until, alarm) - this.#now);
    this.#pass(this.#pioEvent(cycles));
  }

  /** Up to so many cycles, or until the PIO's next instruction that does more than to count. */
  #pioEvent(cycles) {
    const machine = this.#machine;
    if (!machine.enabled || machine.waiting) {
      return cycles;
    }
    return Math.min(cycles, this.#isCounting(machine) ? machine.x + 1 : 1);
  }

  #isCounting(machine) {
    return this.#pio.instructions[machine.pc] === (COUNTS_DOWN | machine.pc) && machine.x > 0;
  }

  /** Processor and PIO have taken so many cycles. */
  #pass(cycles) {
    const begin = this.#now;
    this.#now = begin + cycles;
    this.#stepPio(begin, cycles);
    const clock = this.#clock;
    const nanos = this.#now * CYCLE_NANOS;
    if (clock.nextAlarm?.nanos <= nanos) {
      clock.tick(nanos - clock.nanos);
    } else {
      clock.nanosCounter = nanos;
    }
  }

  #stepPio(begin, cycles) {
    const pio = this.#pio;
    const machine = this.#machine;
    if (!machine.enabled) {
      return;
    }
    if (machine.shiftCtrl & TRANSMIT_JOINED && machine.txFIFO.size !== JOINED_FIFO) {
      machine.txFIFO = new FIFO(JOINED_FIFO);
    }
    let left = cycles;
    while (left > 0) {
      if (machine.waiting && machine.txFIFO.empty) {
        return;
      }
      if (!machine.waiting && this.#isCounting(machine)) {
        const counted = Math.min(left, machine.x);
        machine.x -= counted;
        left -= counted;
        continue;
      }
      this.#cycle = begin + cycles - left;
      machine.step();
      pio.checkChangedPins();
      left -= 1;
    }
  }
}

/** Most of what is written goes to the memory, which `rp2040js` has behind all else. */
function writeMemoryFirst(rp2040) {
  const { sram, sramView } = rp2040;
  const write = rp2040.writeUint32.bind(rp2040);
  rp2040.writeUint32 = (address, value) => {
    const offset = (address >>> 0) - RAM;
    if (offset >= 0 && offset + 3 < sram.length) {
      sramView.setUint32(offset, value, true);
    } else {
      write(address, value);
    }
  };
}
