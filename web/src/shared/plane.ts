// A plane in mm, seen from above: moved and zoomed by hand.
import { Picture, takeGestures } from './canvas';
import { element, onColours } from './dom';
import { intoLink, linkChanged, numbersFromLink } from './store';

/** In mm. */
export interface Bounds {
  left: number;
  right: number;
  low: number;
  high: number;
}

/** What is in the middle of the canvas, in mm, and how much larger it is than where all is seen. */
interface View {
  x: number;
  y: number;
  zoom: number;
}

/** Draws in mm, y upward; a pixel is so many mm. */
type DrawPlane = (context: CanvasRenderingContext2D, px: number) => void;

export class Plane {
  readonly #picture: Picture;
  readonly #bounds: () => Bounds | undefined;
  readonly #drawPlane: DrawPlane;
  /** Unless it shows all. */
  #view: View | undefined;

  /** Without bounds there is nothing to draw yet. `pick` is told a place that is clicked, in mm. */
  constructor(
    canvas: HTMLCanvasElement,
    bounds: () => Bounds | undefined,
    draw: DrawPlane,
    pick?: (x: number, y: number) => void,
  ) {
    this.#bounds = bounds;
    this.#drawPlane = draw;
    const [x, y, zoom] = numbersFromLink('view', 3) ?? [];
    if (x !== undefined && y !== undefined && zoom !== undefined && zoom > 0) {
      this.#view = { x, y, zoom };
    }
    intoLink('view', () => this.#view && [this.#view.x, this.#view.y, this.#view.zoom]);
    this.#picture = new Picture(canvas, (context, width, height) =>
      this.#draw(context, width, height),
    );
    takeGestures(canvas, {
      pan: (dx, dy) =>
        this.#change((view, scale) => ({
          ...view,
          x: view.x - dx / scale,
          y: view.y + dy / scale,
        })),
      zoom: (factor, px, py) =>
        this.#change((view, scale) => {
          const by = (1 - 1 / factor) / scale;
          const [dx, dy] = [px - this.#picture.width / 2, this.#picture.height / 2 - py];
          return { x: view.x + dx * by, y: view.y + dy * by, zoom: view.zoom * factor };
        }),
      reset: () => this.#change(() => undefined),
      click: (px, py) => {
        const seen = this.#seen;
        if (!seen) return;
        const { view, scale } = seen;
        const [right, up] = [px - this.#picture.width / 2, this.#picture.height / 2 - py];
        pick?.(view.x + right / scale, view.y + up / scale);
      },
    });
    onColours(() => this.#picture.redraw());
  }

  redraw(): void {
    this.#picture.redraw();
  }

  /** What is seen, and the pixels of a mm. */
  get #seen(): { view: View; scale: number } | undefined {
    const bounds = this.#bounds();
    if (!bounds) return undefined;
    const view = this.#view ?? all(bounds);
    const { width, height } = this.#picture;
    return { view, scale: view.zoom * fit(bounds, width, height) };
  }

  #change(change: (view: View, scale: number) => View | undefined): void {
    const seen = this.#seen;
    if (!seen) return;
    this.#view = change(seen.view, seen.scale);
    linkChanged();
    this.#picture.redraw();
  }

  #draw(context: CanvasRenderingContext2D, width: number, height: number): void {
    const seen = this.#seen;
    if (!seen) return;
    const { view, scale } = seen;
    context.save();
    context.translate(width / 2 - scale * view.x, height / 2 + scale * view.y);
    context.scale(scale, -scale);
    context.lineJoin = 'round';
    context.lineCap = 'round';
    this.#drawPlane(context, 1 / scale);
    context.restore();
  }
}

function all({ left, right, low, high }: Bounds): View {
  return { x: (left + right) / 2, y: (low + high) / 2, zoom: 1 };
}

/** Pixels of a mm with which all is seen. */
function fit({ left, right, low, high }: Bounds, width: number, height: number): number {
  return 0.94 * Math.min(width / (right - left), height / (high - low));
}

