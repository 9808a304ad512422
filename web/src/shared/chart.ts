// Charts over time in the colours of the page.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { colour, onColours } from './dom';

export interface Line {
  label: string;
  colour: string;
  dash?: number[];
}

/** A chart of lines over seconds; a click on it is a time. */
export class Chart {
  readonly #target: HTMLElement;
  readonly #unit: string;
  readonly #height: number;
  readonly #seek: (seconds: number) => void;
  #plot: uPlot | undefined;
  #lines: Line[] = [];
  #data: uPlot.AlignedData = [[]];
  #now = 0;
  /** Told of the time at the pointer, and of none when it has left. */
  #hover: (seconds: number | undefined) => void = () => undefined;

  constructor(target: HTMLElement, unit: string, height: number, seek: (seconds: number) => void) {
    this.#target = target;
    this.#unit = unit;
    this.#height = height;
    this.#seek = seek;
    new ResizeObserver(() => {
      this.#plot?.setSize({ width: target.clientWidth, height });
    }).observe(target);
    onColours(() => this.#make());
  }

  onHover(hover: (seconds: number | undefined) => void): void {
    this.#hover = hover;
  }

  /** Other lines: seconds first, then the values of each. */
  show(lines: Line[], data: uPlot.AlignedData): void {
    this.#lines = lines;
    this.#data = data;
    this.#make();
  }

  /** The time that the pictures show. */
  at(seconds: number): void {
    this.#now = seconds;
    this.#plot?.redraw(false);
    this.#tell();
  }

  /** The values below the chart: at the pointer, or else at the time on show. */
  #tell(): void {
    const plot = this.#plot;
    if (!plot || (plot.cursor.left ?? -1) >= 0 || plot.data[0].length === 0) return;
    plot.setLegend({ idx: plot.valToIdx(this.#now) }, false);
  }

  #make(): void {
    this.#plot?.destroy();
    const axis = {
      stroke: colour('text'),
      grid: { stroke: colour('line'), width: 1 },
      ticks: { show: false },
    };
    this.#plot = new uPlot(
      {
        width: this.#target.clientWidth,
        height: this.#height,
        scales: { x: { time: false } },
        axes: [
          { ...axis, label: 'time in s', labelSize: 18, size: 30 },
          { ...axis, label: this.#unit, labelSize: 18, size: 56 },
        ],
        series: [
          { label: 'time', value: (_, it) => (it === null ? '' : `${it.toFixed(2)} s`) },
          ...this.#lines.map((line) => ({
            label: line.label,
            stroke: colour(line.colour),
            width: 1.5,
            points: { show: false },
            ...(line.dash ? { dash: line.dash } : {}),
            value: (plot: uPlot, it: number | null) =>
              it === null ? 'none' : `${shown(it, plot.scales.y)} ${this.#unit}`,
          })),
        ],
        legend: { markers: { dash: (_, series) => stroke(this.#lines[series - 1]?.dash) } },
        hooks: {
          ready: [() => this.#tell()],
          draw: [(plot) => this.#drawNow(plot)],
          setCursor: [
            (plot) => {
              this.#tell();
              const left = plot.cursor.left ?? -1;
              this.#hover(left >= 0 ? plot.posToVal(left, 'x') : undefined);
            },
          ],
        },
      },
      this.#data,
      this.#target,
    );
    const over = this.#plot.over;
    over.addEventListener('click', () => {
      const left = this.#plot?.cursor.left;
      if (left !== undefined && left >= 0) this.#seek(this.#plot?.posToVal(left, 'x') ?? 0);
    });
  }

  #drawNow(plot: uPlot): void {
    const x = plot.valToPos(this.#now, 'x', true);
    plot.ctx.save();
    plot.ctx.strokeStyle = colour('now');
    plot.ctx.lineWidth = devicePixelRatio;
    plot.ctx.setLineDash([]);
    plot.ctx.beginPath();
    plot.ctx.moveTo(x, plot.bbox.top);
    plot.ctx.lineTo(x, plot.bbox.top + plot.bbox.height);
    plot.ctx.stroke();
    plot.ctx.restore();
  }
}

/** What is less, in parts of what the axis shows, is rounding of zero. */
const ROUNDING = 1e-9;

/** Four digits, as far as a person reads them. */
function shown(value: number, { min = 0, max = 0 }: uPlot.Scale = {}): string {
  const isZero = Math.abs(value) < ROUNDING * (max - min);
  return isZero ? '0' : String(Number(value.toPrecision(4)));
}

/** The border that is the most like a line of these dashes. */
function stroke([dash = 0, gap = 0]: number[] = []): 'solid' | 'dashed' | 'dotted' {
  if (gap === 0) return 'solid';
  return dash > gap ? 'dashed' : 'dotted';
}
