// The arm on the Pico's pins, as its motors turn it: from the edges alone.
import { type ArmPose, armPose, type Point } from '../shared/arm';
import type { FromSwitches } from './messages';

/** Of the arm of the Pico's firmware: the page's tests hold it against what that says of itself. */
export const LINKS_MM = [132, 132] as const;
const RAD_PER_STEP = (2 * Math.PI) / (200 * 16 * 5);
/** Where shoulder and elbow are when their switches have just closed. */
const HOME_RAD = [-Math.PI / 2, Math.PI / 9] as const;

export class Joints {
  /** From the switches, towards positive. */
  readonly steps: FromSwitches;
  #levels = 0;

  constructor(fromSwitches: FromSwitches) {
    this.steps = [...fromSwitches];
  }

  /** The levels of STEP and DIR of both, from an edge on. Says whether one of them has turned. */
  drive(levels: number): boolean {
    const risen = levels & ~this.#levels & 0b0101;
    this.#levels = levels;
    for (const joint of [0, 1] as const) {
      if ((risen >> (2 * joint)) & 1) this.steps[joint] += (levels >> (2 * joint + 1)) & 1 ? 1 : -1;
    }
    return risen !== 0;
  }

  get pose(): ArmPose {
    const angle = (joint: 0 | 1) => HOME_RAD[joint] + this.steps[joint] * RAD_PER_STEP;
    const joints: Point = [angle(0), angle(1)];
    return armPose(LINKS_MM, joints);
  }
}
