// A station, or a tap with two ports, on real ports.
import { create, element, onClick } from '../shared/dom';
import { AddressFields } from '../shared/fields';
import { toAddress } from '../shared/store';
import { COMMANDS, type Command } from './commands';
import { Conversation, type News } from './conversation';
import type { Desk, Of, View } from './desk';
import { tell } from './events';
import { type Damage, NoPortChosen, OpenPort, serial } from './port';
import { readTelegram, type Telegram } from './station-panel';

interface Pulled extends News {
  transmit: number[];
  events: { text: string; isGood: boolean; telegram: number[] | null }[];
  activity: string;
  isBusy: boolean;
  deadlineS: number | null;
}

/** How often the verdict on the last minute is asked for. */
const JUDGE_MS = 500;
const EVENTS = 50;
/** What is set of a port, by the ids of its fields, which are the names in the address too. */
const SETTINGS = ['role', 'port-preset', 'priority', 'baud', 'parity'] as const;
type Setting = (typeof SETTINGS)[number];

export class Live implements View {
  readonly follows = true;
  readonly idle = serial
    ? 'No port is open'
    : 'This browser has no Web Serial: Chrome, Edge and Opera have it';
  conversation = new Conversation();
  readonly #desk: Desk;
  #ports: OpenPort[] = [];
  #beganMs = 0;
  #deadline = 0;
  #judge = 0;
  #waiting: Telegram[] = [];
  #isBusy = false;

