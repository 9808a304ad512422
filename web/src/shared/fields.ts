// Fields that the address keeps, so that what is set can be sent.
import { fromAddress } from './store';

type Field = HTMLInputElement | HTMLSelectElement;

export class AddressFields {
  readonly #fields: [string, Field][];

  /** By their names in the address; what is not said there is as the page has it at first. */
  constructor(fields: Record<string, Field>, changed: () => void) {
    this.#fields = Object.entries(fields);
    for (const [name, field] of this.#fields) {
      field.value = asked(name, field) ?? usual(field);
      if (!isTaken(field, fromAddress(name))) field.value = usual(field);
      field.addEventListener('input', changed);
    }
  }

  /** What is wrong with the first number that is none, or out of its range. */
  get problem(): string | undefined {
    for (const [name, field] of this.#fields) {
      if (!(field instanceof HTMLInputElement) || field.type !== 'number') continue;
      const what = problem(field);
      const label = field.labels?.[0]?.firstChild?.textContent?.trim() ?? name;
      if (what !== undefined) return `${label}: ${what}`;
    }
    return undefined;
  }

  /** For the address: null where the field is as at first. */
  get values(): Record<string, string | null> {
    const value = (field: Field) => (field.value === usual(field) ? null : field.value);
    return Object.fromEntries(this.#fields.map(([name, field]) => [name, value(field)]));
  }
}

/** As the address has it; no number is none, and then it is asked for. */
function asked(name: string, { type }: Field): string | null {
  const value = fromAddress(name);
  return type === 'number' && value !== null && !Number.isFinite(Number(value)) ? '' : value;
}

/** Choices and sliders take what they have alone, and put something of their own in place of the rest. */
function isTaken(field: Field, asked: string | null): boolean {
  if (field instanceof HTMLSelectElement) return field.selectedIndex >= 0;
  return field.type !== 'range' || asked === null || Number(field.value) === Number(asked);
}

function problem({ valueAsNumber: value, min, max, step }: HTMLInputElement): string | undefined {
  if (Number.isNaN(value)) return 'a number is needed';
  if (min !== '' && value < Number(min)) return `${value} is below ${min}`;
  if (max !== '' && value > Number(max)) return `${value} is above ${max}`;
  if (step === '1' && !Number.isInteger(value)) return `${value} is no whole number`;
  return undefined;
}

function usual(field: Field): string {
  if (field instanceof HTMLInputElement) return field.defaultValue;
  const options = [...field.options];
  return (options.find((it) => it.defaultSelected) ?? options[0])?.value ?? '';
}
