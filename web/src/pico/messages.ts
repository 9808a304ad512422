// What the page and the Pico's worker tell each other.

/** STEP and DIR of the shoulder, then of the elbow, in bits 0 to 3 of the levels. */
export const PINS = ['GP2', 'GP3', 'GP4', 'GP5'] as const;

/** Steps of shoulder and elbow from where their home switches close. */
export type FromSwitches = [number, number];

export type Order =
  | { program: ArrayBuffer; fromSwitches: FromSwitches }
  /** On the line to the Pico, as soon as those before have left. */
  | { bytes: Uint8Array }
  /** The supply fails and comes back. */
  | 'power';

/** What has happened since the last notice. */
export interface Notice {
  /** The processor's cycles since it was switched on for the first time. */
  cycle: number;
  /** When pins have changed, in cycles, and the levels from then on. */
  edges: Float64Array;
  levels: Uint8Array;
  /** What the Pico has sent, each when its stop bit had ended. */
  sent: Uint8Array;
}

export type Told = { hz: number } | Notice | { error: string };
