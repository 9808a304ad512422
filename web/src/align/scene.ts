// The body on its locators; its moves can be drawn larger than they are.
import { colour } from '../shared/dom';
import {
  type Ball,
  closed,
  drawFloor,
  extent,
  type Pen,
  type Point3,
  Space,
} from '../shared/space';
import type { Moment } from './aligned';

/** Of the posts that are drawn under the locators. */
const POST_MM = 700;
/** Half of the width of their feet. */
const FOOT_MM = 160;
/** Of the squares of the floor. */
const SQUARE_MM = 500;
/** Between the edges of the body, that a panel has. */
const STRINGERS = 7;
/** Around the body, for its moves. */
const MARGIN = 1.1;

export class Scene {
  readonly space: Space;
  #start: Moment | undefined;
  #now: Moment | undefined;
  #factor = 1;

  constructor(canvas: HTMLCanvasElement) {
    this.space = new Space(
      canvas,
      () => this.#start && ball(this.#start),
      (pen) => this.#draw(pen),
    );
  }

  /** What moves are seen against. */
  set start(start: Moment | undefined) {
    this.#start = start;
    this.space.redraw();
  }

  set now(now: Moment | undefined) {
    this.#now = now;
    this.space.redraw();
  }

  set factor(factor: number) {
    this.#factor = factor;
    this.space.redraw();
  }

  #draw(pen: Pen): void {
    const start = this.#start;
    const now = this.#now ?? start;
    if (!start || !now) return;
    const drawn = (from: Point3[], to: Point3[]) =>
      to.map((point, index) => this.#larger(from[index] ?? point, point));
    const locators = drawn(start.locators, now.locators);
    const outline = drawn(start.outline, now.outline);
    const floor = Math.min(...start.locators.map((it) => it[2])) - POST_MM;
    const { middle, half } = extent([...start.outline, ...start.locators]);
    const below: Point3 = [middle[0], middle[1], floor];
    drawFloor(pen, colour('line'), colour('quiet'), below, Math.max(half[0], half[1]), SQUARE_MM);
    const onFloor = outline.map(([x, y]): Point3 => [x, y, floor]);
    pen.face(colour('text'), 0.12, onFloor);
    for (const [index, locator] of locators.entries()) {
      const [x, y] = start.locators[index] ?? locator;
      pen.face(colour('arm'), 0.8, square([x, y, floor], FOOT_MM));
      pen.line(colour('arm'), 9, [[x, y, floor], locator]);
    }
    pen.line(colour('drawing'), 2, closed(start.outline));
    drawPanel(pen, outline);
    for (const locator of locators) pen.dot(colour('now'), 6, locator);
  }

  #larger(from: Point3, to: Point3): Point3 {
    const along = (axis: 0 | 1 | 2) => from[axis] + (to[axis] - from[axis]) * this.#factor;
    return [along(0), along(1), along(2)];
  }
}

function square([x, y, z]: Point3, half: number): Point3[] {
  const corners = [
    [-1, -1],
    [1, -1],
    [1, 1],
    [-1, 1],
  ] as const;
  return corners.map(([dx, dy]): Point3 => [x + dx * half, y + dy * half, z]);
}

/** A skin over ribs from one edge of the outline to the other, and stringers across them. */
function drawPanel(pen: Pen, outline: Point3[]): void {
  const half = Math.floor(outline.length / 2);
  const ribs = Array.from({ length: half }, (_, rib) => [
    outline[rib] ?? [0, 0, 0],
    outline[outline.length - 1 - rib] ?? [0, 0, 0],
  ]) as [Point3, Point3][];
  const skin = colour('accent');
  pen.face(skin, 0.2, outline);
  for (const rib of ribs) pen.line(skin, 1.5, rib);
  for (let stringer = 1; stringer < STRINGERS; stringer += 1) {
    const part = stringer / STRINGERS;
    const across = ribs.map(([a, b]): Point3 => {
      const mix = (axis: 0 | 1 | 2) => a[axis] + (b[axis] - a[axis]) * part;
      return [mix(0), mix(1), mix(2)];
    });
    pen.context.globalAlpha = 0.5;
    pen.line(skin, 1, across);
    pen.context.globalAlpha = 1;
  }
  pen.line(skin, 4, closed(outline));
}

/** All that is drawn, from every side. */
function ball({ outline, locators }: Moment): Ball {
  const { middle, half } = extent([...outline, ...locators]);
  const radius = MARGIN * Math.max(Math.hypot(...half), 1);
  const halfHeight = MARGIN * Math.max(half[1], half[2], 1);
  const [x, y, z] = middle;
  return { centre: [x, y, z - POST_MM / 3], radius, halfHeight };
}
