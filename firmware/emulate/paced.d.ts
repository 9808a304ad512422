// What the page's worker has of paced.js.

import type { Pico } from "./pico.js";

export class PacedPico {
  constructor(pico: Pico);
  receive(bytes: Uint8Array): void;
  run(sliceMs: number): { sent: Uint8Array; isOnTime: boolean };
}
