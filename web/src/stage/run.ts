// What the stage did with a program, ready to be asked for any time.
import type { Answer } from '../shared/machine';
import { around, columns, countUntil, numbers } from '../shared/rows';

/** The JSON of the operation; the report is that of the command line. */
export interface Result {
  summary: string;
  legs: { line: number; isRapid: boolean; feedMmS: number }[];
  /** X and Y, the lower one first. */
  switchesMm: [[number, number], [number, number]];
  accelerationMmS2: number;
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

/** Where one stage was. */
export class Track {
  readonly times: Float64Array;
  readonly #points: [number, number][] = [];
  /** Of each point, the motion it belongs to. */
  readonly #legs: number[] = [];

  constructor(rows: Float64Array) {
    const times: number[] = [];
    let leg = 0;
    for (let index = 0; index < rows.length; index += 3) {
      const [time, x, y] = rows.subarray(index, index + 3);
      if (time === undefined || x === undefined || y === undefined) break;
      if (Number.isNaN(time)) {
        leg += 1;
        continue;
      }
      times.push(time);
      this.#points.push([x, y]);
      this.#legs.push(leg);
    }
    this.times = new Float64Array(times);
  }

  point(index: number): [number, number] {
    return this.#points[index] ?? [0, 0];
  }

  leg(index: number): number {
    return this.#legs[index] ?? 0;
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

export class Run {
  readonly result: Result;
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

  /** The largest feed of a motion that is no rapid one, in mm/s. */
  get maxFeed(): number {
    const feeds = this.result.legs.filter((leg) => !leg.isRapid).map((leg) => leg.feedMmS);
    return Math.max(...feeds, 0);
  }

  /** The mean speed around a time. */
  speedAt(seconds: number): number {
    const [times = [], speeds = []] = this.speeds;
    const window = (times[1] ?? 1) - (times[0] ?? 0);
    return speeds[Math.min(Math.floor(seconds / window), speeds.length - 1)] ?? 0;
  }

  /** The motion that is made at a time. */
  legAt(seconds: number): Result['legs'][number] | undefined {
    const point = Math.min(this.closed.passed(seconds), this.closed.times.length - 1);
    return this.result.legs[this.closed.leg(point)];
  }
}
