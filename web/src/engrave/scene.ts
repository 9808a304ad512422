// The machine from above: drawing, path by its distance from the drawing, and the arm at a time.
import { drawLinks } from '../shared/arm';
import { colour, element } from '../shared/dom';
import {
  type Bounds,
  Plane,
  scaleColour,
  scalePart,
  showScale,
  strokeLines,
  strokeParts,
} from '../shared/plane';
import { countUntil } from '../shared/rows';
import { type Engraving, PATH_STRIDE } from './engraving';

const DISC_MM = 5;
/** Times at which the arm is looked at for the space that it needs. */
const LOOKS = 200;
/** Above the glass. */
const LIFTED = -1;

export class Scene {
  readonly #plane: Plane;
  #engraving: Engraving | undefined;
  #bounds: Bounds | undefined;
  #seconds = 0;

  constructor(canvas: HTMLCanvasElement) {
    this.#plane = new Plane(
      canvas,
      () => this.#bounds,
      (context, px) => this.#draw(context, px),
    );
    showScale('scale', 'distance');
  }

  show(engraving: Engraving): void {
    this.#engraving = engraving;
    this.#bounds = bounds(engraving);
    element('scale-end', HTMLElement).textContent =
      `${engraving.shown.bound_mm.toFixed(3)} mm, the bound`;
    this.#plane.redraw();
  }

  at(seconds: number): void {
    this.#seconds = seconds;
    this.#plane.redraw();
  }

  #draw(context: CanvasRenderingContext2D, px: number): void {
    const engraving = this.#engraving;
    if (!engraving) return;
    drawBed(context, engraving, px);
    context.strokeStyle = colour('drawing');
    context.globalAlpha = 0.5;
    context.lineWidth = 5 * px;
    strokeLines(context, engraving.outlines, px);
    context.globalAlpha = 1;
    drawPath(context, engraving, this.#seconds, px);
    drawArm(context, engraving, this.#seconds, px);
  }
}

/** Bed, the arm's axis and its elbow. */
function bounds(engraving: Engraving): Bounds {
  const { x_mm, y_mm, width_mm, height_mm } = engraving.result.report.machine.settings.bed;
  const elbows = Array.from(
    { length: LOOKS + 1 },
    (_, look) => engraving.pose((look / LOOKS) * engraving.shown.duration_s).elbow,
  );
  const [x, y] = [elbows.map((it) => it[0]), elbows.map((it) => it[1])];
  return {
    left: Math.min(x_mm, -20, ...x),
    right: Math.max(x_mm + width_mm, 20, ...x),
    low: Math.min(y_mm, -15, ...y),
    high: Math.max(y_mm + height_mm, 15, ...y),
  };
}

function drawBed(context: CanvasRenderingContext2D, engraving: Engraving, px: number): void {
  const bed = engraving.result.report.machine.settings.bed;
  context.strokeStyle = colour('line');
  context.lineWidth = px;
  context.setLineDash([4 * px, 4 * px]);
  context.strokeRect(bed.x_mm, bed.y_mm, bed.width_mm, bed.height_mm);
  context.setLineDash([]);
}

/** The path until a time: lifted in one colour, engraved by its distance from the drawing. */
function drawPath(
  context: CanvasRenderingContext2D,
  engraving: Engraving,
  until: number,
  px: number,
): void {
  const { path } = engraving;
  const bound = engraving.shown.bound_mm;
  const at = (point: number, value: number) => path[point * PATH_STRIDE + value] ?? 0;
  strokeParts(
    context,
    countUntil(path, until, PATH_STRIDE),
    px,
    (point) => [at(point, 1), at(point, 2)],
    (point) =>
      at(point, 3) > 0 || at(point - 1, 3) > 0
        ? LIFTED
        : scalePart(engraving.deviationAt(at(point, 0)) / bound),
    (part) => {
      context.strokeStyle = part === LIFTED ? colour('quiet') : scaleColour('distance', part);
      context.lineWidth = (part === LIFTED ? 0.5 : 1.8) * px;
    },
  );
}

function drawArm(
  context: CanvasRenderingContext2D,
  engraving: Engraving,
  seconds: number,
  px: number,
): void {
  const { disc, ...pose } = engraving.pose(seconds);
  context.strokeStyle = colour('arm');
  context.fillStyle = colour('arm');
  drawLinks(context, pose, px);
  // The disc stands on edge: from above a line along the stroke.
  const [dx, dy] = [DISC_MM * Math.cos(disc), DISC_MM * Math.sin(disc)];
  const [x, y] = pose.tool;
  context.strokeStyle = colour('now');
  context.lineWidth = 3 * px;
  context.beginPath();
  context.moveTo(x - dx, y - dy);
  context.lineTo(x + dx, y + dy);
  context.stroke();
}
