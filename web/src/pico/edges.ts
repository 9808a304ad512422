// The edges of the pins, each with its cycle: the newest ones.
import { countWhile } from '../shared/rows';

/** Most edges that are kept, 9 bytes each; where there are more, the older half is forgotten. */
export const MAX_EDGES = 1 << 20;

export class Edges {
  readonly #cycles = new Float64Array(MAX_EDGES);
  readonly #levels = new Uint8Array(MAX_EDGES);
  #kept = 0;
  /** All that have come. */
  count = 0;
  /** Levels before the first edge that is kept. */
  #levelsBefore = 0;

  add(cycles: Float64Array, levels: Uint8Array): void {
    if (this.#kept + cycles.length > MAX_EDGES) this.#forget(MAX_EDGES / 2);
    this.#cycles.set(cycles, this.#kept);
    this.#levels.set(levels, this.#kept);
    this.#kept += cycles.length;
    this.count += cycles.length;
  }

  #forget(count: number): void {
    const by = Math.min(count, this.#kept);
    this.#levelsBefore = this.levelsAfter(by);
    this.#cycles.copyWithin(0, by, this.#kept);
    this.#levels.copyWithin(0, by, this.#kept);
    this.#kept -= by;
  }

  get kept(): number {
    return this.#kept;
  }

  /** When an edge was, in cycles. */
  cycle(edge: number): number {
    return this.#cycles[edge] ?? Number.NaN;
  }

  /** The levels after so many edges of those that are kept. */
  levelsAfter(edges: number): number {
    return edges === 0 ? this.#levelsBefore : (this.#levels[edges - 1] ?? 0);
  }

  /** How many of those that are kept were at a cycle or before. */
  until(cycle: number): number {
    return countWhile(this.#kept, (edge) => (this.#cycles[edge] ?? Infinity) <= cycle);
  }

  /** Steps of a joint from one edge to another: how often its STEP pin has risen. */
  rises(pin: number, from: number, to: number): number {
    let count = 0;
    for (let edge = from; edge < to; edge += 1) {
      const risen = this.levelsAfter(edge + 1) & ~this.levelsAfter(edge);
      count += (risen >> pin) & 1;
    }
    return count;
  }
}
