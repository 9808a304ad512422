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

/** How many numbers of an ascending list are at most a value. */
export function countUntil(list: Float64Array, value: number, stride = 1): number {
  let [low, high] = [0, list.length / stride];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((list[middle * stride] ?? Number.POSITIVE_INFINITY) <= value) low = middle + 1;
    else high = middle;
  }
  return low;
}
