// A canvas that is as sharp as the screen, drawn again when it changes its size.
import { colour } from './dom';

/** Draws in units of CSS pixels. */
export type Draw = (context: CanvasRenderingContext2D, width: number, height: number) => void;

export class Picture {
  readonly canvas: HTMLCanvasElement;
  readonly #context: CanvasRenderingContext2D;
  readonly #draw: Draw;
  #isAsked = false;

  constructor(canvas: HTMLCanvasElement, draw: Draw) {
    const context = canvas.getContext('2d');
    if (!context) throw new Error('this browser draws no canvas');
    this.canvas = canvas;
    this.#context = context;
    this.#draw = draw;
    new ResizeObserver(() => this.redraw()).observe(canvas);
  }

  get width(): number {
    return this.canvas.clientWidth;
  }

  get height(): number {
    return this.canvas.clientHeight;
  }

  /** Draws before the next frame, however often it is asked. */
  redraw(): void {
    if (this.#isAsked) return;
    this.#isAsked = true;
    requestAnimationFrame(() => {
      this.#isAsked = false;
      this.#fit();
      this.#context.clearRect(0, 0, this.width, this.height);
      this.#draw(this.#context, this.width, this.height);
    });
  }

  #fit(): void {
    const [width, height] = [this.width, this.height].map((it) =>
      Math.round(it * devicePixelRatio),
    );
    if (width === undefined || height === undefined) return;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    this.#context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  }
}

/** Height under a canvas along time that its times are written in. */
export const TIMES_PX = 20;
/** From one time to the next, at least. */
const TICK_PX = 100;

/** Lines at round times, each with its time below. */
export function drawTimes(
  context: CanvasRenderingContext2D,
  fromS: number,
  spanS: number,
  width: number,
  height: number,
): void {
  const least = spanS / Math.max(width / TICK_PX, 2);
  const power = 10 ** Math.floor(Math.log10(least));
  const step = ([1, 2, 5].find((it) => it * power >= least) ?? 10) * power;
  // Powers of ten are not met exactly.
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  context.fillStyle = colour('quiet');
  context.strokeStyle = colour('line');
  context.lineWidth = 1;
  context.textAlign = 'left';
  context.textBaseline = 'alphabetic';
  const first = Math.max(Math.ceil(fromS / step), 0);
  // Of times as large as a capture may have them, the next number may be the same.
  for (let tick = first; tick * step < fromS + spanS && tick + 1 > tick; tick += 1) {
    const x = Math.round(((tick * step - fromS) / spanS) * width) + 0.5;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, height - TIMES_PX + 4);
    context.stroke();
    context.fillText(`${(tick * step).toFixed(digits)} s`, x + 3, height - 6);
  }
}

/** Moves and zooms by wheel, pointers and keys; factors above 1 enlarge about a point. */
export interface Gestures {
  pan(dx: number, dy: number): void;
  zoom(factor: number, x: number, y: number): void;
  reset(): void;
  /** What is dragged instead of the view, if something is at this place. */
  grab?(x: number, y: number): ((dx: number, dy: number) => void) | undefined;
  /** A click that has dragged nothing. */
  click?(x: number, y: number): void;
  /** What keys zoom about, unless the middle. */
  focus?(): [number, number];
}

const KEY_STEP = 40;
const KEY_ZOOM = 1.4;
/** Below it, a pointer has clicked and not dragged. */
const DRAG_PX = 3;

export function takeGestures(canvas: HTMLCanvasElement, gestures: Gestures): void {
  const pointers = new Map<number, [number, number]>();
  let held: ((dx: number, dy: number) => void) | undefined;
  let draggedPx = 0;
  canvas.addEventListener(
    'wheel',
    (event) => {
      // The page itself is scrolled by the wheel; with Ctrl, or pinched, the picture is zoomed.
      if (!event.ctrlKey && !event.shiftKey && document.activeElement !== canvas) return;
      event.preventDefault();
      gestures.zoom(1.0015 ** -(event.deltaY || event.deltaX), event.offsetX, event.offsetY);
    },
    { passive: false },
  );
  canvas.addEventListener('pointerdown', (event) => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    if (pointers.size === 1) draggedPx = 0;
    held = pointers.size === 1 ? gestures.grab?.(event.offsetX, event.offsetY) : undefined;
  });
  canvas.addEventListener('pointermove', (event) => {
    const from = pointers.get(event.pointerId);
    if (!from) return;
    const to: [number, number] = [event.offsetX, event.offsetY];
    draggedPx += Math.hypot(to[0] - from[0], to[1] - from[1]);
    const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const apart = (it: [number, number]) => Math.hypot(it[0] - other[0], it[1] - other[1]);
      gestures.zoom(apart(to) / Math.max(apart(from), 1), other[0], other[1]);
    } else {
      (held ?? gestures.pan)(to[0] - from[0], to[1] - from[1]);
    }
    pointers.set(event.pointerId, to);
  });
  const up = (event: PointerEvent) => {
    pointers.delete(event.pointerId);
    held = undefined;
  };
  canvas.addEventListener('pointerup', up);
  canvas.addEventListener('pointercancel', up);
  canvas.addEventListener('click', (event) => {
    if (draggedPx < DRAG_PX) gestures.click?.(event.offsetX, event.offsetY);
  });
  canvas.addEventListener('dblclick', () => gestures.reset());
  canvas.addEventListener('keydown', (event) => {
    const middle = gestures.focus?.() ?? [canvas.clientWidth / 2, canvas.clientHeight / 2];
    const keys: Record<string, () => void> = {
      ArrowLeft: () => gestures.pan(KEY_STEP, 0),
      ArrowRight: () => gestures.pan(-KEY_STEP, 0),
      ArrowUp: () => gestures.pan(0, KEY_STEP),
      ArrowDown: () => gestures.pan(0, -KEY_STEP),
      '+': () => gestures.zoom(KEY_ZOOM, ...middle),
      '-': () => gestures.zoom(1 / KEY_ZOOM, ...middle),
      '0': () => gestures.reset(),
    };
    const act = keys[event.key === '=' ? '+' : event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}
