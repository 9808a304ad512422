// A plane in mm, seen from above: moved and zoomed by hand.
import { Picture, takeGestures } from './canvas';
import { element, onColours } from './dom';

/** In mm. */
export interface Bounds {
  left: number;
  right: number;
  low: number;
  high: number;
}

/** Of the canvas: pixels of a mm, and where the plane's origin is. */
interface View {
  scale: number;
  x: number;
  y: number;
}

/** Draws in mm, y upward; a pixel is so many mm. */
type DrawPlane = (context: CanvasRenderingContext2D, px: number) => void;

export class Plane {
  readonly #picture: Picture;
  readonly #bounds: () => Bounds | undefined;
  readonly #drawPlane: DrawPlane;
  /** Unless it shows all. */
  #view: View | undefined;

  /** Without bounds there is nothing to draw yet. */
  constructor(canvas: HTMLCanvasElement, bounds: () => Bounds | undefined, draw: DrawPlane) {
    this.#bounds = bounds;
    this.#drawPlane = draw;
    this.#picture = new Picture(canvas, (context, width, height) =>
      this.#draw(context, width, height),
    );
    takeGestures(canvas, {
      pan: (dx, dy) => this.#change((view) => ({ ...view, x: view.x + dx, y: view.y + dy })),
      zoom: (factor, x, y) =>
        this.#change((view) => ({
          scale: view.scale * factor,
          x: x + (view.x - x) * factor,
          y: y + (view.y - y) * factor,
        })),
      reset: () => this.#change(() => undefined),
    });
    onColours(() => this.#picture.redraw());
  }

  redraw(): void {
    this.#picture.redraw();
  }

  #change(change: (view: View) => View | undefined): void {
    const view = this.#view ?? this.#all(this.#picture.width, this.#picture.height);
    if (view) this.#view = change(view);
    this.#picture.redraw();
  }

  #all(width: number, height: number): View | undefined {
    const bounds = this.#bounds();
    if (!bounds) return undefined;
    const { left, right, low, high } = bounds;
    const scale = 0.94 * Math.min(width / (right - left), height / (high - low));
    return {
      scale,
      x: width / 2 - (scale * (left + right)) / 2,
      y: height / 2 + (scale * (low + high)) / 2,
    };
  }

  #draw(context: CanvasRenderingContext2D, width: number, height: number): void {
    const view = this.#view ?? this.#all(width, height);
    if (!view || !this.#bounds()) return;
    context.save();
    context.translate(view.x, view.y);
    context.scale(view.scale, -view.scale);
    context.lineJoin = 'round';
    context.lineCap = 'round';
    this.#drawPlane(context, 1 / view.scale);
    context.restore();
  }
}

/** From near to far, or slow to fast; told apart by those who see no red or green too. */
const SCALE = ['#2563eb', '#0891b2', '#65a30d', '#eab308', '#f97316', '#dc2626'];

/** The part of the scale of a value from 0 to its end. */
export function scalePart(value: number): number {
  return Math.min(Math.max(Math.floor(value * SCALE.length), 0), SCALE.length - 1);
}

export function scaleColour(part: number): string {
  return SCALE[part] ?? '';
}

/** Shows the scale beside its ends in a legend. */
export function showScale(id: string): void {
  const steps = SCALE.map(
    (it, index) => `${it} ${(index / SCALE.length) * 100}% ${((index + 1) / SCALE.length) * 100}%`,
  );
  element(id, HTMLElement).style.background = `linear-gradient(90deg, ${steps.join(', ')})`;
}

/** Lines through points of a list, x and y side by side; no number between two lines. */
export function strokeLines(context: CanvasRenderingContext2D, points: Float64Array): void {
  context.beginPath();
  let isOpen = false;
  for (let index = 0; index < points.length; index += 2) {
    const [x, y] = [points[index] ?? Number.NaN, points[index + 1] ?? Number.NaN];
    if (Number.isNaN(x)) isOpen = false;
    else if (isOpen) context.lineTo(x, y);
    else {
      context.moveTo(x, y);
      isOpen = true;
    }
  }
  context.stroke();
}

/** A line of points whose parts look apart: `part` tells how the stretch to a point looks. */
export function strokeParts(
  context: CanvasRenderingContext2D,
  points: number,
  at: (point: number) => [number, number],
  part: (point: number) => number,
  look: (part: number) => void,
): void {
  if (points < 2) return;
  let current = part(1);
  const stroke = () => {
    look(current);
    context.stroke();
  };
  context.beginPath();
  context.moveTo(...at(0));
  for (let point = 1; point < points; point += 1) {
    const next = part(point);
    if (next !== current) {
      stroke();
      context.beginPath();
      context.moveTo(...at(point - 1));
      current = next;
    }
    context.lineTo(...at(point));
  }
  stroke();
}
