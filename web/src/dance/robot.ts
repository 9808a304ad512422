// The robot on the floor, as its motors stand at a time, drawn in parallel projection.
import { Picture, takeGestures } from '../shared/canvas';
import { colour, onColours } from '../shared/dom';
import { intoLink, linkChanged, numbersFromLink } from '../shared/store';
import { type Dance, MOTOR, type MotorName } from './dance';
import { TRACK_MM, type Stand, WHEEL_MM, roll, standAt } from './floor';

type Point = [number, number, number];

/** Of the drawn robot, in mm; the score says nothing of them. */
const HIP_MM = 130;
const TORSO_MM = 210;
const SHOULDER_MM = 75;
const UPPER_ARM_MM = 95;
const FOREARM_MM = 85;
const HEAD_MM = 45;

/** How far around the robot the floor is drawn, and the squares of it. */
const FLOOR_MM = 800;
const SQUARE_MM = 100;

/** From where it is looked at first, in rad; 0 is from behind. */
const VIEW_RAD = 2.6;

/** Puts points in mm on the canvas, and draws lines of them. */
interface Pen {
  context: CanvasRenderingContext2D;
  scale: number;
  project(point: Point): [number, number];
  line(colour: string, widthMm: number, points: Point[]): void;
}

export class Robot {
  readonly #picture: Picture;
  #dance: Dance | undefined;
  #stands: Stand[] = [];
  #seconds = 0;
  #turn = VIEW_RAD;
  #zoom = 1;

