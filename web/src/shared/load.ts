// What motors are asked for and how a tool swings, where a machine file says what the machine carries.
import { Chart } from './chart';
import { element } from './dom';
import type { Answer } from './machine';
import { columns, numbers } from './rows';

/** An axis by its name and colour. */
export interface Axis {
  label: string;
  colour: string;
}

/** The charts of both, which are there where they have something to show. */
export class LoadCharts {
  readonly #axes: Axis[];
  readonly #torque: Chart;
  readonly #vibration: Chart;

  constructor(axes: Axis[], seek: (seconds: number) => void) {
    this.#axes = axes;
    this.#torque = new Chart(element('torque-used', HTMLElement), '%', 180, seek);
    this.#vibration = new Chart(element('vibration', HTMLElement), 'µm', 180, seek);
  }

  show(blobs: Answer<unknown>['blobs']): void {
    const [times = [], planned = [], ...used] = columns(numbers(blobs, 'torque used'), 5);
    const [swung = [], off = []] = columns(numbers(blobs, 'vibration'), 2);
    element('load-torque', HTMLElement).hidden = times.length === 0;
    element('load-vibration', HTMLElement).hidden = swung.length === 0;
    const limit = { label: 'planned at most', colour: 'limit', dash: [6, 4] };
    this.#torque.show([limit, ...this.#axes], [times as number[], planned, ...used]);
    const swing = { label: 'off its place', colour: 'series-1' };
    this.#vibration.show([swing], [swung as number[], off]);
  }

  /** The time that the pictures show. */
  at(seconds: number): void {
    this.#torque.at(seconds);
    this.#vibration.at(seconds);
  }
}
