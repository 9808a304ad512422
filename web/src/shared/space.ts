// Something in space in parallel projection: turned, tilted and zoomed by hand.
import { Picture, takeGestures } from './canvas';
import { onColours } from './dom';
import { intoLink, linkChanged, numbersFromLink } from './store';

/** In mm, z up. */
export type Point3 = [number, number, number];

/** What must be in sight. */
export interface Ball {
  centre: Point3;
  radius: number;
  /** Where it is flatter than it is wide. */
  halfHeight?: number;
}

/** Through all points, and back to the first. */
export function closed(points: Point3[]): Point3[] {
  return [...points, ...points.slice(0, 1)];
}

/** The middle of all points, and half of what they span, along each axis. */
export function extent(points: Point3[]): { middle: Point3; half: Point3 } {
  const range = ([0, 1, 2] as const).map((axis) => {
    const all = points.map((it) => it[axis]);
    return [Math.min(...all), Math.max(...all)] as const;
  });
  const along = (value: (low: number, high: number) => number) =>
    range.map(([low, high]) => value(low, high)) as Point3;
  return { middle: along((low, high) => (low + high) / 2), half: along((l, h) => (h - l) / 2) };
}

/** From where it is seen, in rad: turn 0 is from the front, tilt 0 level, a quarter turn from above. */
export interface View {
  turn: number;
  tilt: number;
}

export const VIEWS = {
  turned: { turn: 0.6, tilt: 0.35 },
  above: { turn: 0, tilt: Math.PI / 2 },
  front: { turn: 0, tilt: 0 },
  side: { turn: Math.PI / 2, tilt: 0 },
} satisfies Record<string, View>;
export type ViewName = keyof typeof VIEWS;

const RAD_PER_PX = 1 / 150;
/** From the smallest to the largest. */
const ZOOMS = [0.3, 20] as const;

function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}

/** Puts points in mm on the canvas, and draws lines and dots. */
export interface Pen {
  context: CanvasRenderingContext2D;
  project(point: Point3): [number, number];
  line(stroke: string, widthPx: number, points: Point3[]): void;
  dot(fill: string, radiusPx: number, point: Point3): void;
  /** A face; opacity from 0 to 1. */
  face(fill: string, opacity: number, points: Point3[]): void;
  text(fill: string, text: string, point: Point3): void;
}

/** Drags what is at a place of the canvas by a stretch in the plane of the view, in mm. */
export type Grab = (
  project: Pen['project'],
  x: number,
  y: number,
) => ((by: Point3) => void) | undefined;

export class Space {
  readonly #picture: Picture;
  readonly #ball: () => Ball | undefined;
  #view: View = VIEWS.turned;
  #zoom = 1;

  constructor(
    canvas: HTMLCanvasElement,
    ball: () => Ball | undefined,
    draw: (pen: Pen) => void,
    grab: Grab = () => undefined,
  ) {
    this.#ball = ball;
    const [turn, tilt, zoom] = numbersFromLink('view', 3) ?? [];
    if (turn !== undefined && tilt !== undefined && zoom !== undefined) {
      this.#view = { turn, tilt: clamp(tilt, -Math.PI / 2, Math.PI / 2) };
      this.#zoom = clamp(zoom, ...ZOOMS);
    }
    intoLink('view', () => {
      const { turn, tilt } = this.#view;
      const isFirst = this.#view === VIEWS.turned && this.#zoom === 1;
      return isFirst ? undefined : [turn, tilt, this.#zoom];
    });
    this.#picture = new Picture(canvas, (context) => {
      if (this.#ball()) draw(this.#pen(context));
    });
    takeGestures(canvas, {
      pan: (dx, dy) => {
        const { turn, tilt } = this.#view;
        this.look({
          turn: turn - dx * RAD_PER_PX,
          tilt: clamp(tilt + dy * RAD_PER_PX, -Math.PI / 2, Math.PI / 2),
        });
      },
      zoom: (factor) => {
        this.#zoom = clamp(this.#zoom * factor, ...ZOOMS);
        linkChanged();
        this.redraw();
      },
      reset: () => {
        this.#zoom = 1;
        this.look(VIEWS.turned);
      },
      grab: (x, y) => {
        const drag = this.#ball() && grab(this.#projection(), x, y);
        return drag && ((dx, dy) => drag(this.#inPlane(dx, dy)));
      },
    });
    onColours(() => this.redraw());
  }

  look(view: View): void {
    this.#view = view;
    linkChanged();
    this.redraw();
  }

  redraw(): void {
    this.#picture.redraw();
  }

  /** Pixels of a mm. */
  #scale(ball: Ball | undefined): number {
    const { width, height } = this.#picture;
    const { radius, halfHeight = radius } = ball ?? { radius: 1 };
    return this.#zoom * Math.min(width / (2 * radius), height / (2 * halfHeight));
  }

  /** Unit vectors to the right and upward on the canvas. */
  get #axes(): [Point3, Point3] {
    const { turn, tilt } = this.#view;
    const [sin, cos] = [Math.sin(turn), Math.cos(turn)];
    const away = Math.sin(tilt);
    return [
      [cos, sin, 0],
      [-sin * away, cos * away, Math.cos(tilt)],
    ];
  }

