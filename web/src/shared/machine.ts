// A machine's wasm as the pages use it: calls that are answered, or given up for newer ones.
import type { Notice, Order } from './worker';

/** What a call gives back. */
export interface Answer<T> {
  value: T;
  blobs: Record<string, ArrayBuffer>;
}

/** How far a call is: its stage from 0, and the fraction of this that is done. */
export type Progress = (stage: number, fraction: number) => void;

interface Waiting {
  resolve(answer: Answer<unknown>): void;
  reject(error: Error): void;
  progress: Progress | undefined;
}

/** A call that a newer one has made useless. */
export class Superseded extends Error {}

/** From a server that calls it by another type, too. */
async function compile(url: string): Promise<WebAssembly.Module> {
  const name = url.slice(url.lastIndexOf('/') + 1);
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${name}: the server answers ${response.status}`);
  const isWasm = response.headers.get('content-type') === 'application/wasm';
  return isWasm
    ? WebAssembly.compileStreaming(response)
    : WebAssembly.compile(await response.arrayBuffer());
}

export class Machine {
  readonly #module: Promise<WebAssembly.Module>;
  #worker: Worker | undefined;
  #waiting = new Map<number, Waiting>();
  #calls = 0;
  #turn = 0;

  constructor(wasm: string) {
    this.#module = compile(wasm);
  }

  /** Asks for an operation; the error is what the machine says against it, in one line. */
  async call<T>(operation: string, parameters: unknown, progress?: Progress): Promise<Answer<T>> {
    const module = await this.#module;
    this.#worker ??= this.#start(module);
    const worker = this.#worker;
    this.#calls += 1;
    const id = this.#calls;
    return new Promise<Answer<T>>((resolve, reject) => {
      const accept = resolve as (answer: Answer<unknown>) => void;
      this.#waiting.set(id, { resolve: accept, reject, progress });
      worker.postMessage({ id, operation, parameters } satisfies Order);
    });
  }

  /**
   * Gives up what is under way, if something is; what the machine remembers is lost with it.
   * The turn that begins.
   */
  stop(): number {
    if (this.#waiting.size > 0) this.#end(new Superseded());
    this.#turn += 1;
    return this.#turn;
  }

  /** Whether nothing was given up since that turn began. */
  isTurn(turn: number): boolean {
    return turn === this.#turn;
  }

  #start(module: WebAssembly.Module): Worker {
    const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
    worker.addEventListener('message', ({ data }: MessageEvent<Notice>) => this.#take(data));
    worker.addEventListener('error', ({ message }) => this.#end(new Error(message)));
    worker.postMessage({ module } satisfies Order);
    return worker;
  }

  #end(error: Error): void {
    this.#worker?.terminate();
    this.#worker = undefined;
    for (const { reject } of this.#waiting.values()) reject(error);
    this.#waiting.clear();
  }

  #take(notice: Notice): void {
    const waiting = this.#waiting.get(notice.id);
    if (!waiting) return;
    if ('fraction' in notice) {
      waiting.progress?.(notice.stage, notice.fraction);
      return;
    }
    this.#waiting.delete(notice.id);
    if ('error' in notice) {
      waiting.reject(new Error(notice.error));
      if (notice.error.startsWith('internal error')) this.#end(new Error(notice.error));
    } else {
      waiting.resolve(notice);
    }
  }
}
