// Fields that the address keeps, so that what is set can be sent.
import { fromAddress } from './store';

type Field = HTMLInputElement | HTMLSelectElement;

export class AddressFields {
  readonly #fields: [string, Field][];

  /** By their names in the address; what is not said there is as the page has it at first. */
  constructor(fields: Record<string, Field>, changed: () => void) {
    this.#fields = Object.entries(fields);
    for (const [name, field] of this.#fields) {
      field.value = fromAddress(name) ?? usual(field);
      if (field instanceof HTMLSelectElement && field.selectedIndex < 0) field.value = usual(field);
      field.addEventListener('input', changed);
    }
  }

  /** For the address: null where the field is as at first. */
  get values(): Record<string, string | null> {
    const value = (field: Field) => (field.value === usual(field) ? null : field.value);
    return Object.fromEntries(this.#fields.map(([name, field]) => [name, value(field)]));
  }
}

function usual(field: Field): string {
  if (field instanceof HTMLInputElement) return field.defaultValue;
  const options = [...field.options];
  return (options.find((it) => it.defaultSelected) ?? options[0])?.value ?? '';
}
