// What the robot did with a score, ready to be asked for any time.
import type { Answer } from '../shared/machine';

/** The JSON of the operation; the report is that of the command line. */
export interface Result {
  summary: string;
  isAsAsked: boolean;
  motors: { name: string; halfStepDeg: number }[];
  report: {
    law: string;
    duration_s: number;
    frames: number;
    bytes_packed: number;
    code_bytes: number;
    fits_at89c52: boolean;
    other_law: { law: string };
  };
}

/** Bytes of a frame. */
const MOTORS = 8;

/** The motors of the robot, in the order of their latches. */
export const MOTOR = {
  leftArm: 0,
  leftElbow: 1,
  rightArm: 2,
  rightElbow: 3,
  waist: 4,
  head: 5,
  leftWheel: 6,
  rightWheel: 7,
} as const;
export type MotorName = keyof typeof MOTOR;

export class Dance {
  readonly result: Result;
  readonly frameS: number;
  readonly frames: number;
  readonly #positions: Int32Array;
  readonly #other: Int32Array;

  constructor({ value, blobs }: Answer<Result>) {
    this.result = value;
    this.frames = value.report.frames;
    this.frameS = value.report.duration_s / this.frames;
    this.#positions = new Int32Array(blobs.positions ?? new ArrayBuffer(0));
    this.#other = new Int32Array(blobs.other ?? new ArrayBuffer(0));
  }

  /** Degrees of a motor from its start, evenly within a frame. */
  angle(motor: number, frame: number): number {
    return this.#angle(this.#positions, motor, frame);
  }

  /** The same frames under the law to compare with. */
  otherAngle(motor: number, frame: number): number {
    return this.#angle(this.#other, motor, frame);
  }

  #angle(positions: Int32Array, motor: number, frame: number): number {
    const at = (whole: number) => positions[Math.min(whole, this.frames) * MOTORS + motor] ?? 0;
    const before = Math.floor(frame);
    const steps = at(before) + (at(before + 1) - at(before)) * (frame - before);
    return steps * (this.result.motors[motor]?.halfStepDeg ?? 0);
  }
}
