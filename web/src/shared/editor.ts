// A text of lines with their numbers, of which some are marked.
import { create } from './dom';
import './editor.css';

/** What a line is marked as: what is wrong, and what the machine is at. */
export type Mark = 'bad' | 'note' | 'now';

/** Must be the line height of the style sheet. */
const LINE_PX = 20;

export class Editor {
  readonly #input: HTMLTextAreaElement;
  readonly #changed: () => void;
  readonly #numbers = create('pre', { className: 'numbers', ariaHidden: 'true' });
  readonly #layer = create('div', { className: 'marks', ariaHidden: 'true' });
  readonly #marks = new Map<Mark, HTMLElement[]>();
  #lines = 0;

  constructor(target: HTMLElement, label: string, changed: () => void) {
    this.#changed = changed;
    this.#input = create('textarea', {
      spellcheck: false,
      wrap: 'off',
      rows: 14,
      ariaLabel: label,
      autocapitalize: 'off',
    });
    this.#input.addEventListener('input', () => {
      this.#number();
      changed();
    });
    this.#input.addEventListener('scroll', () => this.#scroll());
    target.append(this.#numbers, this.#layer, this.#input);
  }

  get text(): string {
    return this.#input.value;
  }

  set text(text: string) {
    this.#input.value = text;
    this.#number();
    for (const kind of [...this.#marks.keys()]) this.mark(kind, []);
  }

  /** Another text, as if it were typed. */
  change(text: string): void {
    this.text = text;
    this.#changed();
  }

  /** Marks lines, counted from 1, and no others of this kind. */
  mark(kind: Mark, lines: number[]): void {
    for (const mark of this.#marks.get(kind) ?? []) mark.remove();
    const marks = lines.map((line) => {
      const mark = create('div', { className: kind });
      mark.style.top = `${(line - 1) * LINE_PX}px`;
      return mark;
    });
    this.#marks.set(kind, marks);
    this.#layer.append(...marks);
    if (kind === 'bad') this.#input.ariaInvalid = String(lines.length > 0);
  }

  /** Scrolls until a line is in sight. */
  reveal(line: number): void {
    const top = (line - 1) * LINE_PX;
    const { scrollTop, clientHeight } = this.#input;
    if (top < scrollTop || top > scrollTop + clientHeight - 3 * LINE_PX) {
      this.#input.scrollTop = top - clientHeight / 2;
    }
  }

  #number(): void {
    const lines = this.text.split('\n').length;
    if (lines === this.#lines) return;
    this.#lines = lines;
    this.#numbers.textContent = Array.from({ length: lines }, (_, line) => line + 1).join('\n');
    this.#scroll();
  }

  #scroll(): void {
    this.#numbers.scrollTop = this.#input.scrollTop;
    this.#layer.style.transform = `translateY(${-this.#input.scrollTop}px)`;
  }
}

/** The lines that messages name, each as `line 3: ...`, after a file's name or not. */
export function linesOf(messages: string[]): number[] {
  const numbers = messages.map((it) => /(?:^|: )line (\d+)\b/.exec(it)?.[1]);
  return numbers.filter((it) => it !== undefined).map(Number);
}
