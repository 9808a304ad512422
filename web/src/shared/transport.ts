// Time on the machine: played at a multiple of real time, or set by hand.
import { element } from './dom';

interface Options {
  /** Told when it plays from another time or at another multiple of real time, and when it ends. */
  playing?: (isPlaying: boolean, seconds: number, rate: number) => void;
  /** Multiples of real time, and the one at first. */
  speeds?: number[];
  speed?: number;
}

/** The buttons and the slider under a picture; tells the time whenever it changes. */
export class Transport {
  readonly #play = element('play', HTMLButtonElement);
  readonly #speed = element('speed', HTMLSelectElement);
  readonly #slider = element('time', HTMLInputElement);
  readonly #shown = element('shown-time', HTMLOutputElement);
  readonly #show: (seconds: number) => void;
  readonly #playing: Options['playing'];
  #seconds = 0;
  #duration = 0;
  #frame = 0;
  #before = 0;

  constructor(
    show: (seconds: number) => void,
    { playing, speeds = [1, 10, 100], speed = 10 }: Options = {},
  ) {
    for (const it of speeds) {
      this.#speed.add(new Option(`${it} ×${it === 1 ? ' (real)' : ''}`, String(it)));
    }
    this.#speed.value = String(speed);
    this.#show = show;
    this.#playing = playing;
    this.#play.addEventListener('click', () => (this.#frame ? this.pause() : this.play()));
    this.#speed.addEventListener('input', () => this.#tell());
    this.#slider.addEventListener('input', () => this.set(Number(this.#slider.value)));
  }

  get seconds(): number {
    return this.#seconds;
  }

  /** A new run of a duration; the time stands at its end, where all of it is seen. */
  begin(duration: number): void {
    this.#duration = duration;
    this.#slider.max = String(duration);
    this.#slider.step = String(Math.max(duration / 10_000, 0.001));
    this.set(duration);
  }

  set(seconds: number): void {
    this.#move(seconds);
    this.#tell();
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
    if (this.#seconds >= this.#duration) this.set(0);
    this.#play.textContent = 'Pause';
    this.#before = performance.now();
    this.#frame = requestAnimationFrame((now) => this.#advance(now));
    this.#tell();
  }

  /** As it plays from now on. */
  #tell(): void {
    if (this.#frame) this.#playing?.(true, this.#seconds, Number(this.#speed.value));
  }

  pause(): void {
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    this.#play.textContent = 'Play';
    this.#playing?.(false, this.#seconds, 0);
  }

  #advance(now: number): void {
    const by = ((now - this.#before) / 1000) * Number(this.#speed.value);
    this.#before = now;
    this.#move(this.#seconds + Math.max(by, 0));
    if (this.#seconds >= this.#duration) this.pause();
    else this.#frame = requestAnimationFrame((next) => this.#advance(next));
  }
}
