// The serial line of a Pico on standard input and output, in real time: `node pico-serial.js PROGRAM A B..`,
// with the steps of each axis from its switch.

import { readFileSync } from "node:fs";
import { PacedPico } from "./paced.js";
import { Pico } from "./pico.js";

/** From one look at what has come in to the next. */
const SLICE_MS = 4;

const [program, ...numbers] = process.argv.slice(2);
const pico = new Pico(readFileSync(program), numbers.map(Number));
const paced = new PacedPico(pico);
let isOpen = true;
process.stdin.on("data", (bytes) => paced.receive(bytes));
process.stdin.on("end", () => {
  isOpen = false;
});

function run() {
  if (!isOpen) return;
  const { sent, isOnTime } = paced.run(SLICE_MS);
  // Nobody looks at the pins here.
  pico.takeEdges();
  if (sent.length > 0) process.stdout.write(sent);
  if (isOnTime) setTimeout(run, 1);
  else setImmediate(run);
}
run();
