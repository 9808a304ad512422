// The page of the engraver: input on the right, what the machine makes of it on the left.
import '../shared/style.css';
import './engrave.css';
import '../shared/link';
import '../shared/offline';
import lettering from '../../../machines/engraver/drawings/lettering.svg?raw';
import rosette from '../../../machines/engraver/drawings/rosette.svg?raw';
import star from '../../../machines/engraver/drawings/star.svg?raw';
import loaded from '../../../machines/engraver/loaded.toml?raw';
import shipped from '../../../machines/engraver/machine.toml?raw';
import wasm from '../../built/engrave.wasm?url';
import { Chart } from '../shared/chart';
import { element, settled } from '../shared/dom';
import { AddressFields } from '../shared/fields';
import { Inputs } from '../shared/inputs';
import { LimitTeller } from '../shared/limits';
import { LoadCharts } from '../shared/load';
import { Machine, Superseded } from '../shared/machine';
import { MachineChoice, machineForm } from '../shared/settings';
import { FileButtons, Status } from '../shared/result';
import { fromAddress, toAddress } from '../shared/store';
import { Transport } from '../shared/transport';
import { Working } from '../shared/working';
import { Engraving, type Result } from './engraving';
import { Lanes } from './lanes';
import { Scene } from './scene';

const STAGES = ['Planning', 'Engraving'] as const;

const machine = new Machine(wasm);
const status = new Status();
const controller = element('controller', HTMLSelectElement);
const tolerance = element('tolerance', HTMLInputElement);
const placement = element('placement', HTMLInputElement);
const keepOrder = element('keep-order', HTMLInputElement);
const names = ['pattern.bin', 'pattern.h', 'pulses.vcd', 'engraved.svg', 'report.json'];
const files = new FileButtons(machine, 'engrave.file', names, status);

const scene = new Scene(element('scene', HTMLCanvasElement));
const lanes = new Lanes(element('lanes', HTMLCanvasElement), element('lanes-note', HTMLElement));
const transport = new Transport((seconds) => {
  scene.at(seconds);
  lanes.at(seconds);
  chart.at(seconds);
  limits.at(seconds);
  loadCharts.at(seconds);
});
const chart = new Chart(element('deviation', HTMLElement), 'mm', 180, (seconds) =>
  transport.set(seconds),
);
const limits = new LimitTeller(
  (seconds) => transport.set(seconds),
  (stroke) => `stroke ${stroke} of the drawing`,
);
const loadCharts = new LoadCharts(
  [
    { label: 'shoulder', colour: 'series-1' },
    { label: 'elbow', colour: 'series-2' },
    { label: 'disc', colour: 'series-3' },
  ],
  (seconds) => transport.set(seconds),
);
limits.watch([chart]);
lanes.onSeek((seconds) => transport.set(seconds));

const drawing = new Inputs(
  element('drawing', HTMLSelectElement),
  { rosette, star, lettering },
  {
    parameter: 'drawing',
    ending: '.svg',
    kept: { text: 'engrave drawing', name: 'engrave name' },
  },
  changed,
);
const fields = new AddressFields({ tolerance, placement, controller }, changed);
const choice = new MachineChoice({ published: shipped, loaded });
const settings = machineForm('engrave machine', shipped, changed, undefined, choice);

const replan = settled(150, engrave);
const working = new Working(machine, status, STAGES, engrave);

/** What is shown is outdated as soon as something is typed. */
function changed(): void {
  machine.stop();
  files.allow(false);
  status.say(STAGES[0]);
  replan();
}

async function engrave(): Promise<void> {
  const turn = machine.stop();
  await toAddress({
    ...drawing.address,
    ...fields.values,
    order: keepOrder.checked ? 'file' : null,
  });
  if (!machine.isTurn(turn)) return;
  const parameters = {
    name: drawing.name,
    svg: drawing.text,
    machine: settings.text,
    tolerance_mm: tolerance.valueAsNumber,
    placement: placement.value || null,
    keep_order: keepOrder.checked,
    controller: controller.value,
  };
  if (fields.problem !== undefined) {
    refuse(fields.problem);
    return;
  }
  try {
    drawing.begin();
    const answer = await machine.call<Result>('engrave', parameters, working.begin());
    show(new Engraving(answer));
  } catch (error) {
    if (!(error instanceof Superseded)) refuse(error);
  }
}

/** The machine has answered. */
function ready(): void {
  drawing.end();
  working.end();
  element('main', HTMLElement).dataset.ready = '';
}

function refuse(error: unknown): void {
  ready();
  status.refuse('', error);
  files.allow(false);
}

function show(engraving: Engraving): void {
  const { report, summary, isWithinBound } = engraving.result;
  const { duration_s, bound_mm } = engraving.shown;
  const verdict = isWithinBound
    ? `Engraved in ${duration_s.toFixed(0)} s of the machine's time, within ${bound_mm.toFixed(3)} mm`
    : 'The tool left the drawing by more than the bound';
  status.tell(verdict, [...drawing.notes, ...report.notes], !isWithinBound);
  // Columns are as wide as a terminal; here they would be broken.
  element('summary', HTMLElement).textContent = summary.replace(/ {3,}/g, '  ');
  files.allow(true);
  scene.show(engraving);
  lanes.show(engraving);
  limits.show(engraving.limits);
  loadCharts.show(engraving.blobs);
  const [seconds, distance] = engraving.deviation;
  const bound = seconds.map(() => bound_mm);
  chart.show(
    [
      { label: 'max of each part of the time', colour: 'series-1' },
      { label: 'bound', colour: 'limit', dash: [6, 4] },
    ],
    [seconds, distance, bound],
  );
  transport.begin(duration_s);
  ready();
}

keepOrder.checked = fromAddress('order') === 'file';
keepOrder.addEventListener('input', changed);
element('input', HTMLFormElement).addEventListener('submit', (event) => event.preventDefault());
engrave();
