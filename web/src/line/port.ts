// A serial port of the browser: opened, read until it is closed, what goes wrong told.

/** Of the Web Serial API, what is used here. */
export interface Port extends EventTarget {
  readonly readable: ReadableStream<Uint8Array> | null;
  readonly writable: WritableStream<Uint8Array> | null;
  open(options: { baudRate: number; parity: string; bufferSize: number }): Promise<void>;
  close(): Promise<void>;
  /** Its time in s, if that is not of this computer. */
  readonly nowS?: number;
}

interface Serial {
  requestPort(): Promise<Port>;
}

/** What came in in place of a character. */
export type Damage = 'parity' | 'framing' | 'overrun' | 'break';

/** By the names of the errors after which a port can be read on. */
const DAMAGE: Record<string, Damage> = {
  ParityError: 'parity',
  FramingError: 'framing',
  BufferOverrunError: 'overrun',
  BreakError: 'break',
};

export interface Listener {
  hear(bytes: Uint8Array): void;
  damaged(damage: Damage): void;
  /** The port is gone: unplugged, or closed. */
  ended(why: unknown): void;
}

/** The chooser was closed without a port. */
export class NoPortChosen extends Error {}

export const serial = (navigator as unknown as { serial?: Serial }).serial;

/** Lets the user choose a port. */
export async function choosePort(): Promise<Port> {
  if (!serial) throw new Error('this browser has no Web Serial: Chrome, Edge and Opera have it');
  return serial.requestPort().catch((error: unknown) => {
    const isCancelled = error instanceof DOMException && error.name === 'NotFoundError';
    throw isCancelled ? new NoPortChosen() : error;
  });
}

export class OpenPort {
  readonly #port: Port;
  readonly #writer: WritableStreamDefaultWriter<Uint8Array>;
  #reader: ReadableStreamDefaultReader<Uint8Array> | undefined;
  #isOpen = true;
  #reading: Promise<void>;

  private constructor(port: Port, writable: WritableStream<Uint8Array>, listener: Listener) {
    this.#port = port;
    this.#writer = writable.getWriter();
    this.#reading = this.#read(listener);
  }

  static async open(
    port: Port,
    baudRate: number,
    parity: string,
    listener: Listener,
  ): Promise<OpenPort> {
    await port.open({ baudRate, parity, bufferSize: 4096 });
    if (!port.writable) throw new Error('the port cannot be written to');
    return new OpenPort(port, port.writable, listener);
  }

  /** The time of what it hears and sends, in s. */
  get nowS(): number {
    return this.#port.nowS ?? performance.now() / 1000;
  }

  write(bytes: Uint8Array): Promise<void> {
    return this.#writer.write(bytes);
  }

  async close(): Promise<void> {
    this.#isOpen = false;
    await this.#reader?.cancel().catch(() => undefined);
    await this.#reading;
    this.#writer.releaseLock();
    await this.#port.close().catch(() => undefined);
  }

  async #read(listener: Listener): Promise<void> {
    // After an error that is none of the port's end, it has another stream.
    while (this.#isOpen && this.#port.readable) {
      const reader = this.#port.readable.getReader();
      this.#reader = reader;
      try {
        for (;;) {
          const { value, done } = await reader.read();
          if (done) break;
          listener.hear(value);
        }
        if (this.#isOpen) listener.ended('the port has ended');
        return;
      } catch (error) {
        const damage = error instanceof Error ? DAMAGE[error.name] : undefined;
        if (damage === undefined) {
          listener.ended(error);
          return;
        }
        listener.damaged(damage);
      } finally {
        reader.releaseLock();
      }
    }
  }
}
