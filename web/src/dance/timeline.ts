// The moves as blocks on a lane for each motor: dragged, stretched, or changed by keys.
import { create } from '../shared/dom';
import { describe, frameOf, type Move, type Score, snap, starts } from './score';

/** What the editor does with a move, by its index in the score. */
export interface Edits {
  select(index: number): void;
  change(index: number, change: Partial<Move>): void;
  copy(index: number): void;
  remove(index: number): void;
  seek(seconds: number): void;
}

/** Width of the right end of a block that stretches it. */
const HANDLE_PX = 10;
/** A narrower block has no room for what it does. */
const TEXT_PX = 44;
/** Below it, a pointer has clicked and not dragged. */
const DRAG_PX = 3;

export class Timeline {
  readonly #target: HTMLElement;
  readonly #edits: Edits;
  readonly #wave: HTMLElement;
  readonly #now = create('div', { className: 'now' });
  #score: Score = { motor: [] };
  #selected: number | undefined;
  #bad: number | undefined;
  #perSecond: number;
  #seconds = 0;
  /** What is dragged must not be drawn anew under the pointer. */
  #isDragging = false;
  #isOutdated = false;

  constructor(target: HTMLElement, wave: HTMLElement, perSecond: number, edits: Edits) {
    this.#target = target;
    this.#perSecond = perSecond;
    this.#wave = wave;
    this.#edits = edits;
    target.addEventListener('click', ({ target: clicked, offsetX }) => {
      const isTime = clicked instanceof HTMLElement && clicked.matches('.track, .ruler');
      if (isTime) edits.seek(offsetX / this.#perSecond);
    });
  }

  /** Pixels of a second. */
  get zoom(): number {
    return this.#perSecond;
  }

  set zoom(perSecond: number) {
    this.#perSecond = perSecond;
    this.#fill();
  }

  show(score: Score, selected: number | undefined, bad: number | undefined): void {
    this.#score = score;
    this.#selected = selected;
    this.#bad = bad;
    this.#fill();
  }

  /** The time of the robot, which is kept in sight. */
  at(seconds: number): void {
    this.#seconds = seconds;
    this.#placeNow();
    const x = seconds * this.#perSecond;
    const { scrollLeft, clientWidth } = this.#target;
    const seen = clientWidth - (this.#target.querySelector('span')?.offsetWidth ?? 0);
    if (x < scrollLeft || x > scrollLeft + seen) this.#target.scrollLeft = x - seen / 10;
  }

  #placeNow(): void {
    this.#now.style.left = `calc(var(--names) + ${this.#seconds * this.#perSecond}px)`;
  }

  focus(index: number): void {
    const button = this.#target.querySelector<HTMLElement>(`[data-index="${index}"]`);
    button?.focus({ preventScroll: true });
  }

  get #length(): number {
    const ends = (this.#score.move ?? []).flatMap((it) => starts(it).map((at) => at + it.for_s));
    return ends.reduce((most, it) => Math.max(most, it), Math.max(this.#score.length_s ?? 0, 10));
  }

  #fill(): void {
    this.#isOutdated = this.#isDragging;
    if (this.#isDragging) return;
    const { activeElement } = document;
    const focused = this.#target.contains(activeElement)
      ? (activeElement as HTMLElement).dataset.index
      : undefined;
    const width = `${this.#length * this.#perSecond}px`;
    const ruler = create('div', { className: 'ruler' }, this.#wave, ...this.#marks());
    ruler.style.width = width;
    const lane = (name: string, track: HTMLElement) =>
      create('div', { className: 'lane' }, create('span', { textContent: name }), track);
    const rows = this.#score.motor.map(({ name }) => {
      const moves = [...(this.#score.move ?? []).entries()].filter(([, it]) => it.motor === name);
      const blocks = moves.flatMap(([index, move]) => this.#blocks(index, move));
      const track = create('div', { className: 'track' }, ...blocks);
      track.style.width = width;
      return lane(name, track);
    });
    this.#target.replaceChildren(lane('time', ruler), ...rows, this.#now);
    this.#placeNow();
    if (focused !== undefined) this.focus(Number(focused));
  }

  #marks(): HTMLElement[] {
    const step = [0.2, 1, 5, 10, 30].find((it) => it * this.#perSecond >= 50) ?? 60;
    return Array.from({ length: Math.ceil(this.#length / step) }, (_, mark) => {
      const at = Number((mark * step).toFixed(1));
      const shown = create('small', { textContent: `${at} s` });
      shown.style.left = `${at * this.#perSecond}px`;
      return shown;
    });
  }

  /** A button for the move, and a shadow for each repetition. */
  #blocks(index: number, move: Move): HTMLElement[] {
    return starts(move).map((at, time) => {
      const block = time === 0 ? this.#button(index, move) : create('div', { className: 'shadow' });
      this.#place(block, at, move.for_s);
      return block;
    });
  }

  #place(block: HTMLElement, at: number, length: number): void {
    block.style.left = `${at * this.#perSecond}px`;
    const width = Math.max(length * this.#perSecond, 4);
    block.style.width = `${width}px`;
    block.classList.toggle('narrow', width < TEXT_PX);
  }

  #button(index: number, move: Move): HTMLElement {
    const label = `${move.motor}, ${describe(move)}, ${move.easing ?? 'linear'}, at ${move.at_s} s for ${move.for_s} s`;
    const button = create('button', {
      type: 'button',
      className: index === this.#bad ? 'move bad' : 'move',
      textContent: describe(move),
      ariaLabel: label,
      ariaPressed: String(index === this.#selected),
      title: label,
    });
    button.dataset.index = String(index);
    button.addEventListener('click', () => this.#edits.select(index));
    button.addEventListener('keydown', (event) => this.#key(event, index, move));
    button.addEventListener('pointerdown', (event) => this.#drag(event, button, index, move));
    return button;
  }

  #key(event: KeyboardEvent, index: number, move: Move): void {
    const { motor: motors } = this.#score;
    const frame = frameOf(this.#score);
    const time = (by: number) =>
      this.#edits.change(
        index,
        event.shiftKey
          ? { for_s: snap(this.#score, move.for_s + by * frame, 1) }
          : { at_s: snap(this.#score, move.at_s + by * frame) },
      );
    const lane = (by: number) => {
      const other = motors[motors.findIndex((it) => it.name === move.motor) + by];
      if (other) this.#edits.change(index, { motor: other.name });
    };
    const keys: Record<string, () => void> = {
      ArrowLeft: () => time(-1),
      ArrowRight: () => time(1),
      ArrowUp: () => lane(-1),
      ArrowDown: () => lane(1),
      c: () => this.#edits.copy(index),
      Delete: () => this.#edits.remove(index),
      Backspace: () => this.#edits.remove(index),
    };
    const act = event.ctrlKey || event.metaKey ? undefined : keys[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }

  #drag(begin: PointerEvent, button: HTMLElement, index: number, move: Move): void {
    const width = button.offsetWidth;
    const isStretch = begin.offsetX > Math.max(width - HANDLE_PX, width / 2);
    button.setPointerCapture(begin.pointerId);
    const changed = ({ clientX }: PointerEvent): Partial<Move> => {
      const by = (clientX - begin.clientX) / this.#perSecond;
      return isStretch
        ? { for_s: snap(this.#score, move.for_s + by, 1) }
        : { at_s: snap(this.#score, move.at_s + by) };
    };
    const dragged = (event: PointerEvent) => {
      const { at_s = move.at_s, for_s = move.for_s } = changed(event);
      this.#place(button, at_s, for_s);
    };
    const end = () => {
      this.#isDragging = false;
      dragging.abort();
      if (this.#isOutdated) this.#fill();
    };
    const dropped = (event: PointerEvent) => {
      end();
      const isDrag = Math.abs(event.clientX - begin.clientX) >= DRAG_PX;
      // A button that was drawn anew is not clicked any more.
      if (isDrag) this.#edits.change(index, changed(event));
      else this.#edits.select(index);
    };
    this.#isDragging = true;
    const dragging = new AbortController();
    const { signal } = dragging;
    button.addEventListener('pointermove', dragged, { signal });
    button.addEventListener('pointerup', dropped, { signal });
    button.addEventListener('pointercancel', end, { signal });
  }
}
