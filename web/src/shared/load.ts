// What motors are asked for and how tools swing, where a machine file says what the machine carries.
import { Chart } from './chart';
import { element } from './dom';
import type { Answer } from './machine';
import type { Limit } from './limits';
import { around, columns, numbers } from './rows';

/** An axis by its name and colour. */
export interface Axis {
  label: string;
  colour: string;
}

/** What swings: an axis' name if there is one of each, and the numbers of the machine. */
export interface Tool {
  label?: string;
  colour: string;
  blob: string;
}

/** Of a machine with one tool. */
const TOOL: Tool = { colour: 'series-1', blob: 'vibration' };

/** The charts of both, which are there where they have something to show. */
export class LoadCharts {
  readonly #axes: Axis[];
  readonly #tools: Tool[];
  readonly #torque: Chart;
  readonly #vibration: Chart;

  constructor(axes: Axis[], seek: (seconds: number) => void, tools = [TOOL]) {
    this.#axes = axes;
    this.#tools = tools;
    this.#torque = new Chart(element('torque-used', HTMLElement), '%', 180, seek);
    this.#vibration = new Chart(element('vibration', HTMLElement), 'µm', 180, seek);
  }

  show(blobs: Answer<unknown>['blobs']): void {
    const [times = [], planned = [], ...used] = columns(
      numbers(blobs, 'torque used'),
      2 + this.#axes.length,
    );
    element('load-torque', HTMLElement).hidden = times.length === 0;
    const limit = { label: 'planned at most', colour: 'limit', dash: [6, 4] };
    this.#torque.show([limit, ...this.#axes], [times as number[], planned, ...used]);

    const swings = this.#tools.flatMap(({ label, colour, blob }) => {
      const line = (name: string, of: string, how?: object) => ({
        label: label === undefined ? name : `${label}, ${name}`,
        colour,
        ...how,
        rows: columns(numbers(blobs, of), 2),
      });
      return [
        line('without shaping', `${blob} unshaped`, { dash: [2, 3] }),
        line('off its place', blob),
      ];
    });
    const shown = swings.filter(({ rows }) => rows[0]?.length);
    element('load-vibration', HTMLElement).hidden = shown.length === 0;
    const all = new Set(shown.flatMap(({ rows: [at = []] }) => at as number[]));
    const seconds = [...all].sort((a, b) => a - b);
    const values = shown.map(({ rows }) => between(rows, seconds));
    this.#vibration.show(shown, [seconds, ...values]);
  }

  /** The time that the pictures show. */
  at(seconds: number): void {
    this.#torque.at(seconds);
    this.#vibration.at(seconds);
  }
}

/** The torques of axes by their names as limits, where their load is known. */
export function torqueLimits(blobs: Answer<unknown>['blobs'], axes: string[]): Limit[] {
  const [, planned] = numbers(blobs, 'torque used');
  if (planned === undefined) return [];
  return axes.map((axis) => ({
    name: `torque of ${axis}`,
    limit: planned,
    unit: '% of pull-out',
  }));
}

/** Values at other times, evenly between their own; none before the first and after the last. */
function between([at = [], values = []]: (number | null)[][], seconds: number[]) {
  const times = Float64Array.from(at, (it) => it ?? 0);
  return seconds.map((it) => {
    if (it < (times[0] ?? 0) || it > (times.at(-1) ?? 0)) return null;
    const { before, after, part } = around(times, it);
    const [from, to] = [values[before] ?? 0, values[after] ?? 0];
    return from + (to - from) * part;
  });
}
