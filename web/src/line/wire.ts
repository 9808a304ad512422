// Both directions over time, character by character.
import { drawTimes, Picture, takeGestures, TIMES_PX } from '../shared/canvas';
import { colour, onColours } from '../shared/dom';
import { intoLink, linkChanged, numbersFromLink } from '../shared/store';
import type { Character, Conversation } from './conversation';

const NAMES: Record<number, string> = { 0x02: 'STX', 0x03: 'ETX', 0x10: 'DLE', 0x15: 'NAK' };
/** Of the usual line: 9600 bit/s, 11 bits. */
const CHARACTER_S = 11 / 9600;
const MIN_SPAN_S = 0.01;
/** Characters that a port may hand over at once. */
const MAX_TOGETHER = 256;
/** What is seen of a line at first: single characters, a telegram or two. */
const FIRST_SPAN_S = 0.03;
const NAME_PX = 20;

export class Wire {
  readonly #picture: Picture;
  readonly #note: HTMLElement;
  #conversation: Conversation | undefined;
  #from = 0;
  #span = FIRST_SPAN_S;
  #follows = false;
  /** Where a conversation begins to be seen. */
  #firstFrom = 0;
  /** As the link has it, for the first conversation. */
  #asked = numbersFromLink('wire', 2);

  constructor(canvas: HTMLCanvasElement, note: HTMLElement) {
    this.#note = note;
    intoLink('wire', () => {
      const isAtFirst = this.#follows || this.#from === this.#firstFrom;
      return isAtFirst && this.#span === FIRST_SPAN_S ? undefined : [this.#from, this.#span];
    });
    this.#picture = new Picture(canvas, (context, width, height) =>
      this.#draw(context, width, height),
    );
    takeGestures(canvas, {
      pan: (dx) => {
        this.#follows = false;
        this.#window(this.#from - (dx / this.#picture.width) * this.#span, this.#span);
      },
      zoom: (factor, x) => {
        const span = Math.max(this.#span / factor, MIN_SPAN_S);
        const part = this.#follows ? 1 : x / this.#picture.width;
        this.#window(this.#from + part * (this.#span - span), span);
      },
      reset: () => this.#all(),
    });
    onColours(() => this.#picture.redraw());
  }

  /** Another conversation: its first request, or what comes last. */
  show(conversation: Conversation, follows: boolean): void {
    this.#conversation = conversation;
    this.#follows = follows;
    this.#firstFrom = conversation.requestS - 0.003;
    const [from, span] = (conversation.steps.length > 0 && this.#asked) || [];
    if (from !== undefined && span !== undefined) {
      this.#asked = undefined;
      this.#follows = false;
      this.#window(from, Math.max(span, MIN_SPAN_S));
    } else {
      this.#window(this.#firstFrom, FIRST_SPAN_S);
    }
  }

  /** More of the same conversation. */
  update(): void {
    this.#window(this.#from, this.#span);
  }

  /** Puts a time into the middle. */
  at(seconds: number): void {
    this.#follows = false;
    this.#window(seconds - this.#span / 2, this.#span);
  }

  #all(): void {
    const { beginS, nowS } = this.#conversation ?? { beginS: 0, nowS: 0 };
    this.#follows = false;
    this.#window(beginS - 0.02, Math.max(nowS - beginS + 0.04, MIN_SPAN_S));
  }

  #window(from: number, span: number): void {
    this.#span = span;
    // The last character, not the silence after it.
    this.#from = this.#follows ? (this.#conversation?.endS ?? 0) + span / 20 - span : from;
    const digits = span < 0.1 ? 4 : 2;
    const [low, high] = [this.#from, this.#from + span].map((it) =>
      Math.max(it, 0).toFixed(digits),
    );
    this.#note.textContent = `${low} s to ${high} s. Drag to move; zoom with Ctrl and the wheel, two fingers, or + and -; 0 shows all. A click on a step shows it here.`;
    linkChanged();
    this.#picture.redraw();
  }

  #draw(context: CanvasRenderingContext2D, width: number, height: number): void {
    const lane = (height - TIMES_PX) / 2;
    const x = (seconds: number) => ((seconds - this.#from) / this.#span) * width;
    context.font = '12px system-ui, sans-serif';
    drawTimes(context, this.#from, this.#span, width, height);
    const end = this.#from + this.#span + MAX_TOGETHER * CHARACTER_S;
    const heard = [...(this.#conversation?.between(this.#from, end) ?? [])];
    for (const [index, side] of (['A', 'B'] as const).entries()) {
      const top = index * lane + NAME_PX;
      let drawnTo = -Infinity;
      for (const { character, fromS, toS } of places(heard.filter((it) => it.side === side))) {
        // What is narrower than half a pixel is not seen beside the one before.
        if (x(toS) < drawnTo + 0.5) continue;
        drawnTo = x(toS);
        drawCharacter(context, character, x(fromS), drawnTo, top, lane - NAME_PX);
      }
    }
    context.textAlign = 'left';
    context.textBaseline = 'top';
    for (const [index, name] of ['A to B', 'B to A'].entries()) {
      context.fillStyle = colour('text');
      context.fillText(name, 6, index * lane + 4);
    }
  }
}

interface Placed {
  character: Character;
  fromS: number;
  toS: number;
}

/** The time of each character of a side on the wire: what came in at once came one after the other. */
function places(characters: Character[]): Placed[] {
  const placed: Placed[] = [];
  let before = -Infinity;
  for (let first = 0; first < characters.length;) {
    const atS = characters[first]?.atS ?? 0;
    const rest = characters.slice(first, first + MAX_TOGETHER);
    const together = rest.filter((it) => it.atS === atS);
    const begin = Math.max(atS - together.length * CHARACTER_S, before);
    const length = (atS - begin) / together.length;
    for (const [index, character] of together.entries()) {
      const fromS = begin + index * length;
      placed.push({ character, fromS, toS: fromS + length });
    }
    before = atS;
    first += together.length;
  }
  return placed;
}

function drawCharacter(
  context: CanvasRenderingContext2D,
  { side, byte, isDamaged }: Character,
  from: number,
  to: number,
  top: number,
  height: number,
): void {
  const width = Math.max(to - from - 1, 1);
  const isControl = byte in NAMES;
  const plain = colour(side === 'A' ? 'series-1' : 'series-2');
  context.fillStyle = isDamaged || byte === 0x15 ? colour('bad') : plain;
  context.globalAlpha = isControl || isDamaged ? 1 : 0.6;
  context.fillRect(from, top, width, height - 6);
  context.globalAlpha = 1;
  const name = NAMES[byte] ?? byte.toString(16).toUpperCase().padStart(2, '0');
  if (width < context.measureText(name).width + 4) return;
  context.fillStyle = colour('back');
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillText(name, (from + to) / 2, top + height / 2 - 3);
}
