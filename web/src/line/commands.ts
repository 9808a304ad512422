// What the machine's firmware understands: a word and its numbers as the text of a telegram.

export interface Command {
  name: string;
  /** What it does. */
  about: string;
  /** Its words after the name, with a first value; an optional one may be empty. */
  words: { label: string; value: string; placeholder?: string; choices?: string[] }[];
}

/** From the home switches the arm turns before it has room for a line. */
export const COMMANDS: Command[] = [
  { name: 'home', about: 'finds both home switches', words: [] },
  {
    name: 'jog',
    about: 'turns one joint',
    words: [
      { label: 'Joint', value: 'shoulder', choices: ['shoulder', 'elbow'] },
      { label: 'Degrees', value: '60' },
    ],
  },
  {
    name: 'line',
    about: 'moves the tool along a straight line',
    words: [
      { label: 'X in mm', value: '150' },
      { label: 'Y in mm', value: '100' },
      { label: 'Feed, mm/s', value: '', placeholder: 'fastest' },
    ],
  },
  { name: 'hold', about: 'comes to rest on the path', words: [] },
  { name: 'resume', about: 'goes on', words: [] },
  { name: 'stop', about: 'comes to rest and gives up the rest of the path', words: [] },
  { name: 'feed', about: 'sets the speed', words: [{ label: 'Percent', value: '100' }] },
  { name: 'where', about: 'tells tool, joints and steps', words: [] },
  { name: 'status', about: 'tells what the machine does', words: [] },
  { name: 'limits', about: 'tells where it can go, and how fast', words: [] },
];
