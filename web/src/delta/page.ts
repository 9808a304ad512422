// The page of the Delta robot: points on the right, what the robot makes of them on the left.
import '../shared/style.css';
import './delta.css';
import '../shared/link';
import '../shared/offline';
import example from '../../../machines/delta/inputs/measured.txt?raw';
import pickAndPlace from '../../../machines/delta/inputs/pick-and-place.txt?raw';
import spiral from '../../../machines/delta/inputs/spiral.txt?raw';
import loaded from '../../../machines/delta/loaded.toml?raw';
import shipped from '../../../machines/delta/machine.toml?raw';
import wasm from '../../built/delta.wasm?url';
import { Board, type Motion } from '../board/board';
import { Chart } from '../shared/chart';
import { element, onClick, save, settled } from '../shared/dom';
import { Editor, linesOf } from '../shared/editor';
import { AddressFields } from '../shared/fields';
import { Inputs } from '../shared/inputs';
import { LimitTeller } from '../shared/limits';
import { LoadCharts } from '../shared/load';
import { Machine, Superseded } from '../shared/machine';
import { FileButtons, Status } from '../shared/result';
import { columns, countUntil } from '../shared/rows';
import { MachineChoice, machineForm } from '../shared/settings';
import { type Point3, viewButtons } from '../shared/space';
import {
  intoLink,
  isLinked,
  keep,
  kept,
  linkChanged,
  textFromLink,
  toAddress,
} from '../shared/store';
import { Transport } from '../shared/transport';
import { Working } from '../shared/working';
import { ARMS, Driving, type Quantity, type Result } from './driving';
import { ARM_COLOURS, Scene } from './scene';

const GRAMS_PER_KG = 1000;

const machine = new Machine(wasm);
const status = new Status();
const files = new FileButtons(
  machine,
  'delta.file',
  ['steps.csv', 'delta.svg', 'report.json'],
  status,
);
const motion = element('motion', HTMLSelectElement);
const load = element('load', HTMLInputElement);
const calibrated = element('calibrated', HTMLElement);
const summary = element('summary', HTMLElement);
const use = element('use', HTMLButtonElement);

let shown: Driving | undefined;
/** With what the last calibration has found. */
let calibratedMachine: string | undefined;

const scene = new Scene(element('scene', HTMLCanvasElement), (text) => {
  editor.change(text);
});
viewButtons(element('views', HTMLElement), scene.space);
const transport = new Transport((seconds) => {
  scene.at(seconds);
  for (const chart of charts) chart.at(seconds);
  limits.at(seconds);
  loadCharts.at(seconds);
});
const seek = (seconds: number) => transport.set(seconds);
const chart = (id: string, unit: string) => new Chart(element(id, HTMLElement), unit, 160, seek);
const speeds = chart('speeds', 'mm/s');
const rates = chart('rates', '°/s');
const accelerations = chart('accelerations', '°/s²');
const torques = chart('torques', 'N m');
const charts = [speeds, rates, accelerations, torques];
const loadCharts = new LoadCharts(
  ARMS.map((arm) => ({ label: `arm ${arm + 1}`, colour: ARM_COLOURS[arm] })),
  seek,
);
const limits = new LimitTeller(seek, (line) => `line ${line}: ${editor.line(line).trim()}`);
limits.watch(charts);

const editor = new Editor(element('lines', HTMLElement), 'Points', () => {
  points.text = editor.text;
  changed();
});
const points = new Inputs(
  element('shipped', HTMLSelectElement),
  { 'pick-and-place': pickAndPlace, spiral },
  { parameter: 'input', ending: '.txt', kept: { text: 'delta lines', name: 'delta name' } },
  open,
);
const fields = new AddressFields({ motion, load }, changed);
const measured = new Editor(element('measured', HTMLElement), 'Measured points', () => {
  keep('delta measured', measured.text || null);
  linkChanged();
  measured.mark('bad', []);
});
const redrive = settled(150, drive);
const working = new Working(machine, status, ['Driving'], drive);
const choice = new MachineChoice({ published: shipped, loaded });
const settings = machineForm('delta machine', shipped, changed, undefined, choice);

/** Other points. */
function open(): void {
  editor.text = points.text;
  changed();
}

function changed(): void {
  machine.stop();
  scene.text = editor.text;
  files.allow(false);
  status.say('Driving');
  redrive();
}

async function drive(): Promise<void> {
  const turn = machine.stop();
  await toAddress({ ...points.address, ...fields.values });
  if (!machine.isTurn(turn)) return;
  const parameters = {
    lines: editor.text,
    machine: settings.text,
    motion: motion.value,
    load_kg: load.valueAsNumber / GRAMS_PER_KG,
  };
  if (fields.problem !== undefined) {
    refuse(fields.problem);
    return;
  }
  try {
    points.begin();
    const driving = new Driving(await machine.call<Result>('delta', parameters, working.begin()));
    show(driving);
    // The other ways to drive the lines take several times as long; nothing waits for them.
    const { value, blobs } = await machine.call<string>('delta.report', null);
    summary.textContent = value;
    loadCharts.show({ ...driving.blobs, ...blobs });
    files.allow(true);
  } catch (error) {
    if (!(error instanceof Superseded)) refuse(error);
  }
}

