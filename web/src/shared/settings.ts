// A machine file as a form: each number of the TOML text is a field, its comment the explanation.
import { create, element, onClick, save, takeFiles } from './dom';
import { keep, kept } from './store';

const SECTION = /^\[{1,2}(\w+)\]{1,2}\s*(?:#\s*(.*))?$/;
const SETTING = /^(\w+)(\s*=\s*)([^#]*?)(\s*)(?:#\s*(.*))?$/;

export class SettingsForm {
  readonly #target: HTMLElement;
  readonly #changed: () => void;
  #lines: string[] = [];

  constructor(target: HTMLElement, changed: () => void) {
    this.#target = target;
    this.#changed = changed;
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

  #fill(): void {
    this.#target.replaceChildren();
    let into: HTMLElement = this.#target;
    for (const [index, line] of this.#lines.entries()) {
      const section = SECTION.exec(line);
      const setting = SETTING.exec(line);
      if (section) {
        const legend = create('legend', { textContent: section[1] ?? '' });
        into = create('fieldset', {}, legend);
        if (section[2]) into.append(create('small', { textContent: section[2] }));
        this.#target.append(into);
      } else if (setting && setting[3] !== '[') {
        // What goes on over several lines is for the file alone.
        into.append(this.#field(index, setting));
      }
    }
  }

  #field(
    index: number,
    [, key = '', equals = '', value = '', space = '', comment]: RegExpExecArray,
  ): HTMLElement {
    const isNumber = /^[-+\d.e]+$/i.test(value);
    const input = create('input', {
      type: isNumber ? 'number' : 'text',
      step: 'any',
      value,
      spellcheck: false,
    });
    input.addEventListener('input', () => {
      const after = comment === undefined ? '' : `${space}# ${comment}`;
      this.#lines[index] = `${key}${equals}${input.value}${after}`;
      this.#changed();
    });
    const label = create('label', { className: 'field' }, key.replaceAll('_', ' '), input);
    if (comment) label.append(create('small', { textContent: comment }));
    return label;
  }
}

/** The form of a page's machine, which the browser keeps under a name unless it is as shipped. */
export function machineForm(
  name: string,
  shipped: string,
  changed: () => void,
  file = 'machine.toml',
): SettingsForm {
  const target = element('settings', HTMLElement);
  const form = new SettingsForm(target, () => {
    keep(name, form.text === shipped ? null : form.text);
    changed();
  });
  form.text = kept(name) ?? shipped;
  const chosen = element('machine-file', HTMLInputElement);
  takeFiles(target, chosen, async (given) => form.replace(await given.text()));
  onClick('default-machine', () => form.replace(shipped));
  onClick('save-machine', () => save(file, form.text));
  return form;
}
