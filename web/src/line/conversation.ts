// What was said on a line, as the machine tells it: steps, characters, and the verdict.
import type { Answer } from '../shared/machine';
import { countWhile } from '../shared/rows';

export interface Step {
  /** In s, as a capture has it. */
  at: string;
  side: 'A' | 'B' | null;
  kind: 'good' | 'neutral' | 'unusual' | 'fault';
  /** Whether something was sent, or did not come. */
  isSent: boolean;
  text: string;
}

export interface Verdict {
  kind: 'good' | 'neutral' | 'fault';
  sentence: string;
  /** All that the command line prints. */
  text: string;
}

/** What a call tells that is new. */
export interface News {
  steps: Step[];
  verdict: Verdict | null;
}

export interface Character {
  atS: number;
  side: 'A' | 'B';
  byte: number;
  isDamaged: boolean;
}

/** The oldest half of more than this is forgotten here; the machine keeps more for its files. */
const MAX_STEPS = 50_000;
const MAX_CHARACTERS = 500_000;

export class Conversation {
  steps: Step[] = [];
  verdict: Verdict | undefined;
  /** Until when the line was heard, in s. */
  nowS = 0;
  #times: number[] = [];
  #characters: number[] = [];

  take({ value, blobs }: Answer<News>): void {
    // One by one: a call takes no hundred thousand arguments.
    for (const step of value.steps) this.steps.push(step);
    if (value.verdict) this.verdict = value.verdict;
    for (const time of new Float64Array(blobs.times ?? new ArrayBuffer(0))) {
      this.#times.push(time);
    }
    for (const bits of new Uint32Array(blobs.characters ?? new ArrayBuffer(0))) {
      this.#characters.push(bits);
    }
    this.nowS = Math.max(this.nowS, this.#times.at(-1) ?? 0, Number(this.steps.at(-1)?.at ?? 0));
    if (this.steps.length > MAX_STEPS) this.steps = this.steps.slice(-MAX_STEPS / 2);
    if (this.#times.length > MAX_CHARACTERS) {
      this.#times = this.#times.slice(-MAX_CHARACTERS / 2);
      this.#characters = this.#characters.slice(-MAX_CHARACTERS / 2);
    }
  }

  /** When the first character came. */
  get beginS(): number {
    return this.#times[0] ?? 0;
  }

  /** When the last character came. */
  get endS(): number {
    return this.#times.at(-1) ?? 0;
  }

  /** When a side first asked to send. */
  get requestS(): number {
    const request = this.steps.find((it) => it.kind === 'neutral') ?? this.steps[0];
    return Number(request?.at ?? 0);
  }

  /** The characters that ended in a span of time. */
  *between(fromS: number, toS: number): Iterable<Character> {
    const isBefore = (at: number) => (this.#times[at] ?? Infinity) < fromS;
    const first = countWhile(this.#times.length, isBefore);
    for (let at = first; at < this.#times.length; at += 1) {
      const [atS, bits] = [this.#times[at] ?? 0, this.#characters[at] ?? 0];
      if (atS > toS) return;
      const side = bits & 0x100 ? 'B' : 'A';
      yield { atS, side, byte: bits & 0xff, isDamaged: (bits & 0x200) !== 0 };
    }
  }
}
