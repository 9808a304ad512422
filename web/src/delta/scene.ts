// The robot in space: workspace, lines, path, and the mechanism at a time. Points can be dragged.
import { colour, element } from '../shared/dom';
import {
  type Ball,
  closed,
  drawFloor,
  extent,
  type Pen,
  type Point3,
  Space,
} from '../shared/space';
import type { Driving } from './driving';
import { moved, type Waypoint, waypoints } from './points';

/** A point is held when it is so near to the pointer. */
const HOLD_PX = 12;
/** Around all that is drawn. */
const MARGIN = 1.1;
export const ARM_COLOURS = ['series-1', 'series-2', 'series-4'] as const;

export class Scene {
  readonly space: Space;
  #driving: Driving | undefined;
  #seconds = 0;
  #text = '';
  #points: Waypoint[] = [];
  #bad = new Set<number>();
  /** Where a board says that its platform is. */
  #said: Point3 | undefined;

  /** `change` gets the text with a point that has been dragged. */
  constructor(canvas: HTMLCanvasElement, change: (text: string) => void) {
    this.space = new Space(
      canvas,
      () => this.#driving && ball(this.#driving),
      (pen) => this.#draw(pen),
      (project, x, y) => {
        const near = this.#points.map((point) => {
          const [px, py] = project(point.point);
          return { point, px: Math.hypot(px - x, py - y) };
        });
        const held = near.sort((a, b) => a.px - b.px)[0];
        if (!held || held.px > HOLD_PX) return undefined;
        let at = held.point.point;
        return (by) => {
          at = at.map((it, axis) => it + (by[axis] ?? 0)) as Point3;
          change(moved(this.#text, { line: held.point.line, point: at }));
        };
      },
    );
  }

  /** The lines as they are written; the machine may not have seen them yet. */
  set text(text: string) {
    this.#text = text;
    this.#points = waypoints(text);
    this.space.redraw();
  }

  show(driving: Driving): void {
    this.#driving = driving;
    this.#bad = new Set(driving.result.refusedLines);
    this.space.redraw();
  }

  at(seconds: number): void {
    this.#seconds = seconds;
    this.space.redraw();
  }

  say(place: Point3 | undefined): void {
    this.#said = place;
    element('said-key', HTMLElement).hidden = place === undefined;
    this.space.redraw();
  }

  #draw(pen: Pen): void {
    const driving = this.#driving;
    if (!driving) return;
    const { context } = pen;
    drawWorkspace(pen, driving.workspace);
    context.globalAlpha = 0.6;
    for (const line of driving.lines) pen.line(colour('drawing'), 5, [line.from, line.to]);
    context.globalAlpha = 1;
    drawMechanism(pen, driving, this.#seconds);
    pen.line(colour('series-3'), 2, driving.path(this.#seconds));
    for (const { line, point } of this.#points) {
      pen.dot(colour(this.#bad.has(line) ? 'bad' : 'text'), this.#bad.has(line) ? 6 : 4, point);
    }
    if (this.#said) pen.dot(colour('series-2'), 7, this.#said);
  }
}

/** Of the squares of the floor. */
const SQUARE_MM = 50;

/** The rings at heights as a surface, above the floor that it stands on. */
function drawWorkspace(pen: Pen, outlines: Point3[][]): void {
  const isRing = (outline: Point3[]) => outline.every((it) => it[2] === outline[0]?.[2]);
  const height = (ring: Point3[]) => ring[0]?.[2] ?? 0;
  const rings = outlines.filter(isRing).sort((a, b) => height(a) - height(b));
  const [lowest] = rings;
  if (!lowest) return;
  const { middle, half } = extent(rings.flat());
  const floor: Point3 = [middle[0], middle[1], height(lowest)];
  drawFloor(pen, colour('line'), colour('quiet'), floor, Math.max(half[0], half[1]), SQUARE_MM);
  const fill = colour('accent');
  pen.face(fill, 0.1, lowest);
  for (const [index, upper] of rings.slice(1).entries()) {
    const lower = rings[index] ?? [];
    if (lower.length !== upper.length) continue;
    for (let at = 1; at < upper.length; at += 1) {
      const corners = [lower[at - 1], lower[at], upper[at], upper[at - 1]];
      pen.face(fill, 0.05, corners as Point3[]);
    }
  }
  for (const ring of [lowest, rings.at(-1) ?? lowest]) {
    pen.context.globalAlpha = 0.5;
    pen.line(fill, 1, ring);
    pen.context.globalAlpha = 1;
  }
}

function drawMechanism(pen: Pen, driving: Driving, seconds: number): void {
  const { platform, shoulders, elbows, wrists } = driving.mechanism(seconds);
  pen.line(colour('arm'), 5, closed(shoulders));
  for (const [arm, name] of ARM_COLOURS.entries()) {
    const [shoulder, elbow, wrist] = [shoulders[arm], elbows[arm], wrists[arm]];
    if (!shoulder || !elbow || !wrist) continue;
    pen.line(colour(name), 3, [elbow, wrist]);
    pen.line(colour(name), 8, [shoulder, elbow]);
  }
  pen.line(colour('arm'), 4, closed(wrists));
  pen.dot(colour('now'), 5, platform);
}

/** All that is drawn, around the middle of it. */
function ball(driving: Driving): Ball {
  const { elbows } = driving.mechanism(0);
  const { middle, half } = extent([...driving.workspace.flat(), ...elbows, [0, 0, 0]]);
  return { centre: middle, radius: MARGIN * Math.max(...half, 1) };
}
