// What happens at a station, one line each.
import { create } from '../shared/dom';

/** Adds a line to a list that has the newest ones. */
export function tell(
  list: HTMLElement,
  most: number,
  { atS, text, isGood }: { atS: number; text: string; isGood: boolean },
): void {
  const line = `${atS.toFixed(3)} s ${text}`;
  list.append(create('li', { textContent: line, className: isGood ? 'good' : 'fault' }));
  while (list.childElementCount > most) list.firstElementChild?.remove();
}
