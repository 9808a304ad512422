// The Pico in its worker, and the end of its serial line that the page holds.
import type { Port } from '../line/port';
import type { FromSwitches, Notice, Order, Told } from './messages';

/** Its line, as the firmware has it. */
const BAUD = 9600;
const PARITY = 'even';

/** The firmware's address, if the page was built with it. */
const [program] = Object.values(
  import.meta.glob<string>('../../built/arm-rp2040.elf', {
    query: '?url',
    import: 'default',
    eager: true,
  }),
);

/** What to say where there is no firmware. */
export const NO_FIRMWARE =
  'This page was built without the firmware of the Pico: web/build builds it, unless PAGE_FIRMWARE=no';
export const hasFirmware = program !== undefined;

/** What is told of it. */
export interface Watch {
  /** It is switched on, with so many cycles a second. */
  begun(hz: number): void;
  ran(notice: Notice): void;
  /** It has stopped, for good. */
  failed(error: Error): void;
}

export class Pico {
  readonly #watch: Watch;
  readonly #fromSwitches: FromSwitches;
  #worker: Worker | undefined;
  #started: Promise<void> | undefined;
  /** What it sends goes there. */
  #hear: ((bytes: Uint8Array) => void) | undefined;
  #hz = 1;
  /** Of the last notice. */
  #cycle = 0;

  constructor(fromSwitches: FromSwitches, watch: Watch) {
    this.#fromSwitches = fromSwitches;
    this.#watch = watch;
  }

  /** Its serial port; it is switched on where it is not. */
  async port(): Promise<Port> {
    this.#started ??= this.#start();
    try {
      await this.#started;
    } catch (error) {
      this.#started = undefined;
      throw error;
    }
    return new PicoPort(
      (bytes) => this.#order({ bytes }),
      (hear) => (this.#hear = hear),
      () => this.#cycle / this.#hz,
    );
  }

  /** The supply fails and comes back. */
  powerCycle(): void {
    this.#order('power');
  }

  async #start(): Promise<void> {
    if (program === undefined) throw new Error(NO_FIRMWARE);
    const response = await fetch(program);
    if (!response.ok) throw new Error(`the firmware: the server answers ${response.status}`);
    const bytes = await response.arrayBuffer();
    const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
    this.#worker = worker;
    await new Promise<void>((begun, refuse) => {
      worker.addEventListener('error', ({ message }) => refuse(this.#fail(message)));
      worker.addEventListener('message', ({ data }: MessageEvent<Told>) => {
        if ('error' in data) refuse(this.#fail(data.error));
        else if ('hz' in data) {
          this.#hz = data.hz;
          begun(this.#watch.begun(data.hz));
        } else this.#take(data);
      });
      this.#order({ program: bytes, fromSwitches: this.#fromSwitches });
    });
  }

  #order(order: Order): void {
    this.#worker?.postMessage(order);
  }

  #take(notice: Notice): void {
    this.#cycle = notice.cycle;
    if (notice.sent.length > 0) this.#hear?.(notice.sent);
    this.#watch.ran(notice);
  }

  #fail(message: string): Error {
    this.#worker?.terminate();
    this.#worker = undefined;
    this.#started = undefined;
    const error = new Error(message);
    this.#watch.failed(error);
    return error;
  }
}

/** As the browser's ports are. */
class PicoPort extends EventTarget implements Port {
  readable: ReadableStream<Uint8Array> | null = null;
  writable: WritableStream<Uint8Array> | null = null;
  readonly #send: (bytes: Uint8Array) => void;
  readonly #listen: (hear: ((bytes: Uint8Array) => void) | undefined) => void;
  readonly #now: () => number;

  constructor(
    send: (bytes: Uint8Array) => void,
    listen: (hear: ((bytes: Uint8Array) => void) | undefined) => void,
    now: () => number,
  ) {
    super();
    this.#send = send;
    this.#listen = listen;
    this.#now = now;
  }

  /** Of the Pico: where it is slower than real time, nothing on the line comes too late. */
  get nowS(): number {
    return this.#now();
  }

  async open({ baudRate, parity }: { baudRate: number; parity: string }): Promise<void> {
    if (baudRate !== BAUD || parity !== PARITY) {
      throw new Error(
        `the Pico's line has ${BAUD} bits per second and ${PARITY} parity, not ${baudRate} and ${parity}`,
      );
    }
    this.readable = new ReadableStream({
      start: (controller) => this.#listen((bytes) => controller.enqueue(bytes)),
      cancel: () => this.#listen(undefined),
    });
    this.writable = new WritableStream({ write: (bytes) => this.#send(bytes) });
  }

  async close(): Promise<void> {
    this.#listen(undefined);
  }
}
