// A machine file as a form: each number of the TOML text is a field, its comment the explanation.
import { create, element, onClick, save, takeFiles } from './dom';
import { intoLink, isLinked, keep, kept, textFromLink, toAddress } from './store';

const SECTION = /^\[{1,2}(\w+)\]{1,2}\s*(?:#\s*(.*))?$/;

/** A line `key = value  # comment`, and its place: the section, which of its name it is, and the key. */
interface Setting {
  place: string;
  key: string;
  equals: string;
  value: string;
  /** From the end of the value to the comment. */
  space: string;
  comment: string | undefined;
}

/** The setting of a line, if it is one; section and number make up its place. */
function setting(line: string, section: string): Setting | undefined {
  const key = /^\w+/.exec(line)?.[0];
  if (key === undefined) return undefined;
  const equals = /^\s*=\s*/.exec(line.slice(key.length))?.[0];
  if (equals === undefined) return undefined;
  const [given = '', ...comment] = line.slice(key.length + equals.length).split('#');
  const value = given.trimEnd();
  return {
    place: `${section} ${key}`,
    key,
    equals,
    value,
    space: given.slice(value.length),
    comment: comment.length > 0 ? comment.join('#').trimStart() : undefined,
  };
}

/** The lines of a machine file, each with its section or setting. */
function* read(lines: string[]): Generator<{
  index: number;
  section?: RegExpExecArray;
  setting?: Setting;
}> {
  const times = new Map<string, number>();
  let place = '';
  for (const [index, line] of lines.entries()) {
    const section = SECTION.exec(line);
    if (section) {
      const name = section[1] ?? '';
      times.set(name, (times.get(name) ?? 0) + 1);
      place = `${name} ${times.get(name)}`;
      yield { index, section };
    } else {
      const found = setting(line, place);
      // What goes on over several lines is for the file alone.
      if (found && found.value !== '[') yield { index, setting: found };
    }
  }
}

export class SettingsForm {
  readonly #target: HTMLElement;
  readonly #changed: () => void;
  /** The values as shipped, by their places. */
  readonly #shipped: Map<string, string>;
  #lines: string[] = [];

  constructor(target: HTMLElement, shipped: string, changed: () => void) {
    this.#target = target;
    this.#changed = changed;
    const settings = [...read(shipped.split('\n'))].flatMap((it) => it.setting ?? []);
    this.#shipped = new Map(settings.map((it) => [it.place, it.value]));
  }

  get text(): string {
    return this.#lines.join('\n');
  }

  set text(text: string) {
    this.#lines = text.split('\n');
    this.#fill();
  }

  /** Another file, by hand. */
  replace(text: string): void {
    this.text = text;
    this.#changed();
  }

  /** How many fields differ from the machine that is shipped. */
  get differences(): number {
    return this.#target.querySelectorAll('.changed').length;
  }

  #fill(): void {
    this.#target.replaceChildren();
    let into: HTMLElement = this.#target;
    for (const { index, section, setting } of read(this.#lines)) {
      if (section) {
        const legend = create('legend', { textContent: section[1] ?? '' });
        into = create('fieldset', {}, legend);
        if (section[2]) into.append(create('small', { textContent: section[2] }));
        this.#target.append(into);
      } else if (setting) {
        into.append(this.#field(index, setting));
      }
    }
  }

  #field(index: number, { place, key, equals, value, space, comment }: Setting): HTMLElement {
    const isNumber = /^[-+\d.e]+$/i.test(value);
    const input = create('input', {
      type: isNumber ? 'number' : 'text',
      step: 'any',
      value,
      spellcheck: false,
    });
    const label = create('label', { className: 'field' }, key.replaceAll('_', ' '), input);
    if (comment) label.append(create('small', { textContent: comment }));
    const shipped = this.#shipped.get(place);
    const note = create('small', {
      className: 'shipped',
      textContent: shipped === undefined ? 'not in the shipped machine' : `shipped: ${shipped}`,
    });
    label.append(note);
    const mark = () => {
      const isChanged = input.value !== shipped;
      label.classList.toggle('changed', isChanged);
      note.hidden = !isChanged;
    };
    mark();
    input.addEventListener('input', () => {
      const after = comment === undefined ? '' : `${space}# ${comment}`;
      this.#lines[index] = `${key}${equals}${input.value}${after}`;
      mark();
      this.#changed();
    });
    return label;
  }
}

/** A select of machine files that come with the page, by the values of its options, and of one's own. */
export class MachineChoice {
  readonly #select = element('machine-choice', HTMLSelectElement);
  readonly #files: Record<string, string>;

  constructor(files: Record<string, string>) {
    this.#files = files;
  }

  /** Tells of a file that is chosen. */
  onChosen(chosen: (text: string) => void): void {
    this.#select.addEventListener('input', () => {
      const text = this.#files[this.#select.value];
      if (text !== undefined) chosen(text);
    });
  }

  /** Which file a text is. */
  show(text: string): void {
    const found = Object.entries(this.#files).find(([, file]) => file === text);
    this.#select.value = found?.[0] ?? 'own';
  }
}

/**
 * The form of a page's machine: as the link has it; without a link as the browser has kept it under a
 * name; or as shipped.
 */
export function machineForm(
  name: string,
  shipped: string,
  changed: () => void,
  file = 'machine.toml',
  choice?: MachineChoice,
): SettingsForm {
  const target = element('settings', HTMLElement);
  const told = element('machine-changed', HTMLElement);
  const isOwn = () => form.text !== shipped;
  const tell = () => {
    const { differences } = form;
    const fields = `${differences} ${differences === 1 ? 'value differs' : 'values differ'}`;
    choice?.show(form.text);
    told.textContent = isOwn() ? `not as shipped: ${fields}` : '';
    toAddress({ machine: isOwn() ? 'own' : null });
  };
  const form = new SettingsForm(target, shipped, () => {
    keep(name, isOwn() ? form.text : null);
    tell();
    changed();
  });
  form.text = textFromLink('machine') ?? (isLinked ? shipped : (kept(name) ?? shipped));
  intoLink('machine', () => (isOwn() ? form.text : undefined));
  tell();
  const chosen = element('machine-file', HTMLInputElement);
  takeFiles(target, chosen, async (given) => form.replace(await given.text()));
  choice?.onChosen((text) => form.replace(text));
  onClick('default-machine', () => form.replace(shipped));
  onClick('save-machine', () => save(file, form.text));
  return form;
}