/** The machine has answered. */
function ready(): void {
  points.end();
  working.end();
  element('main', HTMLElement).dataset.ready = '';
}

function refuse(error: unknown): void {
  ready();
  status.refuse('', error);
  files.allow(false);
}

function show(driving: Driving): void {
  const isFirst = shown === undefined;
  const before = transport.seconds;
  shown = driving;
  const { refused, refusedLines, notes, durationS, maxPathErrorMm } = driving.result;
  const verdict =
    refused ??
    `Driven in ${durationS.toFixed(2)} s of the machine's time, ` +
      `at most ${maxPathErrorMm.toFixed(3)} mm off the lines`;
  status.tell(verdict, [...points.notes, ...notes], refused !== null);
  editor.mark('bad', refusedLines);
  editor.mark('note', linesOf(notes));
  summary.textContent = 'Comparing with other ways to drive the lines';
  scene.show(driving);
  showCharts(driving);
  limits.show(driving.limits);
  loadCharts.show(driving.blobs);
  transport.begin(durationS);
  // A point that is dragged does not move the time.
  if (!isFirst) transport.set(before);
  ready();
}

function showCharts(driving: Driving): void {
  const [times = [], values = []] = columns(driving.speeds, 2);
  const ends = Float64Array.from(driving.lines, (line) => line.endS);
  const feeds = times.map((it) => driving.lines[countUntil(ends, it ?? 0)]?.feed ?? null);
  speeds.show(
    [
      { label: 'feed asked for', colour: 'series-3', dash: [6, 4] },
      { label: 'by the steps', colour: 'series-1' },
    ],
    [times as number[], feeds, values],
  );
  showArms(rates, driving, 'rates', driving.result.maxRateDegS);
  showArms(accelerations, driving, 'accelerations', driving.result.maxAccelerationDegS2);
  showArms(torques, driving, 'torques');
}

/** A quantity of the three arms, and its limit either way. */
function showArms(chart: Chart, driving: Driving, quantity: Quantity, limit?: number): void {
  const lines = ARMS.map((arm) => ({ label: `arm ${arm + 1}`, colour: ARM_COLOURS[arm] }));
  const values = ARMS.map((arm) => driving.column(quantity, arm));
  const times = Array.from(driving.times);
  const limits = limit === undefined ? [] : [limit, -limit];
  const limitLines = limits.map((it) => ({
    label: it > 0 ? 'limit' : 'limit backward',
    colour: 'limit',
    dash: [6, 4],
  }));
  const limitValues = limits.map((it) => times.map(() => it));
  chart.show([...limitLines, ...lines], [times, ...limitValues, ...values]);
}

/** The lines as telegrams of a board, with the times that the run on the page has for them. */
async function motions(): Promise<Motion[]> {
  if (!shown) throw new Error('nothing has been driven yet');
  if (shown.result.refused !== null) throw new Error(shown.result.refused);
  let fromS = 0;
  return shown.lines.map(({ to, feed, endS }, index) => {
    const place = to.map((it) => it.toFixed(4)).join(' ');
    const name = `motion ${index + 1}`;
    const motion = { telegram: `line ${place} ${feed}`, name, fromS, toS: endS, end: to };
    fromS = endS;
    return motion;
  });
}

new Board({
  name: 'delta',
  axes: ['arm1', 'arm2', 'arm3'],
  unit: 'By, in degrees',
  program: motions,
  show: (place) => scene.say(place as Point3 | undefined),
  seek,
});

async function calibrate(): Promise<void> {
  const parameters = {
    machine: settings.text,
    measured: measured.text,
    fit: element('fit', HTMLSelectElement).value,
  };
  use.disabled = true;
  measured.mark('bad', []);
  try {
    const found = await machine.call<{ summary: string; machine: string }>(
      'delta.calibrate',
      parameters,
    );
    calibrated.textContent = found.value.summary;
    calibratedMachine = found.value.machine;
    use.disabled = false;
  } catch (error) {
    if (error instanceof Superseded) {
      calibrated.textContent = 'the input has changed meanwhile: calibrate again';
      return;
    }
    const said = error instanceof Error ? error.message : String(error);
    calibrated.textContent = `measured points: ${said}`;
    measured.mark('bad', linesOf([said]));
  }
}

measured.text = textFromLink('measured') ?? (isLinked ? '' : (kept('delta measured') ?? ''));
intoLink('measured', () => measured.text || undefined);
element('input', HTMLFormElement).addEventListener('submit', (event) => event.preventDefault());
onClick('calibrate', calibrate);
onClick('example', () => measured.change(example));
onClick('use', () => {
  if (calibratedMachine !== undefined) settings.replace(calibratedMachine);
});
onClick('save-lines', () => save(points.file, editor.text));
open();
