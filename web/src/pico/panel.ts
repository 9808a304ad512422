// The Pico on this page: the arm that it drives, its pins, and how fast it runs.
import './pico.css';
import type { Port } from '../line/port';
import { element, onClick } from '../shared/dom';
import { Analyser } from './analyser';
import { MAX_EDGES } from './edges';
import type { FromSwitches, Notice } from './messages';
import { Pico } from './pico';
import { Scene } from './scene';

/** Where the arm is when it is switched on for the first time. */
const FROM_SWITCHES: FromSwitches = [500, 300];
/** The time that the share of real time is of. */
const SHARE_MS = 2000;
const TELL_MS = 250;

/** Telegrams by the buttons under the arm. */
const TELEGRAMS: Record<string, string> = {
  'pico-home': 'home',
  'pico-jog': 'jog shoulder 60',
  'pico-hold': 'hold',
  'pico-resume': 'resume',
  'pico-stop': 'stop',
};

export class PicoPanel {
  readonly #root = element('pico', HTMLElement);
  readonly #commands = element('pico-commands', HTMLFieldSetElement);
  readonly #said = element('pico-said', HTMLElement);
  readonly #ran = element('pico-ran', HTMLElement);
  readonly #go = element('pico-go', HTMLButtonElement);
  readonly #analyser = new Analyser(element('pico-pins', HTMLCanvasElement));
  readonly #scene: Scene;
  readonly #pico: Pico;
  #hz = 1;
  /** When so many cycles had been run, the oldest first. */
  #looks: { ms: number; cycle: number }[] = [];
  #toldMs = 0;

  /** `send` has a telegram sent to the Pico; `failed` is told that it has stopped. */
  constructor(send: (text: string) => void, failed: (error: Error) => void) {
    this.#scene = new Scene(element('pico-arm', HTMLCanvasElement), FROM_SWITCHES, () => {
      const place = this.#scene.target?.map((it) => it.toFixed(1)) ?? [];
      this.#go.textContent = `Line to x ${place.join(' y ')} mm`;
      this.#go.disabled = false;
    });
    this.#pico = new Pico(FROM_SWITCHES, {
      begun: (hz) => this.#begin(hz),
      ran: (notice) => this.#take(notice),
      failed,
    });
    for (const [id, telegram] of Object.entries(TELEGRAMS)) onClick(id, () => send(telegram));
    onClick('pico-go', () => {
      const { target } = this.#scene;
      if (target) send(`line ${target.map((it) => it.toFixed(1)).join(' ')}`);
    });
    onClick('pico-power', () => this.#pico.powerCycle());
    this.connected(false);
  }

  /** Its serial port; it is switched on where it is not. */
  async port(): Promise<Port> {
    return this.#pico.port();
  }

  /** Whether the page's station is on its line. */
  connected(isConnected: boolean): void {
    this.#commands.disabled = !isConnected;
  }

  /** What the Pico has answered. */
  heard(text: string): void {
    this.#said.textContent = text;
  }

  #begin(hz: number): void {
    this.#hz = hz;
    this.#looks = [];
    this.#root.hidden = false;
    this.#scene.begin(FROM_SWITCHES);
    this.#analyser.begin(hz);
  }

  #take({ cycle, edges, levels }: Notice): void {
    this.#analyser.add(edges, levels, cycle);
    this.#scene.drive(levels);
    const ms = performance.now();
    this.#looks.push({ ms, cycle });
    while (ms - (this.#looks[0]?.ms ?? ms) > SHARE_MS) this.#looks.shift();
    if (ms - this.#toldMs < TELL_MS) return;
    this.#toldMs = ms;
    const { count, kept } = this.#analyser.edges;
    const [shoulder, elbow] = this.#scene.steps;
    const [x, y] = this.#scene.tool.map((it) => it.toFixed(2));
    this.#ran.textContent = [
      `${(cycle / this.#hz).toFixed(2)} s since it was switched on, at ${this.#share(ms, cycle)} % of real time.`,
      `By the edges: tool at x ${x} y ${y} mm, shoulder ${shoulder} and elbow ${elbow} steps from the switches.`,
      `${count} edges${count > kept ? `, the last ${kept} kept (at most ${MAX_EDGES})` : ''}.`,
    ].join(' ');
  }

  /** Of real time, in percent. */
  #share(ms: number, cycle: number): string {
    const first = this.#looks[0];
    if (!first || first.ms === ms) return '100';
    const share = (cycle - first.cycle) / this.#hz / ((ms - first.ms) / 1000);
    return Math.min(100 * share, 100).toFixed(0);
  }
}
