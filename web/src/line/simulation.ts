// Two simulated stations whose line one breaks, to learn the procedure.
import { element, onClick } from '../shared/dom';
import {
  fieldsFromLink,
  fromAddress,
  intoAddress,
  intoLink,
  linkChanged,
  toAddress,
} from '../shared/store';
import { Conversation, type News } from './conversation';
import type { Desk, View } from './desk';
import { SCENARIOS } from './scenarios';
import { type StationEvent, StationPanel, type StationState } from './station-panel';

interface Pulled extends News {
  nowS: number;
  stations: [StationState, StationState];
  events: StationEvent[];
}

/** Of the line's time, in one call: the page stays alive in between. */
const MAX_RUN_S = 2;
/** How far a step looks for a change. */
const MAX_STEP_S = 10;
const JUDGE_MS = 250;
const SEED = 1;
/** What a link has run at most, in s. */
const MAX_LINKED_S = 3600;

export class Simulation implements View {
  readonly of = 'simulation';
  readonly follows = true;
  readonly idle = 'Two stations and a line: choose a fault, and run';
  conversation = new Conversation();
  readonly #desk: Desk;
  readonly #panels: StationPanel[];
  readonly #oneWire = element('one-wire', HTMLInputElement);
  readonly #traffic = element('traffic', HTMLInputElement);
  readonly #scenario = element('scenario', HTMLSelectElement);
  readonly #run = element('run', HTMLButtonElement);
  #isRunning = false;
  #nowS = 0;
  #judgedMs = 0;
  /** Calls go one after the other. */
  #last: Promise<void> = Promise.resolve();

