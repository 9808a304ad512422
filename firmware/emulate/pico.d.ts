// What the page's worker has of pico.js.

export const CYCLES_PER_SECOND: number;

export class Pico {
  /** @param program an ELF of `firmware/rp2040` */
  constructor(program: Uint8Array, fromSwitches?: [number, number], bounceCycles?: number);
  get cycle(): number;
  takeEdges(): [cycle: number, levels: number][];
  takeSent(): [cycle: number, byte: number][];
  receive(end: number, byte: number, error?: "framing" | "parity" | "break" | "overrun"): void;
  powerCycle(): void;
  run(until: number): void;
}
