// One simulated station: what it does, what it is told to send, its settings and faults.
import { tell } from './events';

/** What the machine tells of a station. */
export interface StationState {
  activity: string;
  deadlineS: number | null;
  waiting: number;
}

export interface StationEvent {
  atS: number;
  side: 'A' | 'B';
  text: string;
  isGood: boolean;
}

export interface Telegram {
  text: string;
  is_hex: boolean;
}

const EVENTS = 6;

export class StationPanel {
  readonly side: 'A' | 'B';
  readonly #root: HTMLElement;

  constructor(
    root: HTMLElement,
    template: HTMLTemplateElement,
    act: { send(telegram: Telegram): void; set(): void; restart(): void },
  ) {
    this.side = root.dataset.side === 'A' ? 'A' : 'B';
    this.#root = root;
    root.append(template.content.cloneNode(true));
    this.#part('legend').textContent = `Station ${this.side}`;
    this.field('priority').value = this.side === 'A' ? 'high' : 'low';
    const form = root.querySelector('form');
    form?.addEventListener('submit', (event) => {
      event.preventDefault();
      act.send(readTelegram(form));
    });
    for (const [group, change] of [
      ['.settings', act.restart],
      ['.faults', act.set],
    ] as const) {
      this.#part(group).addEventListener('change', change);
    }
  }

  /** A field by its name. */
  field(name: string): HTMLInputElement | HTMLSelectElement {
    const found = this.#root.querySelector<HTMLInputElement | HTMLSelectElement>(
      `[name="${name}"]`,
    );
    if (!found) throw new Error(`a station has no field ${name}`);
    return found;
  }

  /** Settings and faults, as the fields have them. */
  get values(): Record<string, string | boolean> {
    const value = (field: HTMLInputElement | HTMLSelectElement) =>
      field instanceof HTMLInputElement && field.type === 'checkbox' ? field.checked : field.value;
    const all = this.#fields('.settings, .faults');
    return Object.fromEntries(all.map((it) => [it.name, value(it)]));
  }

  settings(): unknown {
    const { preset, priority, parity } = this.#values('.settings');
    return { preset, priority, parity, baud: Number(this.field('baud').value) };
  }

  faults(): unknown {
    return this.#values('.faults');
  }

  /** All settings and faults as they are at first. */
  reset(): void {
    for (const field of this.#fields('.settings, .faults')) {
      if (field instanceof HTMLInputElement) {
        field.value = field.defaultValue;
        field.checked = field.defaultChecked;
      } else {
        for (const option of field.options) option.selected = option.defaultSelected;
      }
    }
    this.field('priority').value = this.side === 'A' ? 'high' : 'low';
  }

  show({ activity, deadlineS, waiting }: StationState, nowS: number): void {
    this.#part('.activity').textContent = activity;
    const left = deadlineS === null ? '' : `${Math.max(deadlineS - nowS, 0).toFixed(3)} s left`;
    this.#part('.timer').textContent = left;
    this.#part('.waiting').textContent = waiting > 0 ? `${waiting} to send` : '';
  }

  tell(event: StationEvent): void {
    tell(this.#part('.events'), EVENTS, event);
  }

  clear(): void {
    this.#part('.events').replaceChildren();
  }

  #part(selector: string): HTMLElement {
    const found = this.#root.querySelector<HTMLElement>(selector);
    if (!found) throw new Error(`a station has no ${selector}`);
    return found;
  }

  #fields(groups: string): (HTMLInputElement | HTMLSelectElement)[] {
    const found = [...this.#root.querySelectorAll(groups)].flatMap((group) => [
      ...group.querySelectorAll<HTMLInputElement | HTMLSelectElement>('[name]'),
    ]);
    return found;
  }

  #values(group: string): Record<string, string | number | boolean> {
    const value = (field: HTMLInputElement | HTMLSelectElement) => {
      if (field.type === 'checkbox') return (field as HTMLInputElement).checked;
      // An empty number is refused by name, as a wrong one is.
      return field.type === 'number' ? (field as HTMLInputElement).valueAsNumber : field.value;
    };
    return Object.fromEntries(this.#fields(group).map((it) => [it.name, value(it)]));
  }
}

/** What a form has as its telegram. */
export function readTelegram(form: HTMLFormElement): Telegram {
  const data = new FormData(form);
  return { text: String(data.get('telegram')), is_hex: data.get('as') === 'hex' };
}
