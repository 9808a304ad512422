// The arm from above: where its motors have turned it, and where its tool has been.
import { drawLinks, type Point } from '../shared/arm';
import { colour } from '../shared/dom';
import { Plane, strokeLines } from '../shared/plane';
import { Joints, LINKS_MM } from './joints';
import type { FromSwitches } from './messages';

const REACH_MM = LINKS_MM[0] + LINKS_MM[1];
/** What is nearer to the point before is not kept. */
const NEAR_MM = 0.1;
/** Points of the tool's way; where there are more, the older half is forgotten. */
const MAX_POINTS = 20_000;

export class Scene {
  readonly #plane: Plane;
  #joints: Joints;
  /** x and y of the tool, side by side. */
  #way: number[] = [];
  /** The place that was clicked last, in mm. */
  target: Point | undefined;

  constructor(canvas: HTMLCanvasElement, fromSwitches: FromSwitches, picked: () => void) {
    this.#joints = new Joints(fromSwitches);
    const bounds = { left: -REACH_MM, right: REACH_MM, low: -REACH_MM, high: REACH_MM };
    this.#plane = new Plane(
      canvas,
      () => bounds,
      (context, px) => this.#draw(context, px),
      (x, y) => {
        this.target = [x, y];
        this.#plane.redraw();
        picked();
      },
    );
    this.#note();
  }

  /** The arm as it is switched on. */
  begin(fromSwitches: FromSwitches): void {
    this.#joints = new Joints(fromSwitches);
    this.#way = [];
    this.#note();
    this.#plane.redraw();
  }

  drive(levels: Uint8Array): void {
    let hasTurned = false;
    for (const it of levels) {
      if (!this.#joints.drive(it)) continue;
      hasTurned = true;
      this.#note();
    }
    if (hasTurned) this.#plane.redraw();
  }

  get steps(): FromSwitches {
    return this.#joints.steps;
  }

  get tool(): Point {
    return this.#joints.pose.tool;
  }

  #note(): void {
    const [x, y] = this.tool;
    const [lastX = Infinity, lastY = Infinity] = this.#way.slice(-2);
    if (Math.hypot(x - lastX, y - lastY) < NEAR_MM) return;
    this.#way.push(x, y);
    if (this.#way.length > 2 * MAX_POINTS) this.#way = this.#way.slice(-MAX_POINTS);
  }

  #draw(context: CanvasRenderingContext2D, px: number): void {
    context.strokeStyle = colour('line');
    context.lineWidth = px;
    context.setLineDash([4 * px, 4 * px]);
    context.beginPath();
    context.arc(0, 0, REACH_MM, 0, 2 * Math.PI);
    context.stroke();
    context.setLineDash([]);
    context.strokeStyle = colour('series-1');
    context.lineWidth = 1.8 * px;
    const [x, y] = this.tool;
    strokeLines(context, Float64Array.from([...this.#way, x, y]), px);
    context.strokeStyle = colour('arm');
    context.fillStyle = colour('arm');
    drawLinks(context, this.#joints.pose, px);
    context.fillStyle = colour('now');
    context.beginPath();
    context.arc(x, y, 4 * px, 0, 2 * Math.PI);
    context.fill();
    if (this.target) drawTarget(context, this.target, px);
  }
}

function drawTarget(context: CanvasRenderingContext2D, [x, y]: Point, px: number): void {
  const arm = 7 * px;
  context.strokeStyle = colour('now');
  context.lineWidth = 2 * px;
  context.beginPath();
  context.moveTo(x - arm, y);
  context.lineTo(x + arm, y);
  context.moveTo(x, y - arm);
  context.lineTo(x, y + arm);
  context.stroke();
}
