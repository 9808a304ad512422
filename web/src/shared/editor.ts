// A text of lines with their numbers, of which some are marked. Of a long text a part is shown.
import { create } from './dom';
import './editor.css';

/** What a line is marked as: what is wrong, and what the machine is at. */
export type Mark = 'bad' | 'note' | 'now';

/** Must be the line height of the style sheet. */
const LINE_PX = 20;
/** A longer text is shown in parts and not edited: a browser stands still while it lays it out. */
const MAX_LINES = 3000;
const MAX_LENGTH = 150_000;
/** Lines of a part, and characters of a line in it. */
const PART = 500;
const MAX_SHOWN = 300;

export class Editor {
  readonly #input: HTMLTextAreaElement;
  readonly #changed: () => void;
  readonly #numbers = create('pre', { className: 'numbers', ariaHidden: 'true' });
  readonly #layer = create('div', { className: 'marks', ariaHidden: 'true' });
  readonly #paging = create('div', { className: 'paging', hidden: true });
  readonly #note = create('small');
  readonly #marks = new Map<Mark, number[]>();
  #lines: string[] = [''];
  #isLong = false;
  /** Lines before those on show. */
  #before = 0;
  /** Lines on show. */
  #shown = 0;

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
      this.#lines = this.#input.value.split('\n');
      if (this.#lines.length > MAX_LINES || this.#input.value.length > MAX_LENGTH) {
        this.text = this.#input.value;
      }
      this.#number();
      changed();
    });
    this.#input.addEventListener('scroll', () => this.#scroll());
    const page = (textContent: string, by: number) => {
      const button = create('button', { type: 'button', textContent });
      button.addEventListener('click', () => this.#show(this.#before + by));
      return button;
    };
    this.#paging.append(page('Earlier', -PART), page('Later', PART), this.#note);
    target.append(this.#numbers, this.#layer, this.#input, this.#paging);
  }

  get text(): string {
    return this.#isLong ? this.#lines.join('\n') : this.#input.value;
  }

  set text(text: string) {
    this.#lines = text.split('\n');
    this.#isLong = this.#lines.length > MAX_LINES || text.length > MAX_LENGTH;
    this.#input.readOnly = this.#isLong;
    this.#paging.hidden = !this.#isLong;
    this.#marks.clear();
    this.#input.ariaInvalid = 'false';
    if (this.#isLong) {
      this.#show(0);
    } else {
      this.#before = 0;
      this.#input.value = text;
      this.#number();
      this.#place();
    }
  }

  /** A line, counted from 1. */
  line(number: number): string {
    return this.#lines[number - 1] ?? '';
  }

  /** Another text, as if it were typed. */
  change(text: string): void {
    this.text = text;
    this.#changed();
  }

  /** Marks lines, counted from 1, and no others of this kind. */
  mark(kind: Mark, lines: number[]): void {
    const before = this.#marks.get(kind) ?? [];
    if (before.join() === lines.join()) return;
    this.#marks.set(kind, lines);
    this.#place();
    if (kind === 'bad') this.#input.ariaInvalid = String(lines.length > 0);
  }

  /** Scrolls until a line is in sight. */
  reveal(line: number): void {
    if (this.#isLong && (line <= this.#before || line > this.#before + this.#shown)) {
      this.#show(line - PART / 2);
    }
    const top = (line - 1 - this.#before) * LINE_PX;
    const { scrollTop, clientHeight } = this.#input;
    if (top < scrollTop || top > scrollTop + clientHeight - 3 * LINE_PX) {
      this.#input.scrollTop = top - clientHeight / 2;
    }
  }

  /** Shows a part of a long text. */
  #show(before: number): void {
    this.#before = Math.max(Math.min(before, this.#lines.length - PART), 0);
    const lines = this.#lines.slice(this.#before, this.#before + PART);
    const cut = (line: string) =>
      line.length > MAX_SHOWN ? `${line.slice(0, MAX_SHOWN)} …` : line;
    this.#input.value = lines.map(cut).join('\n');
    this.#input.scrollTop = 0;
    const last = this.#before + lines.length;
    this.#note.textContent = `lines ${this.#before + 1} to ${last} of ${this.#lines.length}: too long to be edited here`;
    this.#number();
    this.#place();
  }

  #place(): void {
    const marks = [...this.#marks].flatMap(([kind, lines]) =>
      lines
        .map((line) => line - 1 - this.#before)
        .filter((line) => line >= 0 && line < Math.max(this.#shown, 1))
        .map((line) => {
          const mark = create('div', { className: kind });
          mark.style.top = `${line * LINE_PX}px`;
          return mark;
        }),
    );
    this.#layer.replaceChildren(...marks);
  }

  #number(): void {
    this.#shown = Math.min(this.#lines.length - this.#before, this.#isLong ? PART : Infinity);
    const first = this.#before + 1;
    this.#numbers.textContent = Array.from({ length: this.#shown }, (_, line) => first + line).join(
      '\n',
    );
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
