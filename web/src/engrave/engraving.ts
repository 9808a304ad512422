// What the machine made of a drawing, ready to be asked for any time.
import { type ArmPose, armPose, type Point } from '../shared/arm';
import { Limits } from '../shared/limits';
import { torqueLimits } from '../shared/load';
import type { Answer } from '../shared/machine';
import { columns, countUntil, numbers } from '../shared/rows';

export const AXES = ['elbow', 'shoulder', 'disc', 'vertical'] as const;
export type Axis = (typeof AXES)[number];
type Joints = Record<'elbow' | 'shoulder' | 'disc', number>;

/** The JSON of the operation; the report is that of the command line. */
export interface Result {
  summary: string;
  isWithinBound: boolean;
  /** What timed strokes may have of shoulder, elbow and disc, in rad/s and rad/s². */
  axesMay: [number, number][];
  report: {
    notes: string[];
    duration_s: number;
    bound_mm: number;
    /** Where timed motion was asked for. */
    timed?: { duration_s: number; bound_mm: number };
    machine: {
      upper_mm: number;
      fore_mm: number;
      rad_per_pulse: Joints;
      home_rad: Joints;
      settings: { bed: { x_mm: number; y_mm: number; width_mm: number; height_mm: number } };
    };
  };
}

/** The step pin of an axis: edges in seconds, low to high first, and where the motor is after each. */
export interface Pin {
  edges: Float64Array;
  /** Of each pulse. */
  steps: Int8Array;
  /** Before the first pulse, and after each. */
  positions: Int32Array;
}

/** The arm, and which way its disc stands. */
export interface Pose extends ArmPose {
  disc: number;
}

/** Seconds, x, y and height of each point of the path. */
export const PATH_STRIDE = 4;

export class Engraving {
  readonly result: Result;
  readonly blobs: Answer<Result>['blobs'];
  /** What limits timed strokes. */
  readonly limits: Limits;
  readonly pins: Record<Axis, Pin>;
  /** x and y of the drawing's lines, in mm; no number between two lines. */
  readonly outlines: Float64Array;
  readonly path: Float64Array;
  /** Seconds, and the largest distance around them in mm, if the tool is in the glass. */
  readonly deviation: [number[], (number | null)[]];

  constructor({ value, blobs }: Answer<Result>) {
    this.result = value;
    this.blobs = blobs;
    const names = ['the shoulder', 'the elbow', 'the disc'];
    const joints = (name: string, of: 0 | 1, unit: string) =>
      names.map((joint, index) => ({
        name: `${name} of ${joint}`,
        limit: value.axesMay[index]?.[of] ?? 0,
        unit,
      }));
    this.limits = new Limits(blobs, [
      ...joints('speed', 0, 'rad/s'),
      ...joints('acceleration', 1, 'rad/s²'),
      ...torqueLimits(blobs, names),
    ]);
    const pin = (axis: Axis) => [
      axis,
      makePin(numbers(blobs, `${axis} edges`), blobs[`${axis} steps`]),
    ];
    this.pins = Object.fromEntries(AXES.map(pin)) as Record<Axis, Pin>;
    this.outlines = numbers(blobs, 'outlines');
    this.path = numbers(blobs, 'path');
    const [seconds = [], mm = []] = columns(numbers(blobs, 'deviation'), 2);
    this.deviation = [seconds as number[], mm];
  }

  /** Of the controller that was asked for. */
  get shown(): { duration_s: number; bound_mm: number } {
    return this.result.report.timed ?? this.result.report;
  }

  /** Steps of a motor from home at a time. */
  position(axis: Axis, seconds: number): number {
    const { edges, positions } = this.pins[axis];
    const pulses = Math.ceil(countUntil(edges, seconds) / 2);
    return positions[pulses] ?? 0;
  }

  pose(seconds: number): Pose {
    const { upper_mm, fore_mm, home_rad, rad_per_pulse } = this.result.report.machine;
    const angle = (axis: keyof Joints) =>
      home_rad[axis] + this.position(axis, seconds) * rad_per_pulse[axis];
    const joints: Point = [angle('shoulder'), angle('elbow')];
    const disc = joints[0] + joints[1] + angle('disc');
    return { ...armPose([upper_mm, fore_mm], joints), disc };
  }

  /** The distance of the tool from the drawing around a time, in mm. */
  deviationAt(seconds: number): number {
    const [times, distances] = this.deviation;
    const part = (times[1] ?? 1) - (times[0] ?? 0);
    const index = Math.min(
      Math.max(Math.floor((seconds - (times[0] ?? 0)) / part + 0.5), 0),
      times.length - 1,
    );
    return distances[index] ?? 0;
  }
}

function makePin(edges: Float64Array, steps: ArrayBuffer | undefined): Pin {
  const by = new Int8Array(steps ?? new ArrayBuffer(0));
  const positions = new Int32Array(by.length + 1);
  for (const [index, step] of by.entries()) positions[index + 1] = (positions[index] ?? 0) + step;
  return { edges, steps: by, positions };
}
