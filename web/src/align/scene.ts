// The body on its locators; its moves can be drawn larger than they are.
import { colour } from '../shared/dom';
import { type Ball, closed, extent, type Pen, type Point3, Space } from '../shared/space';
import type { Moment } from './aligned';

/** Of the posts that are drawn under the locators. */
const POST_MM = 700;
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
    for (const [index, locator] of locators.entries()) {
      const [x, y, z] = start.locators[index] ?? locator;
      pen.line(colour('arm'), 8, [[x, y, z - POST_MM], locator]);
    }
    pen.line(colour('drawing'), 3, closed(start.outline));
    pen.line(colour('line'), 1, closed(locators));
    pen.line(colour('accent'), 4, closed(drawn(start.outline, now.outline)));
    for (const locator of locators) pen.dot(colour('now'), 6, locator);
  }

  #larger(from: Point3, to: Point3): Point3 {
    const along = (axis: 0 | 1 | 2) => from[axis] + (to[axis] - from[axis]) * this.#factor;
    return [along(0), along(1), along(2)];
  }
}

/** All that is drawn, from every side. */
function ball({ outline, locators }: Moment): Ball {
  const { middle, half } = extent([...outline, ...locators]);
  const radius = MARGIN * Math.max(Math.hypot(...half), 1);
  const halfHeight = MARGIN * Math.max(half[1], half[2], 1);
  const [x, y, z] = middle;
  return { centre: [x, y, z - POST_MM / 3], radius, halfHeight };
}
