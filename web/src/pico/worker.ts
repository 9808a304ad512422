// The Pico runs beside the page, never faster than real time, and as near to it as the computer can.
import { PacedPico } from '../../../firmware/emulate/paced.js';
import { CYCLES_PER_SECOND, Pico } from '../../../firmware/emulate/pico.js';
import type { Notice, Order, Told } from './messages';

/** How long it runs before it tells what has happened, and hears what has come. */
const SLICE_MS = 8;

let pico: Pico | undefined;
let paced: PacedPico | undefined;
// Timers wait for some ms at least.
const soon = new MessageChannel();
soon.port1.onmessage = run;

addEventListener('message', ({ data }: MessageEvent<Order>) => {
  if (data === 'power') pico?.powerCycle();
  else if ('program' in data) begin(new Uint8Array(data.program), data.fromSwitches);
  else paced?.receive(data.bytes);
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
  paced = new PacedPico(pico);
  run();
}

function run(): void {
  if (!pico || !paced) return;
  try {
    const { sent, isOnTime } = paced.run(SLICE_MS);
    report(pico, sent);
    if (isOnTime) setTimeout(run);
    else soon.port2.postMessage('');
  } catch (error) {
    tell({ error: String(error) });
    [pico, paced] = [undefined, undefined];
  }
}

function report(pico: Pico, sent: Uint8Array): void {
  const changes: [number, number][] = pico.takeEdges();
  const notice: Notice = {
    cycle: pico.cycle,
    edges: Float64Array.from(changes, ([cycle]) => cycle),
    levels: Uint8Array.from(changes, ([, levels]) => levels),
    sent,
  };
  tell(notice, [notice.edges.buffer, notice.levels.buffer, notice.sent.buffer]);
}
