// What the stage did with a program, ready to be asked for any time.
import type { Answer } from '../shared/machine';
import { Limits } from '../shared/limits';
import { torqueLimits } from '../shared/load';
import { around, columns, countUntil, countWhile, numbers } from '../shared/rows';

/** The JSON of the operation; the report is that of the command line. */
export interface Result {
  summary: string;
  /** X and Y, the lower one first. */
  switchesMm: [[number, number], [number, number]];
  /** Of X and Y what the speed may be, and the acceleration, in mm/s and mm/s². */
  axesMay: [[number, number], [number, number]];
  report: {
    notes: string[];
    duration_s: number;
    max_deviation_mm: number;
    lost_steps: number;
    corrected_steps: number;
    open_loop: { max_deviation_mm: number; lost_steps: number };
  };
}

type Column = (number | null)[];

const AXES = ['X', 'Y'];

/** Seconds, x, y, and the motion it belongs to. */
const POINT = 4;
/** Line, whether it is a rapid one, feed in mm/s. */
const LEG = 3;

/** A programmed motion. */
export interface Leg {
  line: number;
  isRapid: boolean;
  feedMmS: number;
}

/** Where one stage was. */
export class Track {
  readonly times: Float64Array;
  readonly #rows: Float64Array;

  constructor(rows: Float64Array) {
    this.#rows = rows;
    this.times = new Float64Array(rows.length / POINT).map((_, point) => rows[point * POINT] ?? 0);
  }

  point(index: number): [number, number] {
    return [this.#rows[index * POINT + 1] ?? 0, this.#rows[index * POINT + 2] ?? 0];
  }

  leg(index: number): number {
    return this.#rows[index * POINT + 3] ?? 0;
  }

  /** How many points have been passed at a time. */
  passed(seconds: number): number {
    return countUntil(this.times, seconds);
  }

  /** Evenly between two points of the picture. */
  at(seconds: number): [number, number] {
    const { before, after, part } = around(this.times, seconds);
    const [[x0, y0], [x1, y1]] = [this.point(before), this.point(after)];
    return [x0 + (x1 - x0) * part, y0 + (y1 - y0) * part];
  }
}

/** The lines and arcs of a program that is not run yet. */
export class Preview {
  readonly switchesMm: Result['switchesMm'];
  readonly programmed: Float64Array;

  constructor({ value, blobs }: Answer<Pick<Result, 'switchesMm'>>) {
    this.switchesMm = value.switchesMm;
    this.programmed = numbers(blobs, 'programmed');
  }
}

export class Run {
  readonly result: Result;
  readonly blobs: Answer<Result>['blobs'];
  /** What limits timed steps. */
  readonly limits: Limits;
  /** The largest feed of a motion that is no rapid one, in mm/s. */
  readonly maxFeed: number;
  readonly #legs: Float64Array;
  /** x and y of the programmed lines and arcs, in mm; no number between two. */
  readonly programmed: Float64Array;
  readonly closed: Track;
  readonly open: Track;
  /** Seconds, and mean mm/s around them. */
  readonly speeds: Column[];
  /** Seconds, and mm/s² of the axis that has the larger one. */
  readonly accelerations: Column[];
  /** Seconds, and mm from the programmed curve: in the closed loop, and without. */
  readonly deviations: [Column, Column, Column];
  /** Seconds, and steps so far. */
  readonly corrections: [Column, Column];

  constructor({ value, blobs }: Answer<Result>) {
    const pairs = (name: string) => columns(numbers(blobs, name), 2);
    this.result = value;
    this.blobs = blobs;
    this.#legs = numbers(blobs, 'legs');
    this.maxFeed = largestFeed(this.#legs);
    const axes = (name: string, of: 0 | 1, unit: string) =>
      AXES.map((axis, index) => ({
        name: `${name} of ${axis}`,
        limit: value.axesMay[index]?.[of] ?? 0,
        unit,
      }));
    this.limits = new Limits(blobs, [
      ...axes('speed', 0, 'mm/s'),
      ...axes('acceleration', 1, 'mm/s²'),
      ...torqueLimits(blobs, AXES),
    ]);
    this.programmed = numbers(blobs, 'programmed');
    this.closed = new Track(numbers(blobs, 'closed'));
    this.open = new Track(numbers(blobs, 'open'));
    this.speeds = pairs('speeds');
    this.accelerations = pairs('accelerations');
    const [times = [], closed = []] = pairs('closed deviations');
    const [, open = []] = pairs('open deviations');
    this.deviations = [times, closed, open];
    const [when = [], steps = []] = pairs('corrections');
    const { duration_s, corrected_steps } = value.report;
    this.corrections = [
      [0, ...when, duration_s],
      [0, ...steps, corrected_steps],
    ];
  }

  get isLossy(): boolean {
    return this.result.report.open_loop.lost_steps > 0;
  }

  leg(number: number): Leg | undefined {
    if (number < 0 || number * LEG >= this.#legs.length) return undefined;
    const [line = 0, isRapid = 0, feedMmS = 0] = this.#legs.subarray(number * LEG);
    return { line, isRapid: isRapid > 0, feedMmS };
  }

  /** When a motion begins and ends, as far as the points of the picture tell. */
  timesOf(leg: number): [number, number] {
    const { closed } = this;
    const from = countWhile(closed.times.length, (point) => closed.leg(point) < leg);
    const to = countWhile(closed.times.length, (point) => closed.leg(point) <= leg);
    const at = (point: number) =>
      closed.times[Math.min(Math.max(point, 0), closed.times.length - 1)];
    return [at(from) ?? 0, at(to - 1) ?? 0];
  }

  /** The mean speed around a time. */
  speedAt(seconds: number): number {
    const [times = [], speeds = []] = this.speeds;
    const window = (times[1] ?? 1) - (times[0] ?? 0);
    return speeds[Math.min(Math.floor(seconds / window), speeds.length - 1)] ?? 0;
  }

  /** The motion that is made at a time. */
  legAt(seconds: number): Leg | undefined {
    const point = Math.min(this.closed.passed(seconds), this.closed.times.length - 1);
    return this.leg(this.closed.leg(point));
  }
}

function largestFeed(legs: Float64Array): number {
  let most = 0;
  for (let leg = 0; leg < legs.length; leg += LEG) {
    if (legs[leg + 1] === 0) most = Math.max(most, legs[leg + 2] ?? 0);
  }
  return most;
}
