// The Pico on standard input and output, as README.md says: `node pico-line.js PROGRAM BOUNCE A B..`.

import { readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { CYCLES_PER_SECOND, Pico } from "./pico.js";

const [program, ...numbers] = process.argv.slice(2);
const [bounce, ...fromSwitches] = numbers.map(Number);
const pico = new Pico(readFileSync(program), fromSwitches, bounce);

/** Both as text, since all that is asked is answered before the next question comes. */
const commands = {
  receive: (end, byte, error) => pico.receive(Number(end), Number(byte), error),
  bounce: (cycles) => {
    pico.switches.bounceCycles = Number(cycles);
  },
  power: () => pico.powerCycle(),
  run: (until) => {
    pico.run(Number(until));
    const edges = pico.takeEdges().map(([cycle, levels]) => `edge ${cycle} ${levels}\n`);
    const sent = pico.takeSent().map(([cycle, byte]) => `sent ${cycle} ${byte}\n`);
    process.stdout.write(`${edges.join("")}${sent.join("")}at ${pico.cycle} ${pico.switches.fromSwitches.join(" ")}\n`);
  },
};

process.stdout.write(`hz ${CYCLES_PER_SECOND}\n`);
for await (const line of createInterface({ input: process.stdin })) {
  const [name, ...words] = line.split(" ");
  commands[name](...words);
}
