// The Pico runs beside the page, never faster than real time, and as near to it as the computer can.
import { CYCLES_PER_SECOND, Pico } from '../../../firmware/emulate/pico.js';
import type { Notice, Order, Told } from './messages';

const CYCLES_PER_MS = CYCLES_PER_SECOND / 1000;
/** Of the line: 9600 bit/s, 11 bits. */
const CHARACTER_CYCLES = (CYCLES_PER_SECOND * 11) / 9600;
/** How long it runs before it tells what has happened, and hears what has come. */
const SLICE_MS = 8;
/** From one look at the clock to the next. */
const LOOK_CYCLES = CYCLES_PER_MS / 4;
/** What it is late by more than this, it stays late. */
const MAX_LATE_MS = 20;

let pico: Pico | undefined;
/** The cycle at which real time and the Pico's were the same. */
let origin = { cycle: 0, ms: 0 };
/** Until when the line to the Pico has characters. */
let lineFree = 0;
// Timers wait for some ms at least.
const soon = new MessageChannel();
soon.port1.onmessage = run;

addEventListener('message', ({ data }: MessageEvent<Order>) => {
  if (data === 'power') pico?.powerCycle();
  else if ('program' in data) begin(new Uint8Array(data.program), data.fromSwitches);
  else if (pico) receive(pico, data.bytes);
});

function tell(told: Told, transfer: Transferable[] = []): void {
  postMessage(told, { transfer });
}

function begin(program: Uint8Array, fromSwitches: [number, number]): void {
  try {
    pico = new Pico(program, fromSwitches);
  } catch (error) {
    tell({ error: String(error) });
    return;
  }
  tell({ hz: CYCLES_PER_SECOND });
  origin = { cycle: pico.cycle, ms: performance.now() };
  run();
}

function receive(pico: Pico, bytes: Uint8Array): void {
  for (const byte of bytes) {
    lineFree = Math.max(lineFree, pico.cycle) + CHARACTER_CYCLES;
    pico.receive(Math.round(lineFree), byte);
  }
}

function run(): void {
  if (!pico) return;
  const beganMs = performance.now();
  const lateMs = beganMs - origin.ms - (pico.cycle - origin.cycle) / CYCLES_PER_MS;
  if (lateMs > MAX_LATE_MS) origin.ms += lateMs - MAX_LATE_MS;
  const due = Math.floor(origin.cycle + (beganMs - origin.ms) * CYCLES_PER_MS);
  try {
    const sent: [number, number][] = [];
    // A character that has been sent is on its way at once.
    while (sent.length === 0 && pico.cycle < due && performance.now() - beganMs < SLICE_MS) {
      pico.run(Math.min(due, pico.cycle + LOOK_CYCLES));
      sent.push(...pico.takeSent());
    }
    report(pico, sent);
  } catch (error) {
    tell({ error: String(error) });
    pico = undefined;
    return;
  }
  if (pico.cycle < due) soon.port2.postMessage('');
  else setTimeout(run);
}

function report(pico: Pico, sent: [number, number][]): void {
  const changes: [number, number][] = pico.takeEdges();
  const notice: Notice = {
    cycle: pico.cycle,
    edges: Float64Array.from(changes, ([cycle]) => cycle),
    levels: Uint8Array.from(changes, ([, levels]) => levels),
    sent: Uint8Array.from(sent, ([, byte]) => byte),
  };
  tell(notice, [notice.edges.buffer, notice.levels.buffer, notice.sent.buffer]);
}
