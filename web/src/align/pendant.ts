// The pendant in the visitor's hands: its time is that of the clock on the wall.
import { element } from '../shared/dom';
import { Machine } from '../shared/machine';
import type { Moment } from './aligned';

/** What is seen at the desk. */
interface Seen {
  display: string[];
  led: 'off' | 'on' | 'flashing';
  isMoving: boolean;
  moment: Moment;
}

type Act =
  | { key: number }
  | { direction: number }
  | { multiplier: number }
  | { enable: [boolean, boolean] }
  | { wheel: number };

/** From one look to the next. */
const LOOK_MS = 100;
/** A page that was in the background does not catch up with more. */
const MAX_WAIT_MS = 1000;
/** A key that is clicked is down for so long. */
const PRESS_MS = 200;
/** Of a full turn of the wheel. */
const COUNTS = 100;

export class Pendant {
  readonly #wasm: string;
  readonly #platform: () => string;
  readonly #seen: (moment: Moment | undefined) => void;
  readonly #power = element('power', HTMLButtonElement);
  readonly #display = element('display', HTMLElement);
  readonly #led = element('led', HTMLElement);
  readonly #controls = element('controls', HTMLElement);
  readonly #wheel = element('wheel', HTMLElement);
  readonly #direction = element('direction', HTMLSelectElement);
  readonly #multiplier = element('multiplier', HTMLSelectElement);
  readonly #enable = element('enable', HTMLInputElement);
  #machine: Machine | undefined;
  /** From switching on to switching off. */
  #session: object | undefined;
  #acts: Act[] = [];
  #counts = 0;

  /** `seen` gets the platform as it is now, and nothing when the pendant is switched off. */
  constructor(
    wasm: string,
    platform: () => string,
    seen: (moment: Moment | undefined) => void,
    refuse: (error: unknown) => void,
  ) {
    this.#wasm = wasm;
    this.#platform = platform;
    this.#seen = seen;
    this.#power.addEventListener('click', () => {
      if (this.#session) this.switchOff();
      else
        this.#switchOn().catch((error) => {
          this.switchOff();
          refuse(error);
        });
    });
    for (const button of this.#controls.querySelectorAll<HTMLButtonElement>('button[data-key]')) {
      button.addEventListener('click', () => {
        this.#acts.push({ key: Number(button.dataset.key) });
        setTimeout(() => this.#acts.push({ key: 0 }), PRESS_MS);
      });
    }
    this.#direction.addEventListener('input', () =>
      this.#acts.push({ direction: Number(this.#direction.value) }),
    );
    this.#multiplier.addEventListener('input', () =>
      this.#acts.push({ multiplier: Number(this.#multiplier.value) }),
    );
    this.#enable.addEventListener('input', () => {
      const isHeld = this.#enable.checked;
      this.#acts.push({ enable: [isHeld, isHeld] });
    });
    this.#takeTurns();
  }

  switchOff(): void {
    if (!this.#session) return;
    this.#session = undefined;
    this.#power.textContent = 'Switch on';
    this.#controls.hidden = true;
    this.#display.textContent = '';
    this.#setLed('off');
    this.#seen(undefined);
  }

  async #switchOn(): Promise<void> {
    // A machine of its own: that of the sliders is stopped when they move.
    this.#machine ??= new Machine(this.#wasm);
    const session = {};
    this.#session = session;
    this.#power.textContent = 'Switch off';
    this.#controls.hidden = false;
    this.#enable.checked = false;
    this.#acts = [
      { direction: Number(this.#direction.value) },
      { multiplier: Number(this.#multiplier.value) },
    ];
    let seen = await this.#machine.call<Seen>('desk', this.#platform());
    let before = performance.now();
    while (this.#session === session) {
      this.#show(seen.value);
      await new Promise((then) => setTimeout(then, LOOK_MS));
      if (this.#session !== session) return;
      const now = performance.now();
      const wait_ms = Math.round(Math.min(now - before, MAX_WAIT_MS));
      before = now;
      const acts = this.#acts.splice(0);
      seen = await this.#machine.call<Seen>('desk.turn', { acts, wait_ms });
    }
  }

  #show({ display, led, moment }: Seen): void {
    const text = display.join('\n');
    if (this.#display.textContent !== text) {
      this.#display.textContent = text;
      this.#display.ariaLabel = `Display: ${display.map((it) => it.trim()).join(', ')}`;
    }
    this.#setLed(led);
    this.#seen(moment);
  }

  #setLed(led: Seen['led']): void {
    this.#led.className = `led ${led}`;
    this.#led.ariaLabel = `LED ${led}`;
  }

  #turn(counts: number): void {
    if (counts === 0) return;
    this.#counts += counts;
    this.#acts.push({ wheel: counts });
    this.#wheel.style.transform = `rotate(${(this.#counts / COUNTS) * 360}deg)`;
    this.#wheel.ariaValueNow = String(this.#counts);
    this.#wheel.ariaValueText = `${this.#counts} counts`;
  }

  #takeTurns(): void {
    const wheel = this.#wheel;
    const keys: Record<string, number> = {
      ArrowUp: 1,
      ArrowRight: 1,
      ArrowDown: -1,
      ArrowLeft: -1,
      PageUp: 10,
      PageDown: -10,
    };
    wheel.addEventListener('keydown', (event) => {
      const counts = keys[event.key];
      if (counts === undefined) return;
      event.preventDefault();
      this.#turn(counts);
    });
    /** Where the pointer is around the middle of the wheel, in counts, and what is left of one. */
    let at: number | undefined;
    let left = 0;
    const around = (event: PointerEvent) => {
      const box = wheel.getBoundingClientRect();
      const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
      return (Math.atan2(event.clientY - y, event.clientX - x) / (2 * Math.PI)) * COUNTS;
    };
    wheel.addEventListener('pointerdown', (event) => {
      wheel.setPointerCapture(event.pointerId);
      [at, left] = [around(event), 0];
    });
    wheel.addEventListener('pointermove', (event) => {
      if (at === undefined) return;
      const now = around(event);
      let by = now - at;
      // The shorter way round.
      by -= Math.round(by / COUNTS) * COUNTS;
      at = now;
      left += by;
      const whole = Math.trunc(left);
      left -= whole;
      this.#turn(whole);
    });
    const up = () => (at = undefined);
    wheel.addEventListener('pointerup', up);
    wheel.addEventListener('pointercancel', up);
  }
}
