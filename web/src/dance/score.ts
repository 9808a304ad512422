// A score as the editor holds it, and its text.

/** As in the TOML file. */
export interface Move {
  motor: string;
  at_s: number;
  for_s: number;
  speed?: number;
  to_deg?: number;
  turn_deg?: number;
  easing?: string;
  repeat?: number;
  every_s?: number;
}

export interface Score {
  title?: string;
  tick_us?: number;
  frame_ticks?: number;
  threshold?: number;
  length_s?: number;
  motor: { name: string; half_step_deg: number; max_speed?: number }[];
  move?: Move[];
}

const ACTIONS = ['to_deg', 'turn_deg', 'speed'] as const;
export type Action = (typeof ACTIONS)[number];

export function actionOf(move: Move): Action {
  return ACTIONS.find((it) => move[it] !== undefined) ?? 'to_deg';
}

/** Length of a frame, in s. */
export function frameOf(score: Score): number {
  return ((score.tick_us ?? 1000) * (score.frame_ticks ?? 200)) / 1e6;
}

/** A time in whole frames, without the digits that binary rounding adds. */
export function snap(score: Score, seconds: number, least = 0): number {
  const frame = frameOf(score);
  return Number((Math.max(Math.round(seconds / frame), least) * frame).toFixed(9));
}

/** The starts of a move and its repetitions. */
export function starts(move: Move): number[] {
  const times = Math.min(move.repeat ?? 1, 65_535);
  return Array.from({ length: times }, (_, time) => move.at_s + time * (move.every_s ?? 0));
}

/** When the span begins in which the most is moved. */
export function liveliest(score: Score, lengthS: number, spanS: number): number {
  /** How many moves there are in each second. */
  const moved = new Float64Array(Math.ceil(lengthS) + 1);
  for (const move of score.move ?? []) {
    for (const at of starts(move)) {
      const end = Math.min(at + move.for_s, lengthS);
      for (let second = Math.floor(at); second < end; second += 1) {
        moved[second] = (moved[second] ?? 0) + 1;
      }
    }
  }
  let [sum, most, begin] = [0, 0, 0];
  for (const [second, count] of moved.entries()) {
    sum += count - (moved[second - spanS] ?? 0);
    const from = Math.max(second - spanS + 1, 0);
    if (sum > most) [most, begin] = [sum, from];
  }
  return begin;
}

/** What a move does, for people. */
export function describe(move: Move): string {
  const action = actionOf(move);
  const value = move[action] ?? 0;
  return { to_deg: `to ${value}°`, turn_deg: `by ${value}°`, speed: `speed ${value}` }[action];
}

function assignments(values: object): string[] {
  const given = Object.entries(values).filter(
    ([, value]) => typeof value === 'string' || typeof value === 'number',
  );
  // Strings of JSON are strings of TOML.
  return given.map(([key, value]) => `${key} = ${JSON.stringify(value)}`);
}

/** The score in TOML, each move on a line. */
export function toText(score: Score): string {
  const rows = (values: object[]) =>
    values.map((it) => `    { ${assignments(it).join(', ')} },\n`).join('');
  const head = assignments(score).map((it) => `${it}\n`);
  return `${head.join('')}\nmotor = [\n${rows(score.motor)}]\n\nmove = [\n${rows(score.move ?? [])}]\n`;
}
