// The step pins over time: how many pulses where there are many, single edges where there is room.
import { drawTimes, Picture, takeGestures, TIMES_PX } from '../shared/canvas';
import { colour, onColours } from '../shared/dom';
import { countUntil } from '../shared/rows';
import { intoLink, linkChanged, numbersFromLink } from '../shared/store';
import { AXES, type Axis, type Engraving } from './engraving';

const NAMES: Record<Axis, string> = {
  elbow: 'elbow, forearm',
  shoulder: 'shoulder, upper arm',
  disc: 'disc',
  vertical: 'vertical, lift',
};
const LABEL_PX = 16;
/** Edges closer than this are drawn as a density. */
const SINGLE_PX = 3;
/** The least that is shown: some ticks of the timer. */
const MIN_SPAN_S = 2e-5;

export class Lanes {
  readonly #picture: Picture;
  readonly #note: HTMLElement;
  #engraving: Engraving | undefined;
  #from = 0;
  #span = 1;
  #seconds = 0;
  #seek: (seconds: number) => void = () => undefined;
  /** From when and how long, as the link has it, for the first engraving. */
  #asked: number[] | undefined;

  constructor(canvas: HTMLCanvasElement, note: HTMLElement) {
    this.#note = note;
    this.#asked = numbersFromLink('lanes', 2);
    intoLink('lanes', () => (this.#span === this.#duration ? undefined : [this.#from, this.#span]));
    this.#picture = new Picture(canvas, (context, width, height) =>
      this.#draw(context, width, height),
    );
    takeGestures(canvas, {
      pan: (dx) => this.#window(this.#from - (dx / this.#picture.width) * this.#span, this.#span),
      zoom: (factor, x) => {
        const span = Math.max(this.#span / factor, MIN_SPAN_S);
        const at = this.#from + (x / this.#picture.width) * this.#span;
        this.#window(at - (x / this.#picture.width) * span, span);
      },
      reset: () => this.#window(0, this.#duration),
      click: (x) => this.#seek(this.#from + (x / this.#picture.width) * this.#span),
      // The time that the pictures show, while it is in sight.
      focus: () => {
        const part = (this.#seconds - this.#from) / this.#span;
        return [(part >= 0 && part <= 1 ? part : 0.5) * this.#picture.width, 0];
      },
    });
    onColours(() => this.#picture.redraw());
  }

  onSeek(seek: (seconds: number) => void): void {
    this.#seek = seek;
  }

  show(engraving: Engraving): void {
    this.#engraving = engraving;
    const [from = 0, span = this.#duration] = this.#asked ?? [];
    this.#asked = undefined;
    this.#window(from, Math.max(span, MIN_SPAN_S));
  }

  at(seconds: number): void {
    this.#seconds = seconds;
    this.#picture.redraw();
  }

  get #duration(): number {
    return this.#engraving?.shown.duration_s ?? 1;
  }

  #window(from: number, span: number): void {
    this.#span = Math.min(span, this.#duration);
    this.#from = Math.min(Math.max(from, 0), this.#duration - this.#span);
    const digits = Math.max(0, 3 - Math.floor(Math.log10(this.#span)));
    const [low, high] = [this.#from, this.#from + this.#span].map((it) =>
      it.toFixed(Math.min(digits, 7)),
    );
    this.#note.textContent = `${low} s to ${high} s. Drag to move; zoom with Ctrl and the wheel, two fingers, or + and -; a click sets the time.`;
    linkChanged();
    this.#picture.redraw();
  }

  #draw(context: CanvasRenderingContext2D, width: number, height: number): void {
    const engraving = this.#engraving;
    if (!engraving) return;
    const lane = (height - TIMES_PX) / AXES.length;
    context.font = '12px system-ui, sans-serif';
    const x = (seconds: number) => ((seconds - this.#from) / this.#span) * width;
    for (const [index, axis] of AXES.entries()) {
      const top = index * lane;
      context.fillStyle = colour('quiet');
      const position = engraving.position(axis, this.#seconds);
      context.fillText(`${NAMES[axis]}: ${position} steps from home`, 6, top + 12);
      context.strokeStyle = colour(`series-${index + 1}`);
      context.fillStyle = colour(`series-${index + 1}`);
      this.#drawPin(context, engraving, axis, [top + LABEL_PX + 2, top + lane - 4], width);
    }
    drawTimes(context, this.#from, this.#span, width, height);
    context.strokeStyle = colour('now');
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x(this.#seconds), 0);
    context.lineTo(x(this.#seconds), height);
    context.stroke();
  }

  #drawPin(
    context: CanvasRenderingContext2D,
    engraving: Engraving,
    axis: Axis,
    [high, low]: [number, number],
    width: number,
  ): void {
    const { edges } = engraving.pins[axis];
    const first = countUntil(edges, this.#from);
    const last = countUntil(edges, this.#from + this.#span);
    const perPx = this.#span / width;
    if (last - first > width / SINGLE_PX) {
      // In each pixel, how much of the time pulses follow each other as fast as anywhere in sight.
      const counts = Array.from({ length: Math.ceil(width) }, (_, px) => {
        const from = this.#from + px * perPx;
        return countUntil(edges, from + perPx) - countUntil(edges, from);
      });
      const most = Math.max(...counts, 1);
      for (const [px, count] of counts.entries()) {
        context.globalAlpha = 0.25 + (0.75 * count) / most;
        if (count > 0)
          context.fillRect(
            px,
            low - ((low - high) * count) / most,
            1,
            ((low - high) * count) / most,
          );
      }
      context.globalAlpha = 1;
      return;
    }
    context.lineWidth = 1.5;
    context.beginPath();
    // An even number of edges leaves the pin low.
    let level = first % 2 === 0 ? low : high;
    context.moveTo(0, level);
    for (let edge = first; edge < last; edge += 1) {
      const x = ((edges[edge] ?? 0) - this.#from) / perPx;
      context.lineTo(x, level);
      level = edge % 2 === 0 ? high : low;
      context.lineTo(x, level);
    }
    context.lineTo(width, level);
    context.stroke();
  }
}
