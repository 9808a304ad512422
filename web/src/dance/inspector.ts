// The chosen move as fields.
import { create, element } from '../shared/dom';
import { actionOf, type Move, type Score } from './score';

export class Inspector {
  readonly #all = element('inspector', HTMLFieldSetElement);
  readonly #title = element('selected', HTMLElement);
  readonly #motor = element('motor', HTMLSelectElement);
  readonly #action = element('action', HTMLSelectElement);
  readonly #easing = element('easing', HTMLSelectElement);
  readonly #at = element('at', HTMLInputElement);
  readonly #for = element('for', HTMLInputElement);
  readonly #value = element('value', HTMLInputElement);
  readonly #repeat = element('repeat', HTMLInputElement);
  readonly #every = element('every', HTMLInputElement);

  constructor(change: (move: Move) => void) {
    this.#all.addEventListener('change', () => {
      // A field without a number waits for one.
      const isWhole = [this.#at, this.#for, this.#value, this.#repeat].every(
        (it) => it.value !== '',
      );
      if (isWhole) change(this.#move());
    });
  }

  show(score: Score, index: number | undefined): void {
    const move = index === undefined ? undefined : score.move?.[index];
    this.#all.disabled = !move;
    element('move-fields', HTMLElement).hidden = !move;
    element('choose', HTMLElement).hidden = move !== undefined;
    this.#title.textContent = move ? `Move ${(index ?? 0) + 1}` : 'No move is chosen';
    if (!move) return;
    const names = score.motor.map((it) => create('option', { textContent: it.name }));
    this.#motor.replaceChildren(...names);
    fill(this.#motor, move.motor);
    fill(this.#action, actionOf(move));
    fill(this.#value, move[actionOf(move)] ?? 0);
    fill(this.#easing, move.easing ?? 'linear');
    fill(this.#at, move.at_s);
    fill(this.#for, move.for_s);
    fill(this.#repeat, move.repeat ?? 1);
    fill(this.#every, move.every_s ?? '');
  }

  /** As the fields have it; what it may be, the score's reader says. */
  #move(): Move {
    const move: Move = {
      motor: this.#motor.value,
      at_s: Number(this.#at.value),
      for_s: Number(this.#for.value),
      [this.#action.value]: Number(this.#value.value),
    };
    if (this.#easing.value !== 'linear') move.easing = this.#easing.value;
    const times = Number(this.#repeat.value);
    if (times !== 1) {
      move.repeat = times;
      // Without an interval, one after the other.
      move.every_s = this.#every.value === '' ? move.for_s : Number(this.#every.value);
    }
    return move;
  }
}

/** What is being typed stays when a result comes in between. */
function fill(field: HTMLInputElement | HTMLSelectElement, value: string | number): void {
  if (field instanceof HTMLSelectElement || document.activeElement !== field) {
    field.value = String(value);
  }
}
