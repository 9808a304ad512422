// Faults to learn from: what each changes of two stations that work.

export interface Scenario {
  name: string;
  label: string;
  /** Fields of the stations, as `B parity`. */
  fields?: Record<string, string | boolean>;
  isOneWire?: boolean;
}

export const SCENARIOS: Scenario[] = [
  { name: 'none', label: 'nothing is wrong' },
  { name: 'parity', label: 'B without parity', fields: { 'B parity': 'none' } },
  { name: 'baud', label: 'B at 4800 bit/s', fields: { 'B baud': '4800' } },
  { name: 'open', label: 'wire from A to B open', fields: { 'B is_deaf': true } },
  {
    name: 'both-open',
    label: 'both wires open',
    fields: { 'A is_deaf': true, 'B is_deaf': true },
  },
  { name: 'off', label: 'B is off', fields: { 'B is_dead': true } },
  { name: 'both-high', label: 'both have high priority', fields: { 'B priority': 'high' } },
  { name: 'both-low', label: 'both have low priority', fields: { 'A priority': 'low' } },
  { name: 'echo', label: 'two-wire line with echo', isOneWire: true },
  { name: 'own-echo', label: 'A hears itself', fields: { 'A hears_itself': true } },
  { name: 'noise', label: 'noise on the wire from B', fields: { 'B bit_errors': '30' } },
  { name: 'late', label: 'B answers late', fields: { 'B delay_ms': '2500' } },
  { name: 'pause', label: 'B pauses in its blocks', fields: { 'B pause_ms': '400' } },
  { name: 'no-bcc', label: 'B speaks 3964 without BCC', fields: { 'B preset': 'siemens-3964' } },
  { name: 'bcc', label: 'B computes another BCC', fields: { 'B bcc': 'with-stx' } },
  {
    name: 'buffer',
    label: 'nobody fetches what B receives',
    fields: { 'B keeps_telegrams': true },
  },
];
