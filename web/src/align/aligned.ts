// What came of an alignment, ready to be asked for any time.
import { countWhile } from '../shared/rows';
import type { Point3 } from '../shared/space';

export type Pose = [number, number, number, number, number, number];

/** The locators and the body at a time, in mm, mm/s and s. */
export interface Moment {
  s: number;
  locators: Point3[];
  /** Along the three axes of each locator. */
  speeds: Point3[];
  /** By how much the distance of two locators departs, at most. */
  error: number;
  outline: Point3[];
}

/** The JSON of the operation; the report is that of the command line. */
export interface Result {
  summary: string;
  isWithinBounds: boolean;
  note: string | null;
  from: Pose;
  to: Pose;
  moments: Moment[];
  report: {
    duration_s: number;
    max_distance_error_mm: number;
    distance_error_bound_mm: number;
    max_speed_ratio: number;
    points: number;
  };
}

/** The moment at a time, or the last one before. */
export function momentAt(moments: Moment[], seconds: number): Moment | undefined {
  const passed = countWhile(moments.length, (at) => (moments[at]?.s ?? Infinity) <= seconds);
  return moments[Math.max(passed - 1, 0)];
}
