// A board on a serial port that moves the machine of the page: commands, the program, where it says it is.
import './board.css';
import { tell } from '../line/events';
import { choosePort, NoPortChosen, serial } from '../line/port';
import { element, onClick } from '../shared/dom';
import { Machine } from '../shared/machine';
import { asText, OF_BOARDS, PortStation, type Pulled } from './station';
import { type Answer, parseAnswer } from './telegrams';
import wasm from '../../built/line.wasm?url';

const EVENTS = 50;
/** From one question where it is to the next, while it moves. */
const ASK_MS = 500;
/** From one picture of where it is and should be to the next: the page has other things to do. */
const PAINT_MS = 100;
/** On a slow computer a picture takes as long as the line may rest between two characters: it waits for the end of a telegram, but not for ever. */
const PAINT_LATEST_MS = 2000;

/** A telegram, by what becomes of its answer. */
type Sent = 'motion' | 'where' | 'other';

/** A motion of the page's program, as a telegram. */
export interface Motion {
  telegram: string;
  /** What it is of, for a person. */
  name: string;
  /** When the page's run has it, in s. */
  fromS: number;
  toS: number;
  /** Where it ends, in mm. */
  end: number[];
}

/** The page's machine. */
export interface Operated {
  /** As the board names itself. */
  name: string;
  axes: string[];
  /** Of a jog. */
  unit: string;
  /** The program that is on the page; what is wrong with it is thrown. */
  program(): Promise<Motion[]>;
  /** Where the board says that its tool is, in mm; nothing without a board. */
  show(place: number[] | undefined): void;
  /** The time of the page's run where the board should be by now. */
  seek(seconds: number): void;
}

export class Board {
  readonly #operated: Operated;
  readonly #said = element('board-said', HTMLElement);
  readonly #place = element('board-place', HTMLElement);
  #station: PortStation | undefined;
  #asks = 0;
  #paints = 0;
  #paintedMs = 0;
  /** What the picture does not show yet. */
  #unpainted: { place?: number[]; seconds?: number } = {};
  /** How far from its end the last motion of the program has ended. */
  #off = '';
  /** What the answers that are awaited are to. */
  #awaited: Sent[] = [];
  #isMoving = false;
  #program: Motion[] = [];
  /** The motion of the program under way. */
  #current = -1;
  /** Whether it is to end with that, though the motion may be over when the board hears of it. */
  #isStopped = false;
  /** When it began on the page's clock, how long it takes, and since when it rests. */
  #leg: { beganMs: number; seconds: number; heldMs: number | undefined } | undefined;

