// The conversation as a ladder: A on the left, B on the right, a rung for each step.
import { create } from '../shared/dom';
import type { Conversation, Step } from './conversation';

/** Rungs that are in the page at a time. */
const ROWS = 300;

export class Ladder {
  readonly #region: HTMLElement;
  readonly #list = create('ol');
  readonly #earlier: HTMLButtonElement;
  readonly #later: HTMLButtonElement;
  readonly #pick: (seconds: number) => void;
  #conversation: Conversation | undefined;
  /** The steps on show. */
  #from = 0;
  #to = 0;
  #follows = false;

  constructor(region: HTMLElement, pick: (seconds: number) => void) {
    this.#region = region;
    this.#pick = pick;
    const button = (textContent: string, by: number) => {
      const made = create('button', { type: 'button', textContent, hidden: true });
      made.addEventListener('click', () => this.#turn(by));
      return made;
    };
    this.#earlier = button('Earlier', -ROWS);
    this.#later = button('Later', ROWS);
    region.append(this.#earlier, this.#list, this.#later);
    this.#list.addEventListener('click', ({ target }) => {
      const at = target instanceof Element ? target.closest('li')?.dataset.at : undefined;
      if (at !== undefined) this.#pick(Number(at));
    });
  }

  /** Another conversation: from its begin, or what comes last. */
  show(conversation: Conversation, follows: boolean): void {
    this.#conversation = conversation;
    this.#follows = follows;
    this.#from = this.#to = 0;
    this.#list.replaceChildren();
    this.#region.scrollTop = 0;
    this.update();
  }

  /** New steps of the same conversation. */
  update(): void {
    const count = this.#conversation?.steps.length ?? 0;
    const { scrollTop, scrollHeight, clientHeight } = this.#region;
    const isAtEnd = scrollTop + clientHeight > scrollHeight - 40;
    if (count < this.#to) this.#window(0, 0); // The oldest were forgotten.
    if (this.#follows) this.#window(Math.max(0, count - ROWS), count);
    else this.#window(this.#from, Math.min(this.#from + ROWS, count));
    if (this.#follows && isAtEnd) this.#region.scrollTop = this.#region.scrollHeight;
  }

  #turn(by: number): void {
    const count = this.#conversation?.steps.length ?? 0;
    const from = Math.min(Math.max(this.#from + by, 0), Math.max(count - ROWS, 0));
    this.#follows &&= by > 0 && from + ROWS >= count;
    this.#window(from, Math.min(from + ROWS, count));
    this.#region.scrollTop = by > 0 ? 0 : this.#region.scrollHeight;
  }

  /** Shows these steps; rungs that stay are not made anew. */
  #window(from: number, to: number): void {
    const steps = this.#conversation?.steps ?? [];
    const isNext = from >= this.#from && from < this.#to && to >= this.#to;
    if (!isNext) {
      this.#list.replaceChildren();
      this.#from = this.#to = from;
    }
    for (; this.#from < from; this.#from += 1) this.#list.firstElementChild?.remove();
    this.#list.append(...steps.slice(this.#to, to).map(rung));
    this.#to = to;
    this.#list.start = from + 1;
    this.#earlier.hidden = from === 0;
    this.#later.hidden = to >= steps.length;
  }
}

function rung({ at, side, kind, isSent, text }: Step): HTMLLIElement {
  const made = create(
    'li',
    { className: `${kind} ${side ? `from-${side}` : ''} ${isSent ? '' : 'missing'}` },
    create('time', { textContent: at }),
    create('span', { textContent: text }),
  );
  made.dataset.at = at;
  return made;
}