/** Colours that are told apart by those who see no red or green, too. */
const SCALES = {
  /** From near to far: the last is at the bound. */
  distance: ['#2563eb', '#0891b2', '#65a30d', '#eab308', '#f97316', '#dc2626'],
  /** From slow to fast: none is wrong. */
  speed: ['#7c3aed', '#4f6bed', '#2f8fdd', '#16a5b8', '#1db58b', '#4cc35a'],
};
export type ScaleName = keyof typeof SCALES;
const PARTS = 6;

/** The part of the scale of a value from 0 to its end. */
export function scalePart(value: number): number {
  return Math.min(Math.max(Math.floor(value * PARTS), 0), PARTS - 1);
}

export function scaleColour(scale: ScaleName, part: number): string {
  return SCALES[scale][part] ?? '';
}

/** Shows the scale beside its ends in a legend. */
export function showScale(id: string, scale: ScaleName): void {
  const steps = SCALES[scale].map(
    (it, index) => `${it} ${(index / PARTS) * 100}% ${((index + 1) / PARTS) * 100}%`,
  );
  element(id, HTMLElement).style.background = `linear-gradient(90deg, ${steps.join(', ')})`;
}

/** What is nearer to the point before is not seen, in pixels. */
const NEAR_PX = 0.7;
/** Points that a browser draws in a frame. */
const MAX_POINTS = 40_000;

/** How far apart points are drawn, in mm, so that there are not too many; `walk` tells each. */
function spacing(px: number, walk: (each: (x: number, y: number) => void) => void): number {
  const near = NEAR_PX * px;
  let [lastX, lastY, seen] = [Infinity, Infinity, 0];
  walk((x, y) => {
    if (isNear(x - lastX, y - lastY, near)) return;
    [lastX, lastY] = [x, y];
    seen += 1;
  });
  return near * Math.max(seen / MAX_POINTS, 1);
}

function isNear(dx: number, dy: number, near: number): boolean {
  return Math.abs(dx) < near && Math.abs(dy) < near;
}

/** Lines through points of a list, x and y side by side; no number between two lines. */
export function strokeLines(
  context: CanvasRenderingContext2D,
  points: Float64Array,
  px: number,
): void {
  const near = spacing(px, (each) => {
    for (let index = 0; index < points.length; index += 2) {
      each(points[index] ?? Number.NaN, points[index + 1] ?? Number.NaN);
    }
  });
  context.beginPath();
  let isOpen = false;
  let [lastX, lastY] = [0, 0];
  for (let index = 0; index < points.length; index += 2) {
    const [x, y] = [points[index] ?? Number.NaN, points[index + 1] ?? Number.NaN];
    if (Number.isNaN(x)) {
      isOpen = false;
      continue;
    }
    const isEnd = Number.isNaN(points[index + 2] ?? Number.NaN);
    if (isOpen && !isEnd && isNear(x - lastX, y - lastY, near)) continue;
    if (isOpen) context.lineTo(x, y);
    else context.moveTo(x, y);
    [isOpen, lastX, lastY] = [true, x, y];
  }
  context.stroke();
}

/** A line of points whose parts look apart: `part` tells how the stretch to a point looks. */
export function strokeParts(
  context: CanvasRenderingContext2D,
  points: number,
  px: number,
  at: (point: number) => [number, number],
  part: (point: number) => number,
  look: (part: number) => void,
): void {
  if (points < 2) return;
  const near = spacing(px, (each) => {
    for (let point = 0; point < points; point += 1) each(...at(point));
  });
  let current = part(1);
  const stroke = () => {
    look(current);
    context.stroke();
  };
  let [lastX, lastY] = at(0);
  context.beginPath();
  context.moveTo(lastX, lastY);
  for (let point = 1; point < points; point += 1) {
    const next = part(point);
    const [x, y] = at(point);
    if (next !== current) {
      const [beforeX, beforeY] = at(point - 1);
      context.lineTo(beforeX, beforeY);
      stroke();
      context.beginPath();
      context.moveTo(beforeX, beforeY);
      current = next;
    } else if (point + 1 < points && isNear(x - lastX, y - lastY, near)) {
      continue;
    }
    context.lineTo(x, y);
    [lastX, lastY] = [x, y];
  }
  stroke();
}
