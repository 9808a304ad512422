// What a page works on: one of the inputs that are shipped, or one's own, which the browser keeps.
import { element, takeFiles } from './dom';
import { fromAddress, keep, kept } from './store';

export interface Naming {
  /** In the address. */
  parameter: string;
  /** What the names of shipped inputs end with. */
  ending: string;
  /** Under which the browser keeps one's own. */
  kept: { text: string; name: string };
}

const CHANGED = ', changed';

export class Inputs {
  readonly #choice: HTMLSelectElement;
  readonly #shipped: Record<string, string>;
  readonly #naming: Naming;
  /** Also where the browser has no room to keep it. */
  #own: { text: string; name: string } | undefined;

  /** The first of the shipped inputs is the usual one; `opened` is told of another input. */
  constructor(
    choice: HTMLSelectElement,
    shipped: Record<string, string>,
    naming: Naming,
    opened: () => void,
  ) {
    this.#choice = choice;
    this.#shipped = shipped;
    this.#naming = naming;
    const text = kept(naming.kept.text);
    if (text !== null) this.#offer(text, kept(naming.kept.name) ?? `own${naming.ending}`);
    const asked = fromAddress(naming.parameter) ?? '';
    choice.value = Object.hasOwn(shipped, asked) ? asked : this.#own ? 'own' : this.#usual;
    choice.addEventListener('input', opened);
    takeFiles(element('drop', HTMLElement), element('file', HTMLInputElement), async (file) => {
      this.#take(await file.text(), file.name);
      opened();
    });
  }

  get text(): string {
    return this.#shipped[this.#choice.value] ?? this.#own?.text ?? '';
  }

  /** One's own from now on, as it is written. */
  set text(text: string) {
    this.#take(text, this.#isOwn ? this.name : this.name + CHANGED);
  }

  /** What messages call it. */
  get name(): string {
    if (this.#isOwn) return this.#own?.name ?? '';
    return this.#choice.value + this.#naming.ending;
  }

  /** What it is saved as. */
  get file(): string {
    return this.name.replace(CHANGED, '');
  }

  /** For the address, which names a shipped input unless that is shown without it. */
  get address(): Record<string, string | null> {
    const { value } = this.#choice;
    const isImplied = this.#isOwn || (value === this.#usual && !this.#own);
    return { [this.#naming.parameter]: isImplied ? null : value };
  }

  get #isOwn(): boolean {
    return this.#choice.value === 'own';
  }

  get #usual(): string {
    return Object.keys(this.#shipped)[0] ?? '';
  }

  #take(text: string, name: string): void {
    keep(this.#naming.kept.text, text);
    keep(this.#naming.kept.name, name);
    this.#offer(text, name);
    this.#choice.value = 'own';
  }

  #offer(text: string, name: string): void {
    this.#own = { text, name };
    const option = this.#choice.querySelector<HTMLOptionElement>('option[value=own]');
    if (!option) return;
    option.hidden = false;
    option.textContent = name;
  }
}
