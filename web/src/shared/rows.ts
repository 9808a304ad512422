// Lists of numbers as a machine gives them.
import type { Answer } from './machine';

/** The numbers of a name; none if the machine gave none. */
export function numbers(blobs: Answer<unknown>['blobs'], name: string): Float64Array {
  return new Float64Array(blobs[name] ?? new ArrayBuffer(0));
}

/** Columns of rows of numbers; what is no number is null, as charts want it. */
export function columns(rows: Float64Array, width: number): (number | null)[][] {
  const value = (at: number) => (Number.isNaN(rows[at]) ? null : (rows[at] ?? null));
  return Array.from({ length: width }, (_, column) =>
    Array.from({ length: rows.length / width }, (_, row) => value(row * width + column)),
  );
}

/** How many of a list pass a test that none passes after one that does not. */
export function countWhile(length: number, passes: (index: number) => boolean): number {
  let [low, high] = [0, length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (passes(middle)) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** How many numbers of an ascending list are at most a value. */
export function countUntil(list: Float64Array, value: number, stride = 1): number {
  return countWhile(list.length / stride, (row) => (list[row * stride] ?? Infinity) <= value);
}

/** The rows around a time, and the part of the way from the one to the other. */
export function around(
  times: Float64Array,
  seconds: number,
): { before: number; after: number; part: number } {
  const after = Math.min(countUntil(times, seconds), times.length - 1);
  const before = Math.max(after - 1, 0);
  const [from, to] = [times[before] ?? 0, times[after] ?? 0];
  const part = to > from ? Math.min((seconds - from) / (to - from), 1) : 1;
  return { before, after, part };
}
