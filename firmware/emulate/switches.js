// Home switches that close where they are, and the joints that turn with the step pins.

/** Changes of a contact while it bounces. */
const BOUNCES = 6;

export class Switches {
  #levels = 0;
  /** When the contact of each joint has changed last, in cycles. */
  #changed = [-Infinity, -Infinity];

  /**
   * @param {number[]} fromSwitches steps of each joint from where its switch closes, towards positive
   * @param {number} bounceCycles how long a contact bounces
   */
  constructor(fromSwitches, bounceCycles = 0) {
    this.fromSwitches = [...fromSwitches];
    this.bounceCycles = bounceCycles;
  }

  /** Levels of STEP and DIR of both joints, bits 0 to 3, from a cycle on. */
  drive(levels, cycle) {
    const risen = levels & ~this.#levels;
    this.#levels = levels;
    for (const joint of [0, 1]) {
      if ((risen >> (2 * joint)) & 1) {
        const wasClosed = this.fromSwitches[joint] <= 0;
        this.fromSwitches[joint] += (levels >> (2 * joint + 1)) & 1 ? 1 : -1;
        if (this.fromSwitches[joint] <= 0 !== wasClosed) {
          this.#changed[joint] = cycle;
        }
      }
    }
  }

  isClosed(joint, cycle) {
    const since = cycle - this.#changed[joint];
    const bounce = since < this.bounceCycles ? Math.floor((since * BOUNCES) / this.bounceCycles) : 0;
    return (this.fromSwitches[joint] <= 0) !== (bounce % 2 === 1);
  }
}