  /** Where points are on the canvas, as long as nothing is turned or changed. */
  #projection(): Pen['project'] {
    const ball = this.#ball();
    const centre: Point3 = ball?.centre ?? [0, 0, 0];
    const [scale, [right, up]] = [this.#scale(ball), this.#axes];
    const [left, top] = [this.#picture.width / 2, this.#picture.height / 2];
    const along = (axis: Point3, point: Point3) =>
      axis[0] * (point[0] - centre[0]) +
      axis[1] * (point[1] - centre[1]) +
      axis[2] * (point[2] - centre[2]);
    return (point) => [left + scale * along(right, point), top - scale * along(up, point)];
  }

  /** In mm, by pixels to the right and downward. */
  #inPlane(dx: number, dy: number): Point3 {
    const [right, up] = this.#axes;
    const scale = this.#scale(this.#ball());
    const along = (index: 0 | 1 | 2) => (dx * right[index] - dy * up[index]) / scale;
    return [along(0), along(1), along(2)];
  }

  #pen(context: CanvasRenderingContext2D): Pen {
    context.lineCap = 'round';
    context.lineJoin = 'round';
    const project = this.#projection();
    return {
      context,
      project,
      line: (stroke, widthPx, points) => {
        context.strokeStyle = stroke;
        context.lineWidth = widthPx;
        context.beginPath();
        for (const point of points) context.lineTo(...project(point));
        context.stroke();
      },
      face: (fill, opacity, points) => {
        context.fillStyle = fill;
        context.globalAlpha = opacity;
        context.beginPath();
        for (const point of points) context.lineTo(...project(point));
        context.fill();
        context.globalAlpha = 1;
      },
      text: (fill, text, point) => {
        context.fillStyle = fill;
        context.font = '13px system-ui, sans-serif';
        context.textAlign = 'center';
        context.textBaseline = 'middle';
        context.fillText(text, ...project(point));
      },
      dot: (fill, radiusPx, point) => {
        context.fillStyle = fill;
        context.beginPath();
        context.arc(...project(point), radiusPx, 0, 2 * Math.PI);
        context.fill();
      },
    };
  }
}

/** A floor of squares around a middle, with the axes at its corner. */
export function drawFloor(
  pen: Pen,
  stroke: string,
  ink: string,
  [x, y, z]: Point3,
  half: number,
  square: number,
): void {
  const round = (value: number) => Math.round(value / square) * square;
  const count = Math.ceil(half / square);
  const [left, near] = [round(x) - count * square, round(y) - count * square];
  const size = 2 * count * square;
  for (let line = 0; line <= 2 * count; line += 1) {
    const at = line * square;
    pen.line(stroke, 1, [
      [left + at, near, z],
      [left + at, near + size, z],
    ]);
    pen.line(stroke, 1, [
      [left, near + at, z],
      [left + size, near + at, z],
    ]);
  }
  const corner: Point3 = [left, near, z];
  for (const [name, axis] of [
    ['x', 0],
    ['y', 1],
    ['z', 2],
  ] as const) {
    const along = (length: number) =>
      corner.map((it, index) => it + (index === axis ? length : 0)) as Point3;
    pen.line(ink, 2, [corner, along(1.5 * square)]);
    pen.text(ink, name, along(1.9 * square));
  }
}

/** Connects the buttons of a row, each with the name of a view, to a space. */
export function viewButtons(row: HTMLElement, space: Space): void {
  for (const button of row.querySelectorAll<HTMLButtonElement>('button[data-view]')) {
    button.addEventListener('click', () => space.look(VIEWS[button.dataset.view as ViewName]));
  }
}
