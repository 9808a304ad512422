// Time on the machine: played at a multiple of real time, or set by hand.
import { element } from './dom';
import { fromAddress, intoAddress, linkChanged } from './store';

interface Options {
  /** Told when it plays from another time or at another multiple of real time, and when it ends. */
  playing?: (isPlaying: boolean, seconds: number, rate: number) => void;
  /** Multiples of real time, and the one at first. */
  speeds?: number[];
  speed?: number;
}

/** What is played when a page opens. */
interface Opening {
  fromS: number;
  toS: number;
}

/** Seconds that a visitor is shown the run for. */
const OPENING_S = 8;

/** The buttons and the slider under a picture; tells the time whenever it changes. */
export class Transport {
  readonly #play = element('play', HTMLButtonElement);
  readonly #speed = element('speed', HTMLSelectElement);
  readonly #slider = element('time', HTMLInputElement);
  readonly #shown = element('shown-time', HTMLOutputElement);
  readonly #show: (seconds: number) => void;
  readonly #playing: Options['playing'];
  readonly #usualSpeed: string;
  #seconds = 0;
  #duration = 0;
  #frame = 0;
  #before = 0;
  #hasBegun = false;
  /** Until when, and at which multiple of real time, it plays by itself. */
  #opening: { toS: number; rate: number } | undefined;

  constructor(
    show: (seconds: number) => void,
    { playing, speeds = [1, 10, 100], speed = 10 }: Options = {},
  ) {
    for (const it of speeds) {
      this.#speed.add(new Option(`${it} ×${it === 1 ? ' (real)' : ''}`, String(it)));
    }
    this.#usualSpeed = String(speed);
    const asked = Number(fromAddress('speed'));
    this.#speed.value = speeds.includes(asked) ? String(asked) : this.#usualSpeed;
    this.#show = show;
    this.#playing = playing;
    this.#play.addEventListener('click', () => (this.#frame ? this.pause() : this.play()));
    this.#speed.addEventListener('input', () => {
      this.#tell();
      linkChanged();
    });
    intoAddress(() => this.#address);
    this.#slider.addEventListener('input', () => this.set(Number(this.#slider.value)));
  }

  get seconds(): number {
    return this.#seconds;
  }

  /**
   * A new run of a duration; the time stands at its end, where all of it is seen. The first one stands
   * where the address says, or else plays once, unless motion is not wanted.
   */
  begin(duration: number, opening: Opening = { fromS: 0, toS: duration }): void {
    this.pause();
    this.#duration = duration;
    this.#slider.max = String(duration);
    this.#slider.step = String(Math.max(duration / 10_000, 0.001));
    const isFirst = !this.#hasBegun;
    this.#hasBegun = true;
    const asked = fromAddress('time');
    if (!isFirst) this.set(duration);
    else if (asked !== null && Number.isFinite(Number(asked))) this.set(Number(asked));
    else if (matchMedia('(prefers-reduced-motion: reduce)').matches) this.set(opening.toS);
    else this.#open(opening);
  }

  #open({ fromS, toS }: Opening): void {
    this.#move(fromS);
    this.#opening = { toS, rate: (toS - fromS) / OPENING_S };
    this.#start();
  }

  set(seconds: number): void {
    if (this.#opening) this.pause();
    this.#move(seconds);
    this.#tell();
    if (!this.#frame) linkChanged();
  }

  /** The time, unless it is the end. */
  get #address(): Record<string, string | null> {
    // Until there is a run, the address keeps what it asks for.
    if (!this.#hasBegun) return {};
    const isEnd = this.#seconds >= this.#duration;
    const { value } = this.#speed;
    return {
      time: isEnd ? null : String(this.#seconds),
      speed: value === this.#usualSpeed ? null : value,
    };
  }

  #move(seconds: number): void {
    this.#seconds = Math.min(Math.max(seconds, 0), this.#duration);
    this.#slider.value = String(this.#seconds);
    const shown = `${this.#seconds.toFixed(2)} s of ${this.#duration.toFixed(1)} s`;
    this.#slider.setAttribute('aria-valuetext', shown);
    this.#shown.value = shown;
    this.#show(this.#seconds);
  }

  play(): void {
    if (this.#seconds >= this.#duration) this.#move(0);
    this.#start();
  }

  #start(): void {
    this.#play.textContent = 'Pause';
    this.#before = performance.now();
    this.#frame = requestAnimationFrame((now) => this.#advance(now));
    this.#tell();
  }

  get #rate(): number {
    return this.#opening?.rate ?? Number(this.#speed.value);
  }

  /** As it plays from now on. */
  #tell(): void {
    if (this.#frame) this.#playing?.(true, this.#seconds, this.#rate);
  }

  pause(): void {
    const hasPlayed = this.#frame !== 0;
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    this.#opening = undefined;
    this.#play.textContent = 'Play';
    this.#playing?.(false, this.#seconds, 0);
    if (hasPlayed) linkChanged();
  }

  #advance(now: number): void {
    const by = ((now - this.#before) / 1000) * this.#rate;
    this.#before = now;
    const end = this.#opening?.toS ?? this.#duration;
    this.#move(Math.min(this.#seconds + Math.max(by, 0), end));
    if (this.#seconds >= end) this.pause();
    else this.#frame = requestAnimationFrame((next) => this.#advance(next));
  }
}
