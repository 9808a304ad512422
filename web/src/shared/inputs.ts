// What a page works on: one of the inputs that are shipped, or one's own, which the browser keeps.
import { element, takeFiles } from './dom';
import { fromAddress, intoLink, isLinked, keep, kept, textFromLink, Trial } from './store';

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
  readonly #trial: Trial;
  /** Also where the browser has no room to keep it. */
  #own: { text: string; name: string } | undefined;
  #note: string | undefined;

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
    this.#trial = new Trial(naming.kept.text);
    const text = textFromLink('text') ?? kept(naming.kept.text);
    const name = textFromLink('name') ?? kept(naming.kept.name) ?? `own${naming.ending}`;
    if (text !== null) this.#offer(text, name);
    choice.value = this.#first();
    choice.addEventListener('input', () => {
      this.#note = undefined;
      opened();
    });
    takeFiles(element('drop', HTMLElement), element('file', HTMLInputElement), async (file) => {
      this.#take(await file.text(), file.name);
      opened();
    });
    intoLink('text', () => (this.#isOwn ? this.#own?.text : undefined));
    intoLink('name', () => (this.#isOwn ? this.#own?.name : undefined));
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

  /** For the address. */
  get address(): Record<string, string | null> {
    return { [this.#naming.parameter]: this.#choice.value };
  }

  /** Why another input was opened than the one that was asked for, if one was. */
  get notes(): string[] {
    return this.#note === undefined ? [] : [this.#note];
  }

  /** The machine takes it. */
  begin(): void {
    if (this.#isOwn) this.#trial.begin();
  }

  /** The machine has answered. */
  end(): void {
    this.#trial.end();
  }

  /** The input to begin with. */
  #first(): string {
    const asked = fromAddress(this.#naming.parameter) ?? (isLinked ? this.#usual : 'own');
    if (Object.hasOwn(this.#shipped, asked)) return asked;
    if (asked === 'own' && this.#own && !this.#trial.hasFailed) return asked;
    if (asked === 'own' && this.#own) {
      this.#note = `${this.#own.name} ended the page when it was opened last: choose it to try again`;
    } else if (isLinked) {
      this.#note = `the link names an input that is not in it: ${asked}`;
    }
    return this.#usual;
  }

  get #isOwn(): boolean {
    return this.#choice.value === 'own';
  }

  get #usual(): string {
    return Object.keys(this.#shipped)[0] ?? '';
  }

  #take(text: string, name: string): void {
    this.#note = undefined;
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
