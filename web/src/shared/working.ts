// A machine at work: how far it is, and a button that ends it or begins it again.
import { element, onClick } from './dom';
import type { Machine, Progress } from './machine';
import type { Status } from './result';

/** What is done sooner is not worth a bar. */
const SOON_MS = 300;

export class Working {
  readonly #bar = element('progress', HTMLProgressElement);
  readonly #line = element('working', HTMLElement);
  readonly #button = element('stop', HTMLButtonElement);
  readonly #status: Status;
  readonly #stages: readonly string[];
  #isStopped = false;
  #soon = 0;

  /** `run` begins what was stopped anew. */
  constructor(machine: Machine, status: Status, stages: readonly string[], run: () => void) {
    this.#status = status;
    this.#stages = stages;
    onClick('stop', () => {
      if (this.#isStopped) {
        run();
        return;
      }
      machine.stop();
      this.end();
      this.#isStopped = true;
      this.#line.hidden = false;
      this.#button.textContent = 'Run it again';
      this.#bar.hidden = true;
      status.say('Stopped');
    });
  }

  /** What the machine tells from now on. */
  begin(): Progress {
    clearTimeout(this.#soon);
    this.#isStopped = false;
    this.#button.textContent = 'Stop';
    this.#bar.hidden = false;
    this.#bar.removeAttribute('value');
    this.#status.say(this.#stages[0] ?? '');
    this.#soon = window.setTimeout(() => (this.#line.hidden = false), SOON_MS);
    return (stage, fraction) => {
      this.#bar.value = (stage + fraction) / this.#stages.length;
      this.#status.say(`${this.#stages[stage] ?? ''}: ${Math.floor(100 * fraction)} %`);
    };
  }

  /** The machine has answered. */
  end(): void {
    clearTimeout(this.#soon);
    this.#line.hidden = true;
  }
}