  constructor(desk: Desk) {
    this.#desk = desk;
    const template = element('station', HTMLTemplateElement);
    this.#panels = ['station-a', 'station-b'].map((id, index) => {
      const act = {
        send: (telegram: unknown) =>
          this.#do(async () => {
            await desk.machine.call('line.simulation.send', { is_from_b: index === 1, telegram });
            await this.#pull(this.#nowS, false);
          }),
        set: () => this.#changed(() => this.#set()),
        restart: () => this.#changed(() => this.#restart()),
      };
      return new StationPanel(element(id, HTMLElement), template, act);
    });
    for (const { name, label } of SCENARIOS) this.#scenario.add(new Option(label, name));
    this.#scenario.add(new Option('as set below', ''));
    this.#scenario.addEventListener('change', () => this.#play(this.#scenario.value));
    this.#oneWire.addEventListener('change', () => this.#changed(() => this.#set()));
    this.#traffic.addEventListener('change', () => this.#do(() => this.#set()));
    this.#run.addEventListener('click', () => this.#toggle());
    onClick('step', () => this.#do(() => this.#step()));
    onClick('run-20', () => this.#do(() => this.#runTo(this.#nowS + 20)));
    onClick('restart', () => this.#do(() => this.#restart()));
    intoLink('stations', () => (this.#scenario.value === '' ? this.#fields : undefined));
    intoAddress(() => {
      const isSeen = this.#desk.shows(this) && this.#nowS > 0;
      return { ran: isSeen ? String(this.#nowS) : null };
    });
  }

  /** As the link has it: a scenario or all fields, and the time that the line has run. */
  async begin(): Promise<void> {
    const [name, ranS] = [fromAddress('fault') ?? 'none', Number(fromAddress('ran'))];
    const fields = fieldsFromLink('stations');
    if (fields) {
      this.#fill(fields);
      this.#scenario.value = '';
      await this.#do(() => this.#restart());
    } else {
      await this.#play(SCENARIOS.some((it) => it.name === name) ? name : 'none');
    }
    if (!(ranS > 0 && ranS <= MAX_LINKED_S)) return;
    await this.#do(() => this.#runTo(ranS));
    // Where the link looks at the wire, there are characters now.
    this.#desk.renew(this);
  }

  /** All fields, as `B parity`. */
  get #fields(): Record<string, string | boolean> {
    const stations = this.#panels.flatMap((panel) =>
      Object.entries(panel.values).map(([name, value]) => [`${panel.side} ${name}`, value]),
    );
    const line = { 'line one-wire': this.#oneWire.checked, 'line traffic': this.#traffic.checked };
    return { ...Object.fromEntries(stations), ...line };
  }

  #fill(fields: Record<string, string | boolean>): void {
    const value = (name: string, usual: boolean) =>
      typeof fields[name] === 'boolean' ? fields[name] : usual;
    this.#oneWire.checked = value('line one-wire', false);
    this.#traffic.checked = value('line traffic', this.#traffic.checked);
    for (const panel of this.#panels) {
      for (const [name, before] of Object.entries(panel.values)) {
        const given = fields[`${panel.side} ${name}`] ?? before;
        const field = panel.field(name);
        if (field instanceof HTMLInputElement && typeof given === 'boolean') field.checked = given;
        else field.value = String(given);
        if (field instanceof HTMLSelectElement && field.selectedIndex < 0) {
          field.value = String(before);
        }
      }
    }
  }

  /** Stops the clock. */
  pause(): void {
    this.#isRunning = false;
    this.#run.textContent = 'Run';
  }

  /** Sets the stations and the line as a scenario has them. */
  #play(name: string): Promise<void> {
    const scenario = SCENARIOS.find((it) => it.name === name);
    if (!scenario) return Promise.resolve();
    toAddress({ fault: name === 'none' ? null : name });
    this.#scenario.value = name;
    for (const panel of this.#panels) panel.reset();
    this.#fill({ ...scenario.fields, 'line one-wire': scenario.isOneWire ?? false });
    return this.#do(() => this.#restart());
  }

  /** A field was changed by hand: it is no scenario any more. */
  #changed(act: () => Promise<void>): void {
    this.#scenario.value = '';
    toAddress({ fault: 'own' });
    this.#do(act);
  }

  /** Acts after what was asked for before; tells what is refused. */
  #do(act: () => Promise<void>): Promise<void> {
    this.#desk.goOn(this);
    this.#last = this.#last.then(act).catch((error: unknown) => {
      this.pause();
      this.#desk.refuse(this, '', error);
    });
    return this.#last;
  }

  async #restart(): Promise<void> {
    const [a, b] = this.#panels.map((it) => it.settings());
    await this.#desk.machine.call('line.simulation.begin', { a, b, seed: SEED });
    await this.#set();
    this.conversation = new Conversation();
    for (const panel of this.#panels) panel.clear();
    this.#nowS = 0;
    this.#desk.renew(this);
    await this.#pull(0, false);
  }

  async #set(): Promise<void> {
    const [a, b] = this.#panels.map((it) => it.faults());
    const [is_one_wire, has_traffic] = [this.#oneWire.checked, this.#traffic.checked];
    await this.#desk.machine.call('line.simulation.set', { a, b, is_one_wire, has_traffic });
  }

  #toggle(): void {
    if (this.#isRunning) {
      this.pause();
      return;
    }
    this.#isRunning = true;
    this.#run.textContent = 'Pause';
    let before = performance.now();
    const tick = async () => {
      if (!this.#isRunning) return;
      const now = performance.now();
      const rate = Number(element('rate', HTMLSelectElement).value);
      const toS = this.#nowS + Math.min(((now - before) / 1000) * rate, MAX_RUN_S);
      before = now;
      await this.#do(() => this.#pull(toS, false));
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  async #step(): Promise<void> {
    this.pause();
    await this.#pull(this.#nowS + MAX_STEP_S, true);
  }

  async #runTo(endS: number): Promise<void> {
    while (this.#nowS < endS) await this.#pull(Math.min(this.#nowS + MAX_RUN_S, endS), false);
    this.#judgedMs = 0;
    await this.#pull(endS, false);
  }

  async #pull(to_s: number, is_step: boolean): Promise<void> {
    const ms = performance.now();
    const judge = is_step || ms - this.#judgedMs > JUDGE_MS;
    if (judge) this.#judgedMs = ms;
    const parameters = { to_s, is_step, judge };
    const answer = await this.#desk.machine.call<Pulled>('line.simulation.run', parameters);
    const { nowS, stations, events } = answer.value;
    this.#nowS = nowS;
    this.conversation.take(answer);
    this.conversation.nowS = nowS;
    for (const [index, panel] of this.#panels.entries()) {
      const state = stations[index];
      if (state) panel.show(state, nowS);
      for (const event of events) if (event.side === panel.side) panel.tell(event);
    }
    element('simulated-time', HTMLOutputElement).textContent = `${nowS.toFixed(4)} s`;
    linkChanged();
    this.#desk.update(this);
  }
}
