// The machine from above: drawing, path by its distance from the drawing, and the arm at a time.
import { Picture, takeGestures } from '../shared/canvas';
import { colour, element, onColours } from '../shared/dom';
import { countUntil, type Engraving, PATH_STRIDE } from './engraving';

/** From near to far; told apart by those who see no red or green too. */
const NEAR_TO_FAR = ['#2563eb', '#0891b2', '#65a30d', '#eab308', '#f97316', '#dc2626'];
const DISC_MM = 5;

/** Of the canvas: pixels of a mm, and where the machine's origin is. */
interface View {
  scale: number;
  x: number;
  y: number;
}

export class Scene {
  readonly #picture: Picture;
  #engraving: Engraving | undefined;
  #seconds = 0;
  /** Unless it shows all. */
  #view: View | undefined;

  constructor(canvas: HTMLCanvasElement) {
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
    const steps = NEAR_TO_FAR.map(
      (it, index) =>
        `${it} ${(index / NEAR_TO_FAR.length) * 100}% ${((index + 1) / NEAR_TO_FAR.length) * 100}%`,
    );
    element('scale', HTMLElement).style.background = `linear-gradient(90deg, ${steps.join(', ')})`;
  }

  show(engraving: Engraving): void {
    this.#engraving = engraving;
    element('scale-end', HTMLElement).textContent =
      `${engraving.result.report.bound_mm.toFixed(3)} mm, the bound`;
    this.#picture.redraw();
  }

  at(seconds: number): void {
    this.#seconds = seconds;
    this.#picture.redraw();
  }

  #change(change: (view: View) => View | undefined): void {
    this.#view = change(this.#view ?? this.#all(this.#picture.width, this.#picture.height));
    this.#picture.redraw();
  }

  /** Bed and the arm's axis. */
  #all(width: number, height: number): View {
    const bed = this.#engraving?.result.report.machine.settings.bed;
    if (!bed) return { scale: 1, x: width / 2, y: height };
    const [left, right] = [Math.min(bed.x_mm, -20), Math.max(bed.x_mm + bed.width_mm, 20)];
    const [low, high] = [Math.min(bed.y_mm, -15), Math.max(bed.y_mm + bed.height_mm, 15)];
    const scale = 0.94 * Math.min(width / (right - left), height / (high - low));
    return {
      scale,
      x: width / 2 - (scale * (left + right)) / 2,
      y: height / 2 + (scale * (low + high)) / 2,
    };
  }

  #draw(context: CanvasRenderingContext2D, width: number, height: number): void {
    const engraving = this.#engraving;
    if (!engraving) return;
    const view = this.#view ?? this.#all(width, height);
    context.save();
    context.translate(view.x, view.y);
    context.scale(view.scale, -view.scale);
    const px = 1 / view.scale;
    context.lineJoin = 'round';
    context.lineCap = 'round';
    drawBed(context, engraving, px);
    drawOutlines(context, engraving, px);
    drawPath(context, engraving, this.#seconds, px);
    drawArm(context, engraving, this.#seconds, px);
    context.restore();
  }
}

function drawBed(context: CanvasRenderingContext2D, engraving: Engraving, px: number): void {
  const bed = engraving.result.report.machine.settings.bed;
  context.strokeStyle = colour('line');
  context.lineWidth = px;
  context.setLineDash([4 * px, 4 * px]);
  context.strokeRect(bed.x_mm, bed.y_mm, bed.width_mm, bed.height_mm);
  context.setLineDash([]);
}

function drawOutlines(
  context: CanvasRenderingContext2D,
  { outlines }: Engraving,
  px: number,
): void {
  context.beginPath();
  let isOpen = false;
  for (let index = 0; index < outlines.length; index += 2) {
    const [x, y] = [outlines[index] ?? Number.NaN, outlines[index + 1] ?? Number.NaN];
    if (Number.isNaN(x)) isOpen = false;
    else if (isOpen) context.lineTo(x, y);
    else {
      context.moveTo(x, y);
      isOpen = true;
    }
  }
  context.strokeStyle = colour('drawing');
  context.globalAlpha = 0.5;
  context.lineWidth = 5 * px;
  context.stroke();
  context.globalAlpha = 1;
}

/** The path until a time: lifted in one colour, engraved by its distance from the drawing. */
function drawPath(
  context: CanvasRenderingContext2D,
  engraving: Engraving,
  until: number,
  px: number,
): void {
  const { path } = engraving;
  const bound = engraving.result.report.bound_mm;
  const points = countUntil(path, until, PATH_STRIDE);
  const at = (point: number, value: number) => path[point * PATH_STRIDE + value] ?? 0;
  /** -1 above the glass. */
  const bucket = (point: number) => {
    if (at(point, 3) > 0 || at(point - 1, 3) > 0) return -1;
    const part = engraving.deviationAt(at(point, 0)) / bound;
    return Math.min(Math.floor(part * NEAR_TO_FAR.length), NEAR_TO_FAR.length - 1);
  };
  let current = bucket(1);
  context.beginPath();
  context.moveTo(at(0, 1), at(0, 2));
  const stroke = () => {
    context.strokeStyle = current < 0 ? colour('quiet') : (NEAR_TO_FAR[current] ?? '');
    context.lineWidth = (current < 0 ? 0.5 : 1.8) * px;
    context.stroke();
  };
  for (let point = 1; point < points; point += 1) {
    const next = bucket(point);
    if (next !== current) {
      stroke();
      context.beginPath();
      context.moveTo(at(point - 1, 1), at(point - 1, 2));
      current = next;
    }
    context.lineTo(at(point, 1), at(point, 2));
  }
  stroke();
}

function drawArm(
  context: CanvasRenderingContext2D,
  engraving: Engraving,
  seconds: number,
  px: number,
): void {
  const { elbow, tool, disc } = engraving.pose(seconds);
  context.strokeStyle = colour('arm');
  context.fillStyle = colour('arm');
  context.globalAlpha = 0.75;
  context.lineWidth = 7 * px;
  context.beginPath();
  context.moveTo(0, 0);
  context.lineTo(...elbow);
  context.lineTo(...tool);
  context.stroke();
  for (const [x, y] of [[0, 0], elbow] as const) {
    context.beginPath();
    context.arc(x, y, 8 * px, 0, 2 * Math.PI);
    context.fill();
  }
  // The disc stands on edge: from above a line along the stroke.
  const [dx, dy] = [DISC_MM * Math.cos(disc), DISC_MM * Math.sin(disc)];
  context.strokeStyle = colour('now');
  context.globalAlpha = 1;
  context.lineWidth = 3 * px;
  context.beginPath();
  context.moveTo(tool[0] - dx, tool[1] - dy);
  context.lineTo(tool[0] + dx, tool[1] + dy);
  context.stroke();
}
