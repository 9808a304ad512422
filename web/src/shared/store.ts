// Keeps what was put in: in the address, so that it can be sent, and texts in the browser, too.
import { settled } from './dom';
import { pack, unpack } from './packing';

/** Whether the address says what is to be seen; a bare one leaves it to what the browser has kept. */
export const isLinked = location.search.length > 1 || location.hash.length > 1;

/** Longer links are cut by the programs that pass them on; a text that needs more stays out of them. */
const MAX_FRAGMENT = 60_000;
const MAX_TEXT = 1_000_000;
/** The address is not written for each of the values that change one after the other. */
const SETTLE_MS = 200;

/** What the address has after the `#`. */
const carried = await unpack(location.hash.slice(1));
const givers = new Map<string, () => unknown>();
const namers: (() => Record<string, string | null>)[] = [];
let writes = 0;

/** Why the rest of the address was not read, if it was not. */
export const damage: string | undefined = 'damage' in carried ? carried.damage : undefined;

/** A value of the address, if it is there. */
export function fromAddress(name: string): string | null {
  return new URLSearchParams(location.search).get(name);
}

/** Puts values into the address; null takes one out. What else it carries is written when this ends. */
export async function toAddress(values: Record<string, string | null>): Promise<void> {
  history.replaceState(null, '', location.pathname + queryWith(values) + location.hash);
  await writeLink();
}

function queryWith(values: Record<string, string | null>): string {
  const query = new URLSearchParams(location.search);
  for (const [name, value] of Object.entries(values)) {
    if (value === null) query.delete(name);
    else query.set(name, value);
  }
  return query.size > 0 ? `?${query}` : '';
}

/** A text that the address carries. */
export function textFromLink(name: string): string | undefined {
  const value = valueFromLink(name);
  return typeof value === 'string' ? value : undefined;
}

/** As many numbers as there must be, that the address carries. */
export function numbersFromLink(name: string, count: number): number[] | undefined {
  const value = valueFromLink(name);
  const isWhole = Array.isArray(value) && value.length === count && value.every(Number.isFinite);
  return isWhole ? value : undefined;
}

/** Fields of a form by their names, that the address carries. */
export function fieldsFromLink(name: string): Record<string, string | boolean> | undefined {
  const value = valueFromLink(name);
  if (typeof value !== 'object' || value === null || Array.isArray(value)) return undefined;
  const isField = (it: unknown) => typeof it === 'string' || typeof it === 'boolean';
  return Object.values(value).every(isField)
    ? (value as Record<string, string | boolean>)
    : undefined;
}

function valueFromLink(name: string): unknown {
  return 'values' in carried && Object.hasOwn(carried.values, name)
    ? carried.values[name]
    : undefined;
}

/** Has the address carry what `give` gives when it is written; nothing where it is as at first. */
export function intoLink(name: string, give: () => unknown): void {
  givers.set(name, give);
}

/** Has the address name values that change often, when it is written. */
export function intoAddress(give: () => Record<string, string | null>): void {
  namers.push(give);
}

/** What is carried has changed. */
export const linkChanged = settled(SETTLE_MS, () => void writeLink());

/** The address with all that it carries, and what had no room in it. */
export async function writeLink(): Promise<{ url: string; isWhole: boolean }> {
  writes += 1;
  const write = writes;
  const named = Object.assign({}, ...namers.map((give) => give()));
  const given = [...givers].map(([name, give]) => [name, give()] as const);
  const values = Object.fromEntries(given.filter(([, value]) => value !== undefined));
  // What is deflated would stay too long.
  const isLong = Object.values(values).some(
    (value) => typeof value === 'string' && value.length > MAX_TEXT,
  );
  const whole = isLong ? undefined : await pack(values, MAX_FRAGMENT);
  const short = Object.entries(values).filter(([, value]) => typeof value !== 'string');
  const packed = whole ?? (await pack(Object.fromEntries(short), MAX_FRAGMENT)) ?? '';
  const isWhole = whole !== undefined;
  const path = location.pathname + queryWith(named) + (packed && `#${packed}`);
  // What was begun later has seen what came in between.
  if (write === writes) history.replaceState(null, '', path);
  return { url: new URL(path, location.href).href, isWhole };
}

/** A text that this browser has kept. */
export function kept(name: string): string | null {
  try {
    return localStorage.getItem(`pose2pulse ${name}`);
  } catch {
    return null; // The store is closed to this page.
  }
}

/** Keeps a text; null forgets it. Without room or permission it is not kept. */
export function keep(name: string, text: string | null): void {
  try {
    if (text === null) localStorage.removeItem(`pose2pulse ${name}`);
    else localStorage.setItem(`pose2pulse ${name}`, text);
  } catch {
    // The page works without.
  }
}

/** Whether opening a text of one's own has ended the page: then it is not opened again by itself. */
export class Trial {
  readonly hasFailed: boolean;
  readonly #name: string;
  #trials = 0;

  constructor(name: string) {
    this.#name = `${name} trying`;
    this.hasFailed = kept(this.#name) !== null;
    // A page that can be left is alive.
    addEventListener('pagehide', () => keep(this.#name, null));
  }

  begin(): void {
    this.#trials += 1;
    keep(this.#name, 'yes');
  }

  /** When what came of it has been drawn. */
  end(): void {
    const trial = this.#trials;
    requestAnimationFrame(() =>
      setTimeout(() => {
        if (trial === this.#trials) keep(this.#name, null);
      }),
    );
  }
}
