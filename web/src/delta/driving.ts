// What the robot did with its lines, ready to be asked for any time.
import { Limits } from '../shared/limits';
import { torqueLimits } from '../shared/load';
import type { Answer } from '../shared/machine';
import { around, countUntil, numbers } from '../shared/rows';
import type { Point3 } from '../shared/space';

export const ARMS = [0, 1, 2] as const;
export type Arm = (typeof ARMS)[number];

/** The JSON of the operation. */
export interface Result {
  answers: string[];
  /** Which lines were refused, in a sentence. */
  refused: string | null;
  refusedLines: number[];
  notes: string[];
  durationS: number;
  maxPathErrorMm: number;
  arms: [Geometry, Geometry, Geometry];
  maxRateDegS: number;
  maxAccelerationDegS2: number;
}

/** Of an arm. */
interface Geometry {
  azimuthRad: number;
  baseMm: number;
  platformMm: number;
}

/** Seconds; angles, rates, accelerations, torques of the arms; platform; elbows. */
const ROW = 25;
export type Quantity = 'angles' | 'rates' | 'accelerations' | 'torques';
const COLUMNS: Record<Quantity, number> = { angles: 1, rates: 4, accelerations: 7, torques: 10 };
const PLATFORM = 13;
const ELBOWS = 16;

/** Both ends, feed, and seconds of the end. */
const LINE = 8;

/** The mechanism at a time, in mm. */
export interface Mechanism {
  platform: Point3;
  shoulders: Point3[];
  elbows: Point3[];
  wrists: Point3[];
}

export class Driving {
  readonly result: Result;
  readonly blobs: Answer<Result>['blobs'];
  /** What limits lines with rounded corners. */
  readonly limits: Limits;
  readonly times: Float64Array;
  readonly #rows: Float64Array;
  /** Ends, feed in mm/s, and seconds of the end of each line. */
  readonly lines: { from: Point3; to: Point3; feed: number; endS: number }[];
  /** Seconds, and the mean speed of the platform around them. */
  readonly speeds: Float64Array;
  /** Outlines; no number between two. */
  readonly workspace: Point3[][];

  constructor({ value, blobs }: Answer<Result>) {
    this.result = value;
    this.blobs = blobs;
    const arms = (name: string, limit: number, unit: string) =>
      ARMS.map((arm) => ({ name: `${name} of arm ${arm + 1}`, limit, unit }));
    this.limits = new Limits(blobs, [
      ...arms('rate', value.maxRateDegS, '°/s'),
      ...arms('acceleration', value.maxAccelerationDegS2, '°/s²'),
      ...torqueLimits(
        blobs,
        ARMS.map((arm) => `arm ${arm + 1}`),
      ),
    ]);
    this.#rows = numbers(blobs, 'arms');
    this.times = this.#rows.filter((_, index) => index % ROW === 0);
    const lines = numbers(blobs, 'lines');
    this.lines = Array.from({ length: lines.length / LINE }, (_, index) => {
      const at = index * LINE;
      const feed = lines[at + 6] ?? 0;
      return { from: point(lines, at), to: point(lines, at + 3), feed, endS: lines[at + 7] ?? 0 };
    });
    this.speeds = numbers(blobs, 'speeds');
    this.workspace = outlines(numbers(blobs, 'workspace'));
  }

  /** A quantity of an arm over the times. */
  column(quantity: Quantity, arm: Arm): number[] {
    const first = COLUMNS[quantity] + arm;
    return Array.from(this.times, (_, row) => this.#rows[row * ROW + first] ?? 0);
  }

  /** Where the platform has been until a time. */
  path(seconds: number): Point3[] {
    const passed = countUntil(this.times, seconds);
    return Array.from({ length: passed }, (_, row) => point(this.#rows, row * ROW + PLATFORM));
  }

  /** Evenly between two rows. */
  mechanism(seconds: number): Mechanism {
    const { before, after, part } = around(this.times, seconds);
    const between = (column: number): Point3 => {
      const [a, b] = [before, after].map((row) => point(this.#rows, row * ROW + column));
      return [0, 1, 2].map((axis) => mix(a?.[axis] ?? 0, b?.[axis] ?? 0, part)) as Point3;
    };
    const platform = between(PLATFORM);
    const arms = this.result.arms;
    return {
      platform,
      shoulders: arms.map((arm) => outward(arm.azimuthRad, arm.baseMm, [0, 0, 0])),
      elbows: ARMS.map((arm) => between(ELBOWS + 3 * arm)),
      wrists: arms.map((arm) => outward(arm.azimuthRad, arm.platformMm, platform)),
    };
  }
}

function point(rows: Float64Array, at: number): Point3 {
  return [rows[at] ?? 0, rows[at + 1] ?? 0, rows[at + 2] ?? 0];
}

function mix(a: number, b: number, part: number): number {
  return a + (b - a) * part;
}

function outward(azimuth: number, mm: number, [x, y, z]: Point3): Point3 {
  return [x + mm * Math.cos(azimuth), y + mm * Math.sin(azimuth), z];
}

function outlines(points: Float64Array): Point3[][] {
  const found: Point3[][] = [[]];
  for (let at = 0; at < points.length; at += 3) {
    if (Number.isNaN(points[at])) found.push([]);
    else found.at(-1)?.push(point(points, at));
  }
  return found.filter((it) => it.length > 0);
}
