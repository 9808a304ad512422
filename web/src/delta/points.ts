// The points of an input's lines, and the lines again when a point is dragged.
import type { Point3 } from '../shared/space';

/** A digit can be read in one way alone, so that a line of any length takes a time in proportion to it. */
const NUMBER = String.raw`([-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?)`;
const MOVE = new RegExp(String.raw`^(\s*)${NUMBER}(\s+)${NUMBER}(\s+)${NUMBER}(?=\s|#|$)`);

/** A line counted from 1, and the point that it goes to. */
export interface Waypoint {
  line: number;
  point: Point3;
}

/** What can be read of it; the machine says what cannot. */
export function waypoints(text: string): Waypoint[] {
  return text.split('\n').flatMap((line, index) => {
    const found = MOVE.exec(line);
    if (!found) return [];
    return [{ line: index + 1, point: [found[2], found[4], found[6]].map(Number) as Point3 }];
  });
}

/** The text with another point in a line, to tenths of a millimetre; what follows it stays. */
export function moved(text: string, { line, point }: Waypoint): string {
  const lines = text.split('\n');
  const [x, y, z] = point.map((it) => String(Math.round(it * 10) / 10));
  lines[line - 1] = (lines[line - 1] ?? '').replace(MOVE, `$1${x}$3${y}$5${z}`);
  return lines.join('\n');
}
