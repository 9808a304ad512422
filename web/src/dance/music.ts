// A music file beside the score: its waveform over the lanes, and its sound while the dance plays.
import { create } from '../shared/dom';

/** What a canvas may be wide in every browser. */
const COLUMNS = 8000;
const HEIGHT_PX = 40;
/** What browsers still play. */
const MAX_RATE = 4;

export class Music {
  readonly canvas = create('canvas', { className: 'wave', hidden: true });
  readonly #sound = new Audio();
  #duration = 0;

  /** Throws where the browser cannot decode it. */
  async open(file: File): Promise<void> {
    const decoder = new OfflineAudioContext(1, 1, 44_100);
    const samples = await decoder.decodeAudioData(await file.arrayBuffer());
    this.#duration = samples.duration;
    this.#sound.src = URL.createObjectURL(file);
    this.#draw(samples.getChannelData(0));
    this.canvas.hidden = false;
  }

  /** As wide as its time on the lanes. */
  stretch(perSecond: number): void {
    this.canvas.style.width = `${this.#duration * perSecond}px`;
  }

  play(seconds: number, rate: number): void {
    if (seconds >= this.#duration || rate > MAX_RATE) {
      this.pause();
      return;
    }
    this.#sound.currentTime = seconds;
    this.#sound.playbackRate = rate;
    // Without permission to sound, the dance goes on.
    this.#sound.play().catch(() => undefined);
  }

  pause(): void {
    this.#sound.pause();
  }

  #draw(samples: Float32Array): void {
    this.canvas.width = COLUMNS;
    this.canvas.height = HEIGHT_PX;
    const context = this.canvas.getContext('2d');
    if (!context) return;
    context.fillStyle = '#808890';
    const perColumn = samples.length / COLUMNS;
    for (let column = 0; column < COLUMNS; column += 1) {
      const part = samples.subarray(column * perColumn, (column + 1) * perColumn);
      const peak = part.reduce((most, it) => Math.max(most, Math.abs(it)), 0);
      context.fillRect(column, (HEIGHT_PX / 2) * (1 - peak), 1, HEIGHT_PX * peak);
    }
  }
}