  constructor(canvas: HTMLCanvasElement) {
    this.#picture = new Picture(canvas, (context, width, height) =>
      this.#draw(context, width, height),
    );
    const [turn, zoom] = numbersFromLink('view', 2) ?? [];
    if (turn !== undefined && zoom !== undefined) [this.#turn, this.#zoom] = [turn, held(zoom)];
    intoLink('view', () => {
      const isFirst = this.#turn === VIEW_RAD && this.#zoom === 1;
      return isFirst ? undefined : [this.#turn, this.#zoom];
    });
    takeGestures(canvas, {
      pan: (dx) => this.#look(this.#turn + dx / 150, this.#zoom),
      zoom: (factor) => this.#look(this.#turn, held(this.#zoom * factor)),
      reset: () => this.#look(VIEW_RAD, 1),
    });
    onColours(() => this.#picture.redraw());
  }

  show(dance: Dance): void {
    this.#dance = dance;
    this.#stands = roll(dance);
    this.#picture.redraw();
  }

  at(seconds: number): void {
    this.#seconds = seconds;
    this.#picture.redraw();
  }

  #look(turn: number, zoom: number): void {
    this.#turn = turn;
    this.#zoom = zoom;
    linkChanged();
    this.#picture.redraw();
  }

  #draw(context: CanvasRenderingContext2D, width: number, height: number): void {
    const dance = this.#dance;
    if (!dance) return;
    const frame = this.#seconds / dance.frameS;
    const here = standAt(this.#stands, frame);
    const pen = this.#pen(context, here, width, height);
    drawFloor(pen, here);
    const way = this.#stands.slice(0, Math.floor(frame) + 1);
    pen.line(
      colour('now'),
      3,
      [...way, here].map((it): Point => [it.x, it.y, 0]),
    );
    drawBody(pen, here, (motor) => (dance.angle(MOTOR[motor], frame) * Math.PI) / 180);
  }

  /** The robot stays in the middle; the floor is seen from above by 25 degrees. */
  #pen(context: CanvasRenderingContext2D, here: Stand, width: number, height: number): Pen {
    const scale = (this.#zoom * Math.min(width, height)) / 650;
    const [sin, cos] = [Math.sin(this.#turn), Math.cos(this.#turn)];
    const project = ([x, y, z]: Point): [number, number] => {
      const [dx, dy] = [x - here.x, y - here.y];
      const [right, away] = [dx * sin - dy * cos, dx * cos + dy * sin];
      return [width / 2 + scale * right, height * 0.75 - scale * (0.42 * away + 0.91 * z)];
    };
    const line = (stroke: string, widthMm: number, points: Point[]) => {
      context.strokeStyle = stroke;
      context.lineWidth = Math.max(widthMm * scale, 1);
      context.lineCap = 'round';
      context.lineJoin = 'round';
      context.beginPath();
      for (const point of points) context.lineTo(...project(point));
      context.stroke();
    };
    return { context, scale, project, line };
  }
}

/** A zoom that can be drawn. */
function held(zoom: number): number {
  return Math.min(Math.max(zoom, 0.2), 5);
}

function drawFloor({ line }: Pen, here: Stand): void {
  const [x, y] = [here.x, here.y].map((it) => Math.round(it / SQUARE_MM) * SQUARE_MM) as [
    number,
    number,
  ];
  const stroke = colour('line');
  for (let by = -FLOOR_MM; by <= FLOOR_MM; by += SQUARE_MM) {
    line(stroke, 0, [
      [x + by, y - FLOOR_MM, 0],
      [x + by, y + FLOOR_MM, 0],
    ]);
    line(stroke, 0, [
      [x - FLOOR_MM, y + by, 0],
      [x + FLOOR_MM, y + by, 0],
    ]);
  }
}

function drawBody(pen: Pen, here: Stand, radians: (motor: MotorName) => number): void {
  const { context, scale, project, line } = pen;
  const [sin, cos] = [Math.sin(here.heading), Math.cos(here.heading)];
  /** From the robot's forwards, left and up. */
  const place = (forward: number, left: number, up: number): Point => [
    here.x + forward * cos - left * sin,
    here.y + forward * sin + left * cos,
    up,
  ];
  const dot = (colour: string, mm: number, point: Point) => {
    context.fillStyle = colour;
    context.beginPath();
    context.arc(...project(point), Math.max(mm * scale, 1.5), 0, 2 * Math.PI);
    context.fill();
  };
  // Waist and head bow forwards at negative angles; arms hang at 0 and rise forwards.
  const bow = -radians('waist');
  const [forward, up] = [TORSO_MM * Math.sin(bow), HIP_MM + TORSO_MM * Math.cos(bow)];
  const wheel = (side: 1 | -1) => {
    const spin = radians(side > 0 ? 'leftWheel' : 'rightWheel');
    const radius = WHEEL_MM / 2;
    const rim = (angle: number) =>
      place(radius * Math.cos(angle), (side * TRACK_MM) / 2, radius * (1 + Math.sin(angle)));
    const parts = Array.from({ length: 25 }, (_, part) => rim((part * Math.PI) / 12));
    line(colour('series-2'), 6, parts);
    line(colour('series-2'), 4, [rim(-spin), rim(Math.PI - spin)]);
  };
  const arm = (side: 1 | -1) => {
    const upper = radians(side > 0 ? 'leftArm' : 'rightArm');
    const fore = upper + radians(side > 0 ? 'leftElbow' : 'rightElbow');
    const left = side * SHOULDER_MM;
    const [x, z] = [forward + UPPER_ARM_MM * Math.sin(upper), up - UPPER_ARM_MM * Math.cos(upper)];
    line(colour(side > 0 ? 'series-1' : 'series-4'), 14, [
      place(forward, 0, up),
      place(forward, left, up),
      place(x, left, z),
      place(x + FOREARM_MM * Math.sin(fore), left, z - FOREARM_MM * Math.cos(fore)),
    ]);
  };
  const axle = WHEEL_MM / 2;
  line(colour('arm'), 10, [place(0, TRACK_MM / 2, axle), place(0, -TRACK_MM / 2, axle)]);
  wheel(1);
  wheel(-1);
  line(colour('arm'), 30, [place(0, 0, axle), place(0, 0, HIP_MM), place(forward, 0, up)]);
  arm(1);
  arm(-1);
  const nod = bow - radians('head');
  const face = (ahead: number, left: number, above: number) =>
    place(
      forward + above * Math.sin(nod) + ahead * Math.cos(nod),
      left,
      up + above * Math.cos(nod) - ahead * Math.sin(nod),
    );
  dot(colour('arm'), HEAD_MM * 0.8, face(0, 0, HEAD_MM + 12));
  const away = project(face(40, 0, 0))[1] < project(face(0, 0, 0))[1];
  // From behind, the eyes are not seen.
  if (!away) for (const left of [-14, 14]) dot(colour('now'), 6, face(28, left, HEAD_MM + 18));
}
