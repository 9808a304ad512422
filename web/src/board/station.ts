// A 3964R station in wasm on a serial port of the browser: telegrams go one after the other.
import type { News } from '../line/conversation';
import { type Damage, OpenPort, type Port } from '../line/port';
import type { Telegram } from '../line/station-panel';
import type { Answer, Machine } from '../shared/machine';

/** What follows from what has happened. */
export interface Pulled extends News {
  transmit: number[];
  events: StationEvent[];
  activity: string;
  isBusy: boolean;
  deadlineS: number | null;
}

export interface StationEvent {
  text: string;
  isGood: boolean;
  /** The bytes of a telegram that came in. */
  telegram: number[] | null;
}

export interface Procedure {
  preset: string;
  priority: string;
  baud: number;
  parity: string;
}

/** As the firmware of the boards has it, the page with the high priority. */
export const OF_BOARDS: Procedure = {
  preset: 'siemens-3964r',
  priority: 'high',
  baud: 9600,
  parity: 'even',
};

const MIN_WAIT_MS = 2;

interface Hooks {
  pulled(answer: Answer<Pulled>): void;
  /** Something was refused, or a telegram could not be sent; the station lives on. */
  refused(where: string, error: unknown): void;
  /** The port is gone. */
  ended(why: unknown): void;
}

export class PortStation {
  readonly #machine: Machine;
  readonly #hooks: Hooks;
  #port: OpenPort | undefined;
  #beganS = 0;
  #deadline = 0;
  #waiting: Telegram[] = [];
  #isBusy = false;
  #activity = '';

  constructor(machine: Machine, hooks: Hooks) {
    this.#machine = machine;
    this.#hooks = hooks;
  }

  /** Since the port was opened, in s of its time. */
  get nowS(): number {
    return (this.#port?.nowS ?? this.#beganS) - this.#beganS;
  }

  /** Whether no telegram is under way, either way, or waits. */
  get isIdle(): boolean {
    return !this.#isBusy && this.#waiting.length === 0 && this.#activity === 'idle';
  }

  async open(choose: () => Promise<Port>, procedure: Procedure): Promise<void> {
    const { parity, baud, ...rest } = procedure;
    const bits = parity === 'none' ? 10 : 11;
    await this.#machine.call('line.station.begin', { ...rest, baud, bits });
    this.#port = await OpenPort.open(await choose(), baud, parity, {
      hear: (bytes: Uint8Array) => this.push({ bytes: [...bytes] }),
      damaged: (damage: Damage) => this.push(damage === 'break' ? { is_break: true } : { damage }),
      ended: (why: unknown) => this.#hooks.ended(why),
    });
    this.#beganS = this.#port.nowS;
    this.push({});
  }

  async close(): Promise<void> {
    clearTimeout(this.#deadline);
    this.#waiting = [];
    this.#isBusy = false;
    const port = this.#port;
    this.#port = undefined;
    await port?.close();
  }

  send(telegram: Telegram): void {
    this.#waiting.push(telegram);
    this.#sendNext();
  }

  /** Gives up the telegram under way, and those that wait. */
  cancel(): void {
    this.#waiting = [];
    this.push({ cancel: true });
  }

  /** Pushes what has happened, and does what follows. */
  async push(happened: Record<string, unknown>): Promise<void> {
    try {
      const parameters = { now_s: this.nowS, ...happened };
      const answer = await this.#machine.call<Pulled>('line.station', parameters);
      this.#take(answer.value);
      this.#hooks.pulled(answer);
      this.#sendNext();
    } catch (error) {
      this.#isBusy = false;
      this.#hooks.refused('', error);
    }
  }

  #take({ transmit, isBusy, activity, deadlineS }: Pulled): void {
    if (transmit.length > 0) {
      const written = this.#port?.write(new Uint8Array(transmit));
      written?.catch((error) => this.#hooks.refused('port', error));
    }
    clearTimeout(this.#deadline);
    if (deadlineS !== null && this.#port) {
      // Where the port's time is slower, it asks again.
      const ms = Math.max((deadlineS - this.nowS) * 1000, MIN_WAIT_MS);
      this.#deadline = window.setTimeout(() => this.push({}), Math.ceil(ms));
    }
    this.#isBusy = isBusy;
    this.#activity = activity;
  }

  #sendNext(): void {
    if (this.#isBusy || !this.#port) return;
    const send = this.#waiting.shift();
    if (!send) return;
    this.#isBusy = true;
    this.push({ send });
  }
}

/** A telegram that is text. */
export function asText(telegram: number[] | null): string | undefined {
  const isText = telegram?.every((byte) => byte >= 0x20 && byte < 0x7f) && telegram.length > 0;
  return isText ? String.fromCharCode(...(telegram ?? [])) : undefined;
}
