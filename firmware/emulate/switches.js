// Home switches that close where they are, and the axes that move with the step pins.

/** Changes of a contact while it bounces. */
const BOUNCES = 6;

export class Switches {
  #levels = 0;
  /** When the contact of each axis has changed last, in cycles. */
  #changed;
  /** Whether an axis has been on the negative side at first: its switch is closed on the other. */
  #isAbove;

  /**
   * @param {number[]} fromSwitches steps of each axis from where its switch closes
   * @param {number} bounceCycles how long a contact bounces
   */
  constructor(fromSwitches, bounceCycles = 0) {
    this.fromSwitches = [...fromSwitches];
    this.bounceCycles = bounceCycles;
    this.#changed = fromSwitches.map(() => -Infinity);
    this.#isAbove = fromSwitches.map((steps) => steps < 0);
  }

  #isReached(axis) {
    const steps = this.fromSwitches[axis];
    return this.#isAbove[axis] ? steps >= 0 : steps <= 0;
  }

  /** Levels of STEP and DIR of the first axis, of the second and so on, from a cycle on. */
  drive(levels, cycle) {
    const risen = levels & ~this.#levels;
    this.#levels = levels;
    this.fromSwitches.forEach((_, axis) => {
      if ((risen >> (2 * axis)) & 1) {
        const wasReached = this.#isReached(axis);
        this.fromSwitches[axis] += (levels >> (2 * axis + 1)) & 1 ? 1 : -1;
        if (this.#isReached(axis) !== wasReached) {
          this.#changed[axis] = cycle;
        }
      }
    });
  }

  isClosed(axis, cycle) {
    const since = cycle - this.#changed[axis];
    const bounce = since < this.bounceCycles ? Math.floor((since * BOUNCES) / this.bounceCycles) : 0;
    return this.#isReached(axis) !== (bounce % 2 === 1);
  }
}
