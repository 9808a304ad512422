// Where every view shows what it hears: verdict, both directions over time, ladder, files.
import { element } from '../shared/dom';
import type { Machine } from '../shared/machine';
import { FileButtons, type Status } from '../shared/result';
import type { Conversation } from './conversation';
import { Ladder } from './ladder';
import { Wire } from './wire';

/** Whose conversation it is, as the machine calls it. */
export type Of = 'capture' | 'simulation' | 'station' | 'tap';

export interface View {
  readonly of: Of;
  readonly conversation: Conversation;
  /** Whether the end is of interest, not the begin. */
  readonly follows: boolean;
  /** What to say while there is no verdict. */
  readonly idle: string;
}

const FILES = ['capture.txt', 'conversation.txt', 'verdict.json'];

export class Desk {
  readonly machine: Machine;
  readonly status: Status;
  readonly #files: FileButtons;
  readonly #wire: Wire;
  readonly #ladder: Ladder;
  #view: View | undefined;
  #said = '';
  /** A refusal stays until something else is asked for. */
  #isRefused = false;

  constructor(machine: Machine, status: Status) {
    this.machine = machine;
    this.status = status;
    const files = (name: string) => ({ of: this.#view?.of ?? 'capture', name });
    this.#files = new FileButtons(machine, 'line.file', FILES, status, files);
    this.#wire = new Wire(element('wire', HTMLCanvasElement), element('wire-note', HTMLElement));
    this.#ladder = new Ladder(element('ladder', HTMLElement), (at) => this.#wire.at(at));
  }

  /** Shows what a view hears. */
  show(view: View): void {
    this.#view = view;
    this.#renewStatus();
    this.#wire.show(view.conversation, view.follows);
    this.#ladder.show(view.conversation, view.follows);
    this.#tell();
  }

  shows(view: View): boolean {
    return view === this.#view;
  }

  /** A view will have another conversation. */
  judging(view: View): void {
    if (view !== this.#view) return;
    this.#renewStatus();
    this.status.say('Judging');
    this.#files.allow(false);
  }

  /** A view has another conversation. */
  renew(view: View): void {
    if (view === this.#view) this.show(view);
  }

  /** A view has heard more, or was told a verdict. */
  update(view: View): void {
    if (view !== this.#view) return;
    this.#wire.update();
    this.#ladder.update();
    this.#tell();
  }

  /** What a view is refused; the others do not care. */
  refuse(view: View, where: string, error: unknown): void {
    if (view !== this.#view) return;
    this.#isRefused = true;
    this.status.refuse(where, error);
  }

  /** A view is asked for something else: what it was refused has been read. */
  goOn(view: View): void {
    if (view === this.#view && this.#isRefused) this.#renewStatus();
  }

  #renewStatus(): void {
    this.#said = '';
    this.#isRefused = false;
  }

  #tell(): void {
    const { conversation, idle } = this.#view ?? {};
    const { verdict } = conversation ?? {};
    const sentence = verdict?.sentence ?? idle ?? '';
    // Read aloud: only when it is another one.
    if (sentence !== this.#said && !this.#isRefused) {
      this.status.say(sentence, verdict?.kind === 'fault');
      this.#said = sentence;
    }
    element('summary', HTMLElement).textContent = verdict ? `verdict: ${verdict.text}` : '';
    this.#files.allow((conversation?.steps.length ?? 0) > 0);
  }
}
