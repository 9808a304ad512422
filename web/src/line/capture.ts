// A capture that is pasted, dropped or chosen, judged as `line3964r monitor` judges it.
import { element, settled, takeFiles } from '../shared/dom';
import { AddressFields } from '../shared/fields';
import {
  fromAddress,
  intoLink,
  isLinked,
  keep,
  kept,
  textFromLink,
  toAddress,
  Trial,
} from '../shared/store';
import { Conversation, type News } from './conversation';
import type { Desk, View } from './desk';

/** Captures of lines with known faults, loaded when they are chosen. */
const EXAMPLES = Object.fromEntries(
  Object.entries(
    import.meta.glob<string>('../../../crates/monitor3964r/tests/data/captures/*.txt', {
      query: '?raw',
      import: 'default',
    }),
  ).map(([path, load]) => [path.slice(path.lastIndexOf('/') + 1, -'.txt'.length), load]),
);
const FIRST = '01a_parity_B_8N1';
const KEPT = 'line capture';

export class Capture implements View {
  readonly of = 'capture';
  readonly follows = false;
  readonly idle = 'No capture yet';
  conversation = new Conversation();
  readonly #desk: Desk;
  readonly #text = element('capture', HTMLTextAreaElement);
  readonly #example = element('example', HTMLSelectElement);
  readonly #preset = element('preset', HTMLSelectElement);
  readonly #fields: AddressFields;
  #name = 'capture.txt';
  /** Of the newest input; what is still under way for older ones is dropped. */
  #input = 0;
  readonly #trial = new Trial(KEPT);

  constructor(desk: Desk) {
    this.#desk = desk;
    for (const name of Object.keys(EXAMPLES).sort()) {
      this.#example.add(new Option(name.replaceAll('_', ' '), name));
    }
    this.#fields = new AddressFields({ preset: this.#preset }, () => this.#judge());
    const judge = settled(150, () => this.#judge());
    this.#text.addEventListener('input', () => {
      this.#supersede();
      this.#own('capture.txt');
      judge();
    });
    const isOwn = () => this.#example.value === '' && this.#text.value !== '';
    intoLink('capture', () => (isOwn() ? this.#text.value : undefined));
    intoLink('name', () => (isOwn() ? this.#name : undefined));
    this.#example.addEventListener('change', () => this.#open(this.#example.value));
    takeFiles(element('drop', HTMLElement), element('file', HTMLInputElement), (file) =>
      this.#take(file.text(), file.name),
    );
  }

  /** What was chosen or pasted last, else the first example. */
  async begin(): Promise<void> {
    const example = fromAddress('example');
    const linked = textFromLink('capture') ?? null;
    const isWanted = !isLinked || example === 'own';
    const text = linked ?? (isWanted && !this.#trial.hasFailed ? kept(KEPT) : null);
    if (example !== null && Object.hasOwn(EXAMPLES, example)) await this.#open(example);
    else if (text !== null) await this.#take(text, textFromLink('name') ?? 'capture.txt');
    else await this.#open(FIRST);
  }

  async #open(example: string): Promise<void> {
    const load = EXAMPLES[example];
    if (!load) return;
    const input = this.#supersede();
    const text = await load();
    if (input !== this.#input) return;
    this.#name = `${example}.txt`;
    this.#example.value = example;
    this.#text.value = text;
    toAddress({ example });
    keep(KEPT, null);
    await this.#judge();
  }

  async #take(given: string | Promise<string>, name: string): Promise<void> {
    const input = this.#supersede();
    const text = await given;
    if (input !== this.#input) return;
    this.#text.value = text;
    this.#own(name);
    await this.#judge();
  }

  /** What is in the field is one's own. */
  #own(name: string): void {
    this.#name = name;
    this.#example.value = '';
    toAddress({ example: 'own' });
    keep(KEPT, this.#text.value);
  }

  /** Another input is on its way; its number. */
  #supersede(): number {
    this.#desk.judging(this);
    this.#input += 1;
    return this.#input;
  }

  async #judge(): Promise<void> {
    const preset = this.#preset.value;
    const input = this.#supersede();
    await toAddress(this.#fields.values);
    if (input !== this.#input) return;
    const parameters = { name: this.#name, text: this.#text.value, preset };
    this.#trial.begin();
    try {
      const answer = await this.#desk.machine.call<News>('line', parameters);
      if (input !== this.#input) return;
      this.conversation = new Conversation();
      this.conversation.take(answer);
      this.#desk.renew(this);
    } catch (error) {
      if (input === this.#input) this.#desk.refuse(this, '', error);
    } finally {
      this.#trial.end();
    }
  }
}
