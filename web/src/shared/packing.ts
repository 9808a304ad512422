// Values as characters of an address: JSON, deflated, in base64 for addresses.

/** What no page has: an address that would unpack to more is refused before it fills the memory. */
const MAX_BYTES = 20_000_000;

export type Unpacked = { values: Record<string, unknown> } | { damage: string };

/** Nothing for no values; undefined for more than so many characters. */
export async function pack(
  values: Record<string, unknown>,
  most: number,
): Promise<string | undefined> {
  if (Object.keys(values).length === 0) return '';
  const json = new Blob([JSON.stringify(values)]).stream();
  const packed = json.pipeThrough(new CompressionStream('deflate-raw'));
  const bytes = new Uint8Array(await new Response(packed).arrayBuffer());
  if ((bytes.length * 4) / 3 > most) return undefined;
  return base64(bytes).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

/** The values of `pack`; or what is wrong with the characters. */
export async function unpack(text: string): Promise<Unpacked> {
  if (text === '') return { values: {} };
  try {
    const binary = atob(text.replaceAll('-', '+').replaceAll('_', '/'));
    const bytes = Uint8Array.from(binary, (it) => it.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
    const values: unknown = JSON.parse(await read(stream));
    if (typeof values !== 'object' || values === null) throw new Error('no values');
    return { values: values as Record<string, unknown> };
  } catch {
    return { damage: 'the link is damaged: what stands after its # cannot be read' };
  }
}

async function read(stream: ReadableStream<Uint8Array>): Promise<string> {
  const decoder = new TextDecoder('utf-8', { fatal: true });
  const reader = stream.getReader();
  let [text, length] = ['', 0];
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return text + decoder.decode();
    length += value.length;
    if (length > MAX_BYTES) throw new Error('too long');
    text += decoder.decode(value, { stream: true });
  }
}

function base64(bytes: Uint8Array): string {
  let binary = '';
  for (const byte of bytes) binary += String.fromCharCode(byte);
  return btoa(binary);
}
