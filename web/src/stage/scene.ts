// The stage from above: program, path by its speed, and where both stages are at a time.
import { colour, element } from '../shared/dom';
import {
  type Bounds,
  Plane,
  scaleColour,
  scalePart,
  showScale,
  strokeLines,
  strokeParts,
} from '../shared/plane';
import type { Preview, Run, Track } from './run';

const MARGIN_MM = 3;
const RAPID = -1;

export class Scene {
  readonly #plane: Plane;
  #run: Run | undefined;
  /** Of a program that is being run. */
  #preview: Preview | undefined;
  #seconds = 0;
  /** Where a board says that it is. */
  #said: [number, number] | undefined;

  constructor(canvas: HTMLCanvasElement) {
    this.#plane = new Plane(
      canvas,
      () => {
        const switches = this.#preview?.switchesMm ?? this.#run?.result.switchesMm;
        return switches && bounds(switches);
      },
      (context, px) => this.#draw(context, px),
    );
    showScale('scale', 'speed');
  }

  preview(preview: Preview): void {
    this.#preview = preview;
    this.#plane.redraw();
  }

  show(run: Run): void {
    this.#run = run;
    this.#preview = undefined;
    element('scale-end', HTMLElement).textContent = `${run.maxFeed.toFixed(1)} mm/s`;
    element('open-key', HTMLElement).hidden = !run.isLossy;
    this.#plane.redraw();
  }

  at(seconds: number): void {
    this.#seconds = seconds;
    this.#plane.redraw();
  }

  say(place: [number, number] | undefined): void {
    this.#said = place;
    element('said-key', HTMLElement).hidden = place === undefined;
    this.#plane.redraw();
  }

  #draw(context: CanvasRenderingContext2D, px: number): void {
    const run = this.#run;
    const shown = this.#preview ?? (run && { ...run.result, programmed: run.programmed });
    if (!shown) return;
    const [[x0, x1], [y0, y1]] = shown.switchesMm;
    context.strokeStyle = colour('limit');
    context.lineWidth = px;
    context.setLineDash([6 * px, 4 * px]);
    context.strokeRect(x0, y0, x1 - x0, y1 - y0);
    context.setLineDash([]);
    context.strokeStyle = colour('drawing');
    context.globalAlpha = 0.5;
    context.lineWidth = 6 * px;
    strokeLines(context, shown.programmed, px);
    context.globalAlpha = 1;
    if (!run || this.#preview) return;
    if (run.isLossy) {
      drawTrack(context, run.open, run, this.#seconds, px, () => 0, [colour('series-3')]);
    }
    drawClosed(context, run, this.#seconds, px);
    if (run.isLossy) drawMark(context, run.open.at(this.#seconds), 'series-3', px);
    drawMark(context, run.closed.at(this.#seconds), 'now', px);
    if (this.#said) drawMark(context, this.#said, 'series-2', px);
  }
}

function bounds([[left, right], [low, high]]: Run['result']['switchesMm']): Bounds {
  return {
    left: left - MARGIN_MM,
    right: right + MARGIN_MM,
    low: low - MARGIN_MM,
    high: high + MARGIN_MM,
  };
}

function drawClosed(context: CanvasRenderingContext2D, run: Run, until: number, px: number): void {
  const max = run.maxFeed;
  const part = (point: number) => {
    const seconds = run.closed.times[point] ?? 0;
    return scalePart(run.speedAt(seconds) / max);
  };
  drawTrack(context, run.closed, run, until, px, part);
}

/** Rapid stretches thin and dashed, the others by their part of the scale, or in one colour. */
function drawTrack(
  context: CanvasRenderingContext2D,
  track: Track,
  run: Run,
  until: number,
  px: number,
  part: (point: number) => number,
  colours?: string[],
): void {
  strokeParts(
    context,
    track.passed(until),
    px,
    (point) => track.point(point),
    (point) => (run.leg(track.leg(point))?.isRapid ? RAPID : part(point)),
    (shown) => {
      const isRapid = shown === RAPID;
      context.setLineDash(isRapid ? [4 * px, 3 * px] : []);
      context.strokeStyle = isRapid
        ? colour('quiet')
        : (colours?.[shown] ?? scaleColour('speed', shown));
      context.lineWidth = (isRapid ? 1 : 2) * px;
    },
  );
  context.setLineDash([]);
}

/** Cross hairs where a stage is. */
function drawMark(
  context: CanvasRenderingContext2D,
  [x, y]: [number, number],
  name: string,
  px: number,
): void {
  context.strokeStyle = colour(name);
  context.lineWidth = 2 * px;
  context.beginPath();
  context.arc(x, y, 6 * px, 0, 2 * Math.PI);
  for (const [dx, dy] of [
    [1, 0],
    [0, 1],
  ] as const) {
    context.moveTo(x - 11 * dx * px, y - 11 * dy * px);
    context.lineTo(x + 11 * dx * px, y + 11 * dy * px);
  }
  context.stroke();
}
