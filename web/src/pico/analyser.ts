// A logic analyser on the pins of the drivers: four traces, a cursor and a mark.
import { drawTimes, Picture, takeGestures, TIMES_PX } from '../shared/canvas';
import { colour, element, onClick, onColours } from '../shared/dom';
import { Edges } from './edges';
import { PINS } from './messages';

const NAMES = ['shoulder STEP', 'shoulder DIR', 'elbow STEP', 'elbow DIR'];
const STEP_PINS = [0, 2] as const;
/** What is seen at first, in s. */
const FIRST_SPAN_S = 1;
/** Cycles that are seen at the least. */
const MIN_SPAN = 20;
const LABEL_PX = 16;
/** A click nearer to an edge than this is on it. */
const CATCH_PX = 8;

export class Analyser {
  readonly #picture: Picture;
  readonly #told = element('pico-cursor', HTMLElement);
  readonly #follow = element('pico-follow', HTMLInputElement);
  #edges = new Edges();
  #hz = 1;
  /** All in cycles. */
  #now = 0;
  #from = 0;
  #span = 1;
  #cursor: number | undefined;
  #mark: number | undefined;

  constructor(canvas: HTMLCanvasElement) {
    this.#picture = new Picture(canvas, (context, width, height) =>
      this.#draw(context, width, height),
    );
    takeGestures(canvas, {
      pan: (dx) => this.#window(this.#from - (dx / this.#picture.width) * this.#span, this.#span),
      zoom: (factor, x) => {
        const span = Math.min(
          Math.max(this.#span / factor, MIN_SPAN),
          Math.max(this.#now, this.#hz),
        );
        // What follows is zoomed about its end.
        const part = this.#follow.checked ? 1 : x / this.#picture.width;
        this.#window(this.#from + part * (this.#span - span), span, this.#follow.checked);
      },
      reset: () => this.#window(0, Math.max(this.#now, this.#hz / 1000)),
      click: (x) => this.#click(x),
      focus: () => {
        const part = ((this.#cursor ?? Number.NaN) - this.#from) / this.#span;
        return [(part >= 0 && part <= 1 ? part : 0.5) * this.#picture.width, 0];
      },
    });
    canvas.addEventListener('keydown', ({ key }) => {
      const keys: Record<string, () => void> = {
        '[': () => this.#step(-1),
        ']': () => this.#step(1),
        m: () => this.#setMark(),
      };
      keys[key]?.();
    });
    onClick('pico-before', () => this.#step(-1));
    onClick('pico-after', () => this.#step(1));
    onClick('pico-mark', () => this.#setMark());
    this.#follow.addEventListener('input', () => this.#picture.redraw());
    onColours(() => this.#picture.redraw());
  }

  /** A Pico that is switched on. */
  begin(hz: number): void {
    this.#edges = new Edges();
    this.#hz = hz;
    this.#now = 0;
    [this.#cursor, this.#mark] = [undefined, undefined];
    this.#follow.checked = true;
    this.#span = FIRST_SPAN_S * hz;
    this.#tell();
  }

  get edges(): Edges {
    return this.#edges;
  }

  /** What has happened up to a cycle. */
  add(cycles: Float64Array, levels: Uint8Array, now: number): void {
    this.#edges.add(cycles, levels);
    this.#now = now;
    if (this.#follow.checked) this.#picture.redraw();
  }

  #window(from: number, span: number, follows = false): void {
    this.#follow.checked = follows;
    this.#span = span;
    this.#from = Math.max(from, 0);
    this.#picture.redraw();
  }

  #click(x: number): void {
    const at = this.#from + (x / this.#picture.width) * this.#span;
    const after = this.#edges.until(at);
    const near = [after - 1, after].map((edge) => this.#edges.cycle(edge));
    const [before = Number.NaN, next = Number.NaN] = near;
    const nearest = next - at < at - before || Number.isNaN(before) ? next : before;
    const isNear = Math.abs(nearest - at) <= (CATCH_PX / this.#picture.width) * this.#span;
    this.#setCursor(isNear ? nearest : Math.round(at));
  }

  /** To the edge before or after the cursor; without one, from what is in the middle. */
  #step(by: 1 | -1): void {
    const at = this.#cursor ?? this.#from + this.#span / 2;
    const edge = by > 0 ? this.#edges.until(at) : this.#edges.until(at - 1) - 1;
    const cycle = this.#edges.cycle(edge);
    if (Number.isNaN(cycle)) return;
    const isSeen = cycle >= this.#from && cycle <= this.#from + this.#span;
    this.#setCursor(cycle);
    this.#window(isSeen ? this.#from : cycle - this.#span / 2, this.#span);
  }

  #setCursor(cycle: number): void {
    this.#cursor = cycle;
    // Where it is looked at, it stays.
    this.#follow.checked = false;
    this.#tell();
  }

  #setMark(): void {
    this.#mark = this.#cursor;
    this.#tell();
  }

  #tell(): void {
    this.#told.textContent =
      this.#cursor === undefined ? NO_CURSOR : this.#tellCursor(this.#cursor);
    this.#picture.redraw();
  }

  #tellCursor(cycle: number): string {
    const edges = this.#edges;
    const at = edges.until(cycle);
    const levels = edges.levelsAfter(at);
    const pins = PINS.map((pin, bit) => `${pin} ${(levels >> bit) & 1 ? 'high' : 'low'}`);
    const place = `Cursor ${(cycle / this.#hz).toFixed(9)} s, cycle ${cycle}: ${pins.join(', ')}.`;
    if (this.#mark === undefined || this.#mark === cycle) return place;
    const cycles = cycle - this.#mark;
    const [from, to] = [Math.min(cycle, this.#mark), Math.max(cycle, this.#mark)];
    const between = [edges.until(from), edges.until(to)] as const;
    const [shoulder, elbow] = STEP_PINS.map((pin) => edges.rises(pin, ...between));
    const hz = Math.abs(this.#hz / cycles);
    return `${place} From the mark: ${cycles} cycles, ${duration(cycles / this.#hz)}, ${frequency(hz)}; ${shoulder} steps of the shoulder, ${elbow} of the elbow.`;
  }

  #draw(context: CanvasRenderingContext2D, width: number, height: number): void {
    if (this.#follow.checked) this.#from = Math.max(this.#now - this.#span, 0);
    const lane = (height - TIMES_PX) / PINS.length;
    context.font = '12px system-ui, sans-serif';
    drawTimes(context, this.#from / this.#hz, this.#span / this.#hz, width, height);
    for (const [pin, name] of NAMES.entries()) {
      const top = pin * lane;
      context.fillStyle = colour('quiet');
      context.fillText(`${PINS[pin]} ${name}`, 6, top + 12);
      context.strokeStyle = colour(`series-${pin + 1}`);
      this.#drawPin(context, pin, top + LABEL_PX, top + lane - 4, width);
    }
    this.#drawLine(context, this.#mark, 'good', width, height);
    this.#drawLine(context, this.#cursor, 'now', width, height);
  }

  #drawPin(
    context: CanvasRenderingContext2D,
    pin: number,
    high: number,
    low: number,
    width: number,
  ): void {
    const edges = this.#edges;
    const [first, last] = [edges.until(this.#from), edges.until(this.#from + this.#span)];
    const y = (level: number) => (level ? high : low);
    const end = Math.min(((this.#now - this.#from) / this.#span) * width, width);
    let level = (edges.levelsAfter(first) >> pin) & 1;
    let drawnTo = Number.NEGATIVE_INFINITY;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(0, y(level));
    for (let edge = first; edge < last; edge += 1) {
      const next = (edges.levelsAfter(edge + 1) >> pin) & 1;
      if (next === level) continue;
      const x = ((edges.cycle(edge) - this.#from) / this.#span) * width;
      // Edges in the same half of a pixel are one stroke, whatever comes last.
      if (x - drawnTo >= 0.5) {
        context.lineTo(x, y(level));
        context.lineTo(x, y(1 - level));
        drawnTo = x;
      } else {
        context.moveTo(x, y(next));
      }
      level = next;
    }
    if (end > 0) context.lineTo(end, y(level));
    context.stroke();
  }

  #drawLine(
    context: CanvasRenderingContext2D,
    cycle: number | undefined,
    name: string,
    width: number,
    height: number,
  ): void {
    if (cycle === undefined) return;
    const x = ((cycle - this.#from) / this.#span) * width;
    context.strokeStyle = colour(name);
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, height);
    context.stroke();
  }
}

const NO_CURSOR =
  'A click sets the cursor, on an edge if one is near. Drag to move; zoom with Ctrl and the wheel, two fingers, or + and -; 0 shows all; [ and ] go from edge to edge, M sets the mark.';

function duration(seconds: number): string {
  const size = Math.abs(seconds);
  if (size < 1e-3) return `${(seconds * 1e6).toFixed(3)} µs`;
  return size < 1 ? `${(seconds * 1e3).toFixed(6)} ms` : `${seconds.toFixed(9)} s`;
}

function frequency(hz: number): string {
  return hz < 1000 ? `${hz.toFixed(2)} Hz` : `${(hz / 1000).toFixed(3)} kHz`;
}
