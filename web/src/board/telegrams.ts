// What boards answer: firmware/machine/README.md.

/** What an answer is. */
export type Answer =
  /** A motion has begun, and takes so long. */
  | { kind: 'begun'; seconds: number }
  /** It has ended, or rests on its path; the tool is there, in mm. */
  | { kind: 'done' | 'held' | 'stopped' | 'place'; place: number[] }
  | { kind: 'refused' | 'failed' | 'other' };

/** The answer to a command, or what comes at the end of a motion. */
export function parseAnswer(text: string): Answer {
  const begun = /^ok,.* in (\d+(?:\.\d+)?) s/.exec(text);
  if (begun) return { kind: 'begun', seconds: Number(begun[1]) };
  const place = parsePlace(text);
  const ended = /^(done|held|stopped),/.exec(text)?.[1] as 'done' | 'held' | 'stopped' | undefined;
  if (place) return { kind: ended ?? 'place', place };
  if (/^failed/.test(text)) return { kind: 'failed' };
  return { kind: /^(refused|column)/.test(text) ? 'refused' : 'other' };
}

/** The tool's place in an answer. */
function parsePlace(text: string): number[] | undefined {
  const found = /^(?:\w+, )?x (-?[\d.]+) y (-?[\d.]+)(?: z (-?[\d.]+))? mm\b/.exec(text);
  return found?.slice(1).flatMap((it) => (it === undefined ? [] : [Number(it)]));
}
