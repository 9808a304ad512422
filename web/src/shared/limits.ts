// What limits a timed run at any time, and where in the input that is.
import { Chart } from './chart';
import { element } from './dom';
import type { Answer } from './machine';
import { countUntil, numbers } from './rows';

/** What an axis or the tool may do. */
export interface Limit {
  name: string;
  limit: number;
  unit: string;
}

/** A limit, and how near to it the run is: 1 is at it. */
export interface Share extends Limit {
  share: number;
}

/** What limits at a time, the nearest limit first. */
export interface Look {
  seconds: number;
  /** From which row of the table to the next, counted from 1. */
  row: number;
  /** The line, motion or stroke of the input. */
  source: number;
  shares: Share[];
}

/** Row, source, feed and acceleration that the tool may have come before the shares. */
const HEAD = 4;
/** Of a chart; more are not told apart. */
const MAX_CHARTED = 2000;
/** What is so near to a limit is at it: looks are between the ends of rows. */
const AT_LIMIT = 0.985;

export class Limits {
  readonly #times: Float64Array;
  readonly #shares: Float32Array;
  readonly #width: number;
  readonly #axes: Limit[];

  /** `axes` are in the order of the machine's shares: all speeds, all accelerations, all torques. */
  constructor(blobs: Answer<unknown>['blobs'], axes: Limit[]) {
    this.#times = numbers(blobs, 'looks');
    this.#shares = new Float32Array(blobs.shares ?? new ArrayBuffer(0));
    this.#width = this.#times.length > 0 ? this.#shares.length / this.#times.length : HEAD;
    this.#axes = axes;
  }

  /** Whether the run is a timed one. */
  get areKnown(): boolean {
    return this.#times.length > 0;
  }

  /** Nothing between timed rows: a rapid move, or rest. */
  at(seconds: number): Look | undefined {
    const after = countUntil(this.#times, seconds);
    const time = (look: number) => this.#times[look] ?? Infinity;
    const isBefore = after > 0 && seconds - time(after - 1) <= time(after) - seconds;
    const look = isBefore ? after - 1 : after;
    if (look >= this.#times.length) return undefined;
    const [row = 0, source = 0, feed = 0, acceleration = 0, ...shares] = this.#values(look);
    // Within a row no time is farther from a look than half of what two looks are apart.
    const beside = [look - 1, look + 1].filter((it) => this.#values(it)[0] === row);
    const apart = beside.map((it) => Math.abs(time(it) - time(look)));
    if (Math.abs(seconds - time(look)) > (apart[0] ?? Infinity)) return undefined;
    const limits = [
      ...this.#axes,
      { name: 'feed', limit: feed, unit: 'mm/s' },
      { name: 'acceleration along the path', limit: acceleration, unit: 'mm/s²' },
    ];
    const known = shares.map((share, index) => ({ share, ...limits[index] }));
    return {
      seconds,
      row,
      source,
      shares: known
        .filter((it): it is Share => it.name !== undefined && Number.isFinite(it.share))
        .sort((a, b) => b.share - a.share),
    };
  }

  /** Seconds, and the percentage of the nearest limit. */
  get nearest(): [number[], (number | null)[]] {
    const [all, width] = [this.#shares, this.#width];
    const step = Math.max(Math.ceil(this.#times.length / MAX_CHARTED), 1);
    const [times, most]: [number[], (number | null)[]] = [[], []];
    for (let look = 0; look < this.#times.length; look += step) {
      const end = Math.min(look + step, this.#times.length);
      let largest = 0;
      for (let at = look * width; at < end * width; at += 1) {
        const share = all[at] ?? 0;
        if (at % width >= HEAD && share > largest) largest = share;
      }
      // Between timed rows there is no limit.
      const rows = (all[look * width] ?? 0) - (all[(look - 1) * width] ?? Infinity);
      if (rows > 1) {
        times.push(((this.#times[look - 1] ?? 0) + (this.#times[look] ?? 0)) / 2);
        most.push(null);
      }
      times.push(this.#times[look] ?? 0);
      most.push(100 * largest);
    }
    return [times, most];
  }

  #values(look: number): Float32Array {
    return this.#shares.subarray(Math.max(look, 0) * this.#width, (look + 1) * this.#width);
  }
}

/** What limits, in a sentence; `place` names the source in the input. */
export function sentence(
  { seconds, row, source, shares }: Look,
  place: (source: number) => string,
) {
  const told = ({ name, share, limit, unit }: Share) =>
    `${name} ${(100 * share).toFixed(0)} % of ${Number(limit.toPrecision(4))} ${unit}`;
  const [nearest, ...others] = shares;
  const rest = others.slice(0, 2).map(told).join(', ');
  const begin = nearest && nearest.share >= AT_LIMIT ? 'limited by' : 'at no limit; nearest';
  return `${seconds.toFixed(3)} s: ${begin} ${nearest ? told(nearest) : ''}; then ${rest}. Row ${row}, ${place(source)}`;
}

/** Tells under the charts what limits at the time on show, or at the pointer on a chart. */
export class LimitTeller {
  readonly #line = element('limit', HTMLElement);
  readonly #chart: Chart;
  readonly #place: (source: number) => string;
  #limits: Limits | undefined;
  #shown = 0;
  #hovered: number | undefined;

  constructor(seek: (seconds: number) => void, place: (source: number) => string) {
    this.#place = place;
    this.#chart = new Chart(element('limits', HTMLElement), '%', 130, seek);
    this.watch([this.#chart]);
  }

  /** Charts of the same times. */
  watch(charts: Chart[]): void {
    for (const chart of charts) {
      chart.onHover((seconds) => {
        this.#hovered = seconds;
        this.#tell();
      });
    }
  }

  show(limits: Limits): void {
    this.#limits = limits;
    element('limited', HTMLElement).hidden = !limits.areKnown;
    const [times, nearest] = limits.nearest;
    const full = { label: 'limit', colour: 'limit', dash: [6, 4] };
    const line = { label: 'nearest limit', colour: 'series-1' };
    this.#chart.show([full, line], [times, times.map(() => 100), nearest]);
    this.#tell();
  }

  at(seconds: number): void {
    this.#shown = seconds;
    this.#chart.at(seconds);
    this.#tell();
  }

  #tell(): void {
    const seconds = this.#hovered ?? this.#shown;
    const look = this.#limits?.at(seconds);
    this.#line.textContent = look
      ? sentence(look, this.#place)
      : `${seconds.toFixed(3)} s: no timed row`;
  }
}