  constructor(operated: Operated) {
    this.#operated = operated;
    const { axes, unit } = operated;
    for (const axis of axes) element('board-axis', HTMLSelectElement).add(new Option(axis, axis));
    element('board-unit', HTMLElement).textContent = unit;
    onClick('board-connect', () => this.#connect());
    onClick('board-disconnect', () => this.#disconnect('Disconnected.'));
    onClick('board-home', () => this.#order('home'));
    onClick('board-run', () => this.#run());
    for (const name of ['hold', 'resume']) onClick(`board-${name}`, () => this.#send(name));
    onClick('board-stop', () => {
      this.#isStopped = true;
      this.#send('stop');
    });
    element('board-jog', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      const by = element('board-by', HTMLInputElement).valueAsNumber;
      this.#order(`jog ${element('board-axis', HTMLSelectElement).value} ${by}`);
    });
    if (!serial) this.#say('This browser has no Web Serial: Chrome, Edge and Opera have it.');
    this.#showOpen(false);
  }

  #say(text: string, isBad = false): void {
    this.#said.textContent = text;
    this.#said.classList.toggle('bad', isBad);
  }

  #showOpen(isOpen: boolean): void {
    element('board-connect', HTMLButtonElement).disabled = isOpen || !serial;
    element('board-disconnect', HTMLButtonElement).disabled = !isOpen;
    element('board-commands', HTMLFieldSetElement).disabled = !isOpen;
  }

  async #connect(): Promise<void> {
    // The procedure is that of the page Line.
    this.#station ??= new PortStation(new Machine(wasm), {
      pulled: ({ value }) => this.#take(value),
      refused: (_, error) => this.#say(message(error), true),
      ended: (why) => this.#disconnect(`The port: ${message(why)}`, true),
    });
    try {
      await this.#station.open(choosePort, OF_BOARDS);
      this.#showOpen(true);
      this.#say('Connected: home it first.');
      this.#asks = window.setInterval(() => this.#ask(), ASK_MS);
      this.#paints = window.setInterval(() => this.#paint(), PAINT_MS);
      this.#send('machine');
    } catch (error) {
      const isCancelled = error instanceof NoPortChosen;
      await this.#disconnect(isCancelled ? 'No port was chosen.' : message(error), !isCancelled);
    }
  }

  async #disconnect(why: string, isBad = false): Promise<void> {
    clearInterval(this.#asks);
    clearInterval(this.#paints);
    this.#unpainted = {};
    this.#end();
    this.#awaited = [];
    this.#isMoving = false;
    await this.#station?.close();
    this.#showOpen(false);
    this.#place.textContent = '';
    this.#off = '';
    this.#operated.show(undefined);
    this.#say(why, isBad);
  }

  #send(text: string, of: Sent = 'other'): void {
    this.#awaited.push(of);
    this.#station?.send({ text, is_hex: false });
  }

  /** A command that moves, and is no part of the program. */
  #order(text: string): void {
    this.#end();
    this.#off = '';
    this.#isMoving = true;
    this.#say(text);
    this.#send(text, 'motion');
  }

  /** Where it is, while it moves and nothing else is said. */
  #ask(): void {
    if (!this.#isMoving || this.#awaited.includes('where') || !this.#station?.isIdle) return;
    this.#send('where', 'where');
  }

  async #run(): Promise<void> {
    try {
      this.#program = await this.#operated.program();
      this.#current = -1;
      this.#isStopped = false;
      this.#next();
    } catch (error) {
      this.#say(message(error), true);
    }
  }

  /** The next motion of the program. */
  #next(): void {
    this.#current += 1;
    const motion = this.#program[this.#current];
    if (!motion) {
      this.#say(`The program has been run: ${this.#program.length} motions.`);
      this.#end();
      return;
    }
    this.#isMoving = true;
    this.#say(
      `${this.#current + 1} of ${this.#program.length}, ${motion.name}: ${motion.telegram}`,
    );
    this.#send(motion.telegram, 'motion');
  }

  /** No program is run any more. */
  #end(): void {
    this.#program = [];
    this.#current = -1;
    this.#leg = undefined;
  }

  #take({ events }: Pulled): void {
    const list = element('board-events', HTMLElement);
    for (const { text, isGood, telegram } of events) {
      const received = asText(telegram);
      // Places come too often to be told, and that a telegram was sent is seen by its answer.
      if (received === undefined ? isGood : this.#heard(received)) continue;
      const words = received === undefined ? text : `received "${received}"`;
      tell(list, EVENTS, { atS: this.#station?.nowS ?? 0, text: words, isGood });
      list.parentElement?.scrollTo(0, list.scrollHeight);
    }
  }

  /** What the board says; whether it is the answer to a question that nobody sees. */
  #heard(text: string): boolean {
    const answer = parseAnswer(text);
    if ('place' in answer) this.#showPlace(answer.place);
    switch (answer.kind) {
      case 'held':
        if (this.#leg) this.#leg.heldMs = performance.now();
        return false;
      case 'done':
        this.#done(answer);
        return false;
      case 'stopped':
      case 'failed':
        this.#ended(text, answer.kind === 'failed');
        return false;
    }
    const of = this.#awaited.shift();
    if (answer.kind === 'begun') this.#begun(answer.seconds);
    else if (answer.kind === 'refused' && of === 'motion') this.#ended(text, true);
    else if (answer.kind === 'refused' && of === 'other') this.#say(text, true);
    else this.#other(text);
    return of === 'where';
  }

  /** A motion has not been made, or not to its end. */
  #ended(text: string, isBad: boolean): void {
    this.#isMoving = false;
    const motion = this.#program[this.#current];
    this.#say(motion ? `The program ends at ${motion.name}: ${text}` : text, isBad);
    this.#end();
  }

  #other(text: string): void {
    if (/^(arm|delta|stage)$/.test(text) && text !== this.#operated.name) {
      this.#disconnect(`The board moves another machine: ${text}.`, true);
    }
    if (text === 'ok' && this.#leg?.heldMs !== undefined) {
      // It goes on.
      this.#leg.beganMs += performance.now() - this.#leg.heldMs;
      this.#leg.heldMs = undefined;
    }
  }

  #showPlace(place: number[]): void {
    this.#unpainted.place = place;
    const axes = ['x', 'y', 'z'].slice(0, place.length);
    const words = axes.map((axis, index) => `${axis} ${(place[index] ?? 0).toFixed(3)}`);
    this.#place.textContent = `The board says ${words.join(' ')} mm.${this.#off}`;
  }

  #begun(seconds: number): void {
    if (this.#current < 0) return;
    this.#leg = { beganMs: performance.now(), seconds, heldMs: undefined };
  }

  /** Where it should be by now, on the time of the page's run. */
  get #runSeconds(): number | undefined {
    const [leg, motion] = [this.#leg, this.#program[this.#current]];
    if (!leg || !motion) return this.#unpainted.seconds;
    const seconds = ((leg.heldMs ?? performance.now()) - leg.beganMs) / 1000;
    const part = leg.seconds > 0 ? Math.min(seconds / leg.seconds, 1) : 1;
    return motion.fromS + part * (motion.toS - motion.fromS);
  }

  /** Shows where it is and where it should be, while the line is quiet. */
  #paint(): void {
    const nowMs = performance.now();
    if (!this.#station?.isIdle && nowMs < this.#paintedMs + PAINT_LATEST_MS) return;
    this.#paintedMs = nowMs;
    const [seconds, { place }] = [this.#runSeconds, this.#unpainted];
    this.#unpainted = {};
    if (seconds !== undefined) this.#operated.seek(seconds);
    if (place) this.#operated.show(place);
  }

  #done({ place }: Extract<Answer, { place: number[] }>): void {
    this.#isMoving = false;
    // Home has no answer but this.
    if (this.#awaited[0] === 'motion') this.#awaited.shift();
    const motion = this.#program[this.#current];
    if (!motion) {
      this.#say('Done.');
      return;
    }
    this.#leg = undefined;
    this.#unpainted.seconds = motion.toS;
    const off = Math.hypot(...motion.end.map((it, axis) => it - (place[axis] ?? 0)));
    this.#off = ` It ended ${motion.name} ${off.toFixed(3)} mm from where that ends.`;
    this.#showPlace(place);
    if (this.#isStopped) this.#ended('stopped at its end', false);
    else this.#next();
  }
}

function message(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
