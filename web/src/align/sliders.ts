// A pose as six sliders.
import { create } from '../shared/dom';

const NAMES = ['x', 'y', 'z', 'alpha', 'beta', 'gamma'] as const;
/** How far a slider goes to both sides, and its steps: in mm, in degrees. */
const SPANS = { mm: { span: 150, step: 0.5 }, deg: { span: 3, step: 0.02 } };

/** Six sliders for a pose, each with a field for the very number. */
export class PoseSliders {
  readonly #fields: HTMLInputElement[] = [];
  readonly #ranges: HTMLInputElement[] = [];

  constructor(target: HTMLElement, changed: () => void) {
    for (const [index, name] of NAMES.entries()) {
      const unit = index < 3 ? 'mm' : 'deg';
      const label = `${name} in ${unit}`;
      const field = create('input', { type: 'number', step: 'any', ariaLabel: label });
      const range = create('input', { type: 'range', ariaLabel: `${label}, slider` });
      range.step = String(SPANS[unit].step);
      field.addEventListener('input', () => {
        range.value = field.value;
        changed();
      });
      range.addEventListener('input', () => {
        field.value = range.value;
        changed();
      });
      this.#fields.push(field);
      this.#ranges.push(range);
      target.append(
        create(
          'div',
          { className: 'slider' },
          create('span', {}, `${name}, ${unit === 'mm' ? unit : '°'}`),
          range,
          field,
        ),
      );
    }
  }

  /** The numbers as they are typed; no number where there is none. */
  get pose(): number[] {
    return this.#fields.map((it) => it.valueAsNumber);
  }

  /** Shows a pose, with sliders around where the body is. */
  show(pose: readonly number[], from: readonly number[]): void {
    for (const [index, range] of this.#ranges.entries()) {
      const { span } = SPANS[index < 3 ? 'mm' : 'deg'];
      const [middle, value] = [from[index] ?? 0, pose[index] ?? 0];
      range.min = String(middle - span);
      range.max = String(middle + span);
      range.value = String(value);
      const field = this.#fields[index];
      if (field && field.valueAsNumber !== value) field.value = String(value);
    }
  }
}
