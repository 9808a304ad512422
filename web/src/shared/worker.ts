// Runs the machines' wasm beside the page, so that the page never waits for it.

/** What the page sends: first the module, then calls. */
export type Order =
  { module: WebAssembly.Module } | { id: number; operation: string; parameters: unknown };

/** What it gets back. */
export type Notice =
  | { id: number; stage: number; fraction: number }
  | { id: number; value: unknown; blobs: Record<string, ArrayBuffer> }
  | { id: number; error: string };

interface Exports {
  memory: WebAssembly.Memory;
  input(length: number): number;
  call(): number;
  output(index: number): number;
  output_length(index: number): number;
}

const encoder = new TextEncoder();
const decoder = new TextDecoder();
let exports: Promise<Exports>;
let current = 0;

function post(notice: Notice, transfer: Transferable[] = []): void {
  postMessage(notice, { transfer });
}

async function instantiate(module: WebAssembly.Module): Promise<Exports> {
  const page = {
    progress: (stage: number, fraction: number) => post({ id: current, stage, fraction }),
  };
  const instance = await WebAssembly.instantiate(module, { page });
  return instance.exports as unknown as Exports;
}

function write(wasm: Exports, text: string): void {
  const bytes = encoder.encode(text);
  const address = wasm.input(bytes.length);
  new Uint8Array(wasm.memory.buffer, address, bytes.length).set(bytes);
}

function read(wasm: Exports, index: number): ArrayBuffer {
  const address = wasm.output(index);
  return wasm.memory.buffer.slice(address, address + wasm.output_length(index)) as ArrayBuffer;
}

function perform(wasm: Exports, operation: string, parameters: unknown): Notice {
  write(wasm, operation);
  write(wasm, JSON.stringify(parameters));
  const isDone = wasm.call() === 1;
  const text = decoder.decode(read(wasm, 0));
  if (!isDone) return { id: current, error: text };
  const head = JSON.parse(text) as { value: unknown; blobs: string[] };
  const blobs = head.blobs.map((name, index) => [name, read(wasm, index + 1)] as const);
  return { id: current, value: head.value, blobs: Object.fromEntries(blobs) };
}

addEventListener('message', async ({ data }: MessageEvent<Order>) => {
  if ('module' in data) {
    exports = instantiate(data.module);
    return;
  }
  try {
    const wasm = await exports;
    current = data.id;
    const notice = perform(wasm, data.operation, data.parameters);
    post(notice, 'blobs' in notice ? Object.values(notice.blobs) : []);
  } catch (error) {
    // A trap leaves the module as it was in the middle: the page starts another worker.
    post({ id: data.id, error: `internal error: ${error}` });
    close();
  }
});