  constructor(desk: Desk) {
    this.#desk = desk;
    const fields = Object.fromEntries(SETTINGS.map((id) => [id, this.#field(id)]));
    const address = new AddressFields(fields, () => {
      toAddress(address.values);
      this.#showRole();
    });
    onClick('connect', () => this.#connect());
    onClick('disconnect', () => this.#disconnect());
    const form = element('live-send', HTMLFormElement);
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.#send(readTelegram(form));
    });
    onClick('cancel', () => {
      this.#waiting = [];
      this.#push({ cancel: true });
    });
    for (const command of COMMANDS) element('commands', HTMLElement).append(this.#command(command));
    this.#showRole();
    this.#showOpen();
  }

  get of(): Of {
    return this.#field('role').value === 'tap' ? 'tap' : 'station';
  }

  #field(id: Setting): HTMLSelectElement {
    return element(id, HTMLSelectElement);
  }

  #showRole(): void {
    for (const part of document.querySelectorAll<HTMLElement>('.station-only')) {
      part.hidden = this.of !== 'station';
    }
  }

  #showOpen(): void {
    const isOpen = this.#ports.length > 0;
    element('connect', HTMLButtonElement).disabled = isOpen || !serial;
    element('disconnect', HTMLButtonElement).disabled = !isOpen;
    element('live-activity', HTMLElement).textContent = isOpen ? 'idle' : 'no port';
    for (const id of SETTINGS) this.#field(id).disabled = isOpen;
    for (const part of document.querySelectorAll<HTMLFieldSetElement>('fieldset.station-only')) {
      part.disabled = !isOpen;
    }
  }

  async #connect(): Promise<void> {
    const [baud, parity] = [Number(this.#field('baud').value), this.#field('parity').value];
    const preset = this.#field('port-preset').value;
    try {
      this.conversation = new Conversation();
      this.#desk.show(this);
      if (this.of === 'station') {
        const priority = this.#field('priority').value;
        const bits = parity === 'none' ? 10 : 11;
        await this.#desk.machine.call('line.station.begin', { preset, priority, baud, bits });
      } else {
        await this.#desk.machine.call('line.tap.begin', { preset });
      }
      this.#beganMs = performance.now();
      // A tap hears A on the first port, B on the second one.
      for (let index = 0; index < (this.of === 'station' ? 1 : 2); index += 1) {
        const from = this.of === 'tap' ? { is_from_b: index === 1 } : {};
        const listener = {
          hear: (bytes: Uint8Array) => this.#push({ ...from, bytes: [...bytes] }),
          damaged: (damage: Damage) =>
            this.#push(
              damage === 'break' && this.of === 'station'
                ? { is_break: true }
                : { ...from, damage: damage === 'break' ? 'framing' : damage },
            ),
          ended: (why: unknown) => {
            this.#desk.refuse(this, 'port', why);
            this.#disconnect();
          },
        };
        this.#ports.push(await OpenPort.choose(baud, parity, listener));
      }
      this.#showOpen();
      this.#judge = window.setInterval(() => this.#push({ judge: true }), JUDGE_MS);
      this.#push({});
    } catch (error) {
      await this.#disconnect();
      if (error instanceof NoPortChosen) this.#desk.status.say('No port was chosen');
      else this.#desk.refuse(this, 'port', error);
    }
  }

  async #disconnect(): Promise<void> {
    clearInterval(this.#judge);
    clearTimeout(this.#deadline);
    const ports = this.#ports;
    this.#ports = [];
    this.#waiting = [];
    this.#isBusy = false;
    for (const port of ports) await port.close();
    this.#showOpen();
  }

  get #nowS(): number {
    return (performance.now() - this.#beganMs) / 1000;
  }

  /** Pushes what has happened, and does what follows. */
  async #push(happened: Record<string, unknown>): Promise<void> {
    const of = this.of;
    try {
      const parameters = { now_s: this.#nowS, ...happened };
      const answer = await this.#desk.machine.call<Pulled>(`line.${of}`, parameters);
      this.conversation.take(answer);
      if (this.#ports.length > 0) this.conversation.nowS = this.#nowS;
      if (of === 'station') this.#pulled(answer.value);
      this.#desk.update(this);
    } catch (error) {
      this.#isBusy = false;
      this.#desk.refuse(this, '', error);
    }
  }

  #pulled({ transmit, events, activity, isBusy, deadlineS }: Pulled): void {
    if (transmit.length > 0) {
      this.#ports[0]?.write(new Uint8Array(transmit)).catch((error) => {
        this.#desk.refuse(this, 'port', error);
      });
    }
    for (const event of events) this.#tell(event);
    element('live-activity', HTMLElement).textContent = activity;
    clearTimeout(this.#deadline);
    if (deadlineS !== null && this.#ports.length > 0) {
      const ms = Math.max((deadlineS - this.#nowS) * 1000, 0);
      this.#deadline = window.setTimeout(() => this.#push({}), Math.ceil(ms));
    }
    this.#isBusy = isBusy;
    this.#sendNext();
  }

  #tell({ text, isGood, telegram }: Pulled['events'][number]): void {
    const list = element('live-events', HTMLElement);
    const isText = telegram?.every((byte) => byte >= 0x20 && byte < 0x7f) && telegram.length > 0;
    const words = isText ? `received "${String.fromCharCode(...(telegram ?? []))}"` : text;
    tell(list, EVENTS, { atS: this.#nowS, text: words, isGood });
    list.parentElement?.scrollTo(0, list.scrollHeight);
  }

  #send(telegram: Telegram): void {
    this.#desk.goOn(this);
    this.#waiting.push(telegram);
    this.#sendNext();
  }

  /** A station has one telegram at a time. */
  #sendNext(): void {
    if (this.#isBusy) return;
    const send = this.#waiting.shift();
    if (!send) return;
    this.#isBusy = true;
    this.#push({ send });
  }

  /** A button of the machine, and the fields of its words. */
  #command({ name, about, words }: Command): HTMLElement {
    const fields = words.map(({ label, value, placeholder = '', choices }) => {
      const field = choices
        ? create('select', {}, ...choices.map((it) => new Option(it, it)))
        : create('input', { type: 'text', inputMode: 'decimal', placeholder });
      field.value = value;
      return { label: create('label', {}, label, field), field };
    });
    const button = create('button', { type: 'submit', textContent: name, title: about });
    const note = create('small', { textContent: about });
    const form = create('form', { className: 'command' }, button, note);
    if (fields.length > 0) {
      form.append(create('div', { className: 'words' }, ...fields.map((it) => it.label)));
    }
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      const values = fields.map((it) => it.field.value.trim());
      this.#send({ text: [name, ...values].join(' ').trim(), is_hex: false });
    });
    return form;
  }
}
