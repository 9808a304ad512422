// A Pico in real time, or as near to it as the computer can; never faster.

import { CYCLES_PER_SECOND } from "./pico.js";

const CYCLES_PER_MS = CYCLES_PER_SECOND / 1000;
/** Of the line: 9600 bit/s, 11 bits. */
const CHARACTER_CYCLES = (CYCLES_PER_SECOND * 11) / 9600;
/** From one look at the clock to the next. */
const LOOK_CYCLES = CYCLES_PER_MS / 4;
/** What it is late by more than this, it stays late. */
const MAX_LATE_MS = 20;

export class PacedPico {
  #pico;
  /** The cycle at which real time and the Pico's were the same. */
  #origin;
  /** Until when the line to the Pico has characters. */
  #lineFree = 0;

  /** @param {import("./pico.js").Pico} pico */
  constructor(pico) {
    this.#pico = pico;
    this.#origin = { cycle: pico.cycle, ms: performance.now() };
  }

  /** Characters on the line to the Pico, as soon as those before have left. */
  receive(bytes) {
    for (const byte of bytes) {
      this.#lineFree = Math.max(this.#lineFree, this.#pico.cycle) + CHARACTER_CYCLES;
      this.#pico.receive(Math.round(this.#lineFree), byte);
    }
  }

  /**
   * Goes on to real time, for so many ms at the most, or until a character has been sent: it is on its
   * way at once. What has been sent, and whether it has come to real time.
   */
  run(sliceMs) {
    const pico = this.#pico;
    const begunMs = performance.now();
    const { cycle, ms } = this.#origin;
    const lateMs = begunMs - ms - (pico.cycle - cycle) / CYCLES_PER_MS;
    if (lateMs > MAX_LATE_MS) this.#origin.ms += lateMs - MAX_LATE_MS;
    const due = Math.floor(cycle + (begunMs - this.#origin.ms) * CYCLES_PER_MS);
    const sent = [];
    while (sent.length === 0 && pico.cycle < due && performance.now() - begunMs < sliceMs) {
      pico.run(Math.min(due, pico.cycle + LOOK_CYCLES));
      sent.push(...pico.takeSent());
    }
    return { sent: Uint8Array.from(sent, ([, byte]) => byte), isOnTime: pico.cycle >= due };
  }
}
