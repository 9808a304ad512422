// What a machine says of a run, and the files that it leaves.
import { create, element, save } from './dom';
import { type Machine, Superseded } from './machine';
import { damage } from './store';

/** Of what is told; a refusal may quote a line of any length. */
const MAX_TOLD = 2000;

/** The line that tells how it went, read aloud as it changes. */
export class Status {
  readonly #line = element('status', HTMLElement);

  say(text: string, isBad = false): void {
    this.#line.textContent = text.length > MAX_TOLD ? `${text.slice(0, MAX_TOLD)} …` : text;
    this.#line.classList.toggle('bad', isBad);
  }

  /** How it went, and what is worth a note. */
  tell(verdict: string, notes: string[], isBad = false): void {
    const all = damage === undefined ? notes : [damage, ...notes];
    this.say([verdict, ...all.map((note) => `note: ${note}`)].join('\n'), isBad);
  }

  /** As a command line says it: where, and what is wrong. */
  refuse(where: string, error: unknown): void {
    const what = error instanceof Error ? error.message : String(error);
    this.say(where === '' ? what : `${where}: ${what}`, true);
  }
}

/** A button for each file, which asks the machine for it. */
export class FileButtons {
  readonly #buttons: HTMLButtonElement[];

  /** The operation's parameters are the name alone, unless it is told otherwise. */
  constructor(
    machine: Machine,
    operation: string,
    names: string[],
    status: Status,
    parameters: (name: string) => unknown = (name) => name,
  ) {
    this.#buttons = names.map((name) => {
      const button = create('button', { type: 'button', textContent: name, disabled: true });
      button.addEventListener('click', async () => {
        try {
          const { blobs } = await machine.call(operation, parameters(name));
          if (blobs.file) save(name, blobs.file);
        } catch (error) {
          // A newer input has made the file useless.
          if (!(error instanceof Superseded)) status.refuse(name, error);
        }
      });
      return button;
    });
    element('files', HTMLElement).append(...this.#buttons);
  }

  /** Not while they are of an input that has changed, nor those that are missing. */
  allow(isAllowed: boolean, missing: string[] = []): void {
    for (const button of this.#buttons) {
      button.disabled = !isAllowed || missing.includes(button.textContent);
    }
  }
}
