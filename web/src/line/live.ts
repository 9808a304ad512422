// A station, or a tap with two ports, on real ports.
import { asText, PortStation, type Pulled, type StationEvent } from '../board/station';
import { create, element, onClick } from '../shared/dom';
import { AddressFields } from '../shared/fields';
import type { Answer } from '../shared/machine';
import { PicoPanel } from '../pico/panel';
import { hasFirmware, NO_FIRMWARE } from '../pico/pico';
import { toAddress } from '../shared/store';
import { COMMANDS, type Command } from './commands';
import { Conversation, type News } from './conversation';
import type { Desk, Of, View } from './desk';
import { tell } from './events';
import { choosePort, type Damage, NoPortChosen, OpenPort, type Port, serial } from './port';
import { readTelegram, type Telegram } from './station-panel';

/** How often the verdict on the last minute is asked for. */
const JUDGE_MS = 500;
const EVENTS = 50;
/** What is set of a port, by the ids of its fields, which are the names in the address too. */
const SETTINGS = ['role', 'port-preset', 'priority', 'baud', 'parity'] as const;
type Setting = (typeof SETTINGS)[number];
const PICO_NOTE =
  'The Pico on this page is the firmware of the board, instruction by instruction, with its arm and switches: 9600 bits per second, even parity. It needs no board and no Web Serial.';

export class Live implements View {
  readonly follows = true;
  readonly idle = serial
    ? 'No port is open'
    : 'This browser has no Web Serial: Chrome, Edge and Opera have it';
  conversation = new Conversation();
  readonly #desk: Desk;
  readonly #pico: PicoPanel;
  readonly #station: PortStation;
  #isOpen = false;
  /** Both ports of a tap. */
  #taps: OpenPort[] = [];
  #beganMs = 0;
  #judge = 0;

  constructor(desk: Desk) {
    this.#desk = desk;
    this.#station = new PortStation(desk.machine, {
      pulled: (answer) => this.#pulled(answer),
      refused: (where, error) => desk.refuse(this, where, error),
      ended: (why) => this.#ended(why),
    });
    const fields = Object.fromEntries(SETTINGS.map((id) => [id, this.#field(id)]));
    const address = new AddressFields(fields, () => {
      toAddress(address.values);
      this.#showRole();
    });
    this.#pico = new PicoPanel(
      (text) => this.#send({ text, is_hex: false }),
      (error) => {
        desk.refuse(this, 'the Pico', error);
        this.#disconnect();
      },
    );
    element('pico-note', HTMLElement).textContent = hasFirmware ? PICO_NOTE : NO_FIRMWARE;
    onClick('connect', () => this.#connect(choosePort));
    onClick('connect-pico', () => this.#connect(() => this.#pico.port()));
    onClick('disconnect', () => this.#disconnect());
    const form = element('live-send', HTMLFormElement);
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.#send(readTelegram(form));
    });
    onClick('cancel', () => this.#station.cancel());
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
    const isOpen = this.#isOpen;
    element('connect', HTMLButtonElement).disabled = isOpen || !serial;
    element('connect-pico', HTMLButtonElement).disabled = isOpen || !hasFirmware;
    element('disconnect', HTMLButtonElement).disabled = !isOpen;
    this.#pico.connected(isOpen);
    element('live-activity', HTMLElement).textContent = isOpen ? 'idle' : 'no port';
    for (const id of SETTINGS) this.#field(id).disabled = isOpen;
    for (const part of document.querySelectorAll<HTMLFieldSetElement>('fieldset.station-only')) {
      part.disabled = !isOpen;
    }
  }

  async #connect(choose: () => Promise<Port>): Promise<void> {
    const [baud, parity] = [Number(this.#field('baud').value), this.#field('parity').value];
    const preset = this.#field('port-preset').value;
    try {
      this.conversation = new Conversation();
      this.#desk.show(this);
      if (this.of === 'station') {
        const priority = this.#field('priority').value;
        await this.#station.open(choose, { preset, priority, baud, parity });
      } else {
        await this.#desk.machine.call('line.tap.begin', { preset });
        this.#beganMs = performance.now();
        // A tap hears A on the first port, B on the second one.
        for (const isFromB of [false, true]) {
          const listener = {
            hear: (bytes: Uint8Array) => this.#tap({ is_from_b: isFromB, bytes: [...bytes] }),
            damaged: (damage: Damage) =>
              this.#tap({ is_from_b: isFromB, damage: damage === 'break' ? 'framing' : damage }),
            ended: (why: unknown) => this.#ended(why),
          };
          this.#taps.push(await OpenPort.open(await choose(), baud, parity, listener));
        }
      }
      this.#isOpen = true;
      this.#showOpen();
      const push = (happened: Record<string, unknown>) =>
        this.of === 'station' ? this.#station.push(happened) : this.#tap(happened);
      this.#judge = window.setInterval(() => push({ judge: true }), JUDGE_MS);
    } catch (error) {
      await this.#disconnect();
      if (error instanceof NoPortChosen) this.#desk.status.say('No port was chosen');
      else this.#desk.refuse(this, 'port', error);
    }
  }

  #ended(why: unknown): void {
    this.#desk.refuse(this, 'port', why);
    this.#disconnect();
  }

  async #disconnect(): Promise<void> {
    clearInterval(this.#judge);
    this.#isOpen = false;
    const taps = this.#taps;
    this.#taps = [];
    await this.#station.close();
    for (const port of taps) await port.close();
    this.#showOpen();
  }

  get #nowS(): number {
    return this.of === 'station' ? this.#station.nowS : (performance.now() - this.#beganMs) / 1000;
  }

  async #tap(happened: Record<string, unknown>): Promise<void> {
    try {
      const parameters = { now_s: this.#nowS, ...happened };
      this.#heard(await this.#desk.machine.call<News>('line.tap', parameters));
    } catch (error) {
      this.#desk.refuse(this, '', error);
    }
  }

  #pulled(answer: Answer<Pulled>): void {
    for (const event of answer.value.events) this.#tell(event);
    element('live-activity', HTMLElement).textContent = answer.value.activity;
    this.#heard(answer);
  }

  #heard(news: Answer<News>): void {
    this.conversation.take(news);
    if (this.#isOpen) this.conversation.nowS = this.#nowS;
    this.#desk.update(this);
  }

  #tell({ text, isGood, telegram }: StationEvent): void {
    const list = element('live-events', HTMLElement);
    const received = asText(telegram);
    if (received !== undefined) this.#pico.heard(received);
    const words = received === undefined ? text : `received "${received}"`;
    tell(list, EVENTS, { atS: this.#nowS, text: words, isGood });
    list.parentElement?.scrollTo(0, list.scrollHeight);
  }

  #send(telegram: Telegram): void {
    this.#desk.goOn(this);
    this.#station.send(telegram);
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
