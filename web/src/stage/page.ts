// The page of the stage: the program on the right, what the stage makes of it on the left.
import '../shared/style.css';
import './stage.css';
import '../shared/link';
import '../shared/offline';
import fast from '../../../machines/stage/drawings/fast.gcode?raw';
import link from '../../../machines/stage/drawings/link.gcode?raw';
import rosette from '../../../machines/stage/drawings/rosette.gcode?raw';
import test from '../../../machines/stage/drawings/test.gcode?raw';
import loaded from '../../../machines/stage/loaded.toml?raw';
import shipped from '../../../machines/stage/machine.toml?raw';
import wasm from '../../built/stage.wasm?url';
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
import { MachineChoice, machineForm } from '../shared/settings';
import { toAddress } from '../shared/store';
import { Transport } from '../shared/transport';
import { Working } from '../shared/working';
import { Preview, type Result, Run } from './run';
import { Scene } from './scene';

const UM_PER_MM = 1000;
/** A longer program is drawn before it is run. */
const LONG = 50_000;

const machine = new Machine(wasm);
const status = new Status();
const files = new FileButtons(
  machine,
  'stage.file',
  ['steps.csv', 'stage.svg', 'report.json'],
  status,
);
const lose = element('lose', HTMLInputElement);
const seed = element('seed', HTMLInputElement);
const steps = element('steps', HTMLSelectElement);
const tolerance = element('tolerance', HTMLInputElement);

let shown: Run | undefined;

const scene = new Scene(element('scene', HTMLCanvasElement));
const transport = new Transport((seconds) => {
  scene.at(seconds);
  for (const chart of charts) chart.at(seconds);
  limits.at(seconds);
  loadCharts.at(seconds);
  const line = shown?.legAt(seconds)?.line;
  editor.mark('now', line === undefined ? [] : [line]);
});
const seek = (seconds: number) => transport.set(seconds);
const chart = (id: string, unit: string, height: number) =>
  new Chart(element(id, HTMLElement), unit, height, seek);
const speeds = chart('speeds', 'mm/s', 170);
const accelerations = chart('accelerations', 'mm/s²', 150);
const deviations = chart('deviations', 'µm', 170);
const corrections = chart('corrections', 'steps', 140);
const charts = [speeds, accelerations, deviations, corrections];
const limits = new LimitTeller(seek, (leg) => {
  const line = shown?.leg(leg)?.line ?? 0;
  return `line ${line}: ${editor.line(line).trim()}`;
});
limits.watch(charts);
const loadCharts = new LoadCharts(
  [
    { label: 'X', colour: 'series-1' },
    { label: 'Y', colour: 'series-2' },
  ],
  seek,
  [
    { label: 'X', colour: 'series-1', blob: 'vibration x' },
    { label: 'Y', colour: 'series-2', blob: 'vibration y' },
  ],
);

const editor = new Editor(element('gcode', HTMLElement), 'G-code', () => {
  program.text = editor.text;
  changed();
});
const program = new Inputs(
  element('drawing', HTMLSelectElement),
  { test, link, rosette, fast },
  { parameter: 'drawing', ending: '.gcode', kept: { text: 'stage program', name: 'stage name' } },
  open,
);
const fields = new AddressFields({ lose, seed, steps, tolerance }, changed);
const rerun = settled(150, run);
const working = new Working(machine, status, ['Running'], run);
const choice = new MachineChoice({ published: shipped, loaded });
const settings = machineForm('stage machine', shipped, changed, undefined, choice);

/** Another program. */
function open(): void {
  editor.text = program.text;
  changed();
}

function changed(): void {
  machine.stop();
  element('lost', HTMLOutputElement).value = `${lose.valueAsNumber.toFixed(2)} %`;
  files.allow(false);
  status.say('Running');
  rerun();
}

async function run(): Promise<void> {
  const turn = machine.stop();
  await toAddress({ ...program.address, ...fields.values });
  if (!machine.isTurn(turn)) return;
  const parameters = {
    name: program.name,
    gcode: editor.text,
    machine: settings.text,
    stepping: steps.value,
    tolerance_mm: tolerance.valueAsNumber,
    lose_steps: lose.valueAsNumber * 0.01,
    seed: seed.valueAsNumber,
  };
  if (fields.problem !== undefined) {
    refuse(fields.problem);
    return;
  }
  try {
    program.begin();
    const progress = working.begin();
    const { name, gcode } = parameters;
    if (gcode.length > LONG) {
      scene.preview(new Preview(await machine.call('stage.preview', { name, gcode })));
    }
    show(new Run(await machine.call<Result>('stage', parameters, progress)));
  } catch (error) {
    if (!(error instanceof Superseded)) refuse(error);
  }
}

/** The machine has answered. */
function ready(): void {
  program.end();
  working.end();
  element('main', HTMLElement).dataset.ready = '';
}

function refuse(error: unknown): void {
  ready();
  status.refuse('', error);
  files.allow(false);
  const [line] = linesOf([error instanceof Error ? error.message : '']);
  editor.mark('note', []);
  editor.mark('now', []);
  editor.mark('bad', line === undefined ? [] : [line]);
  if (line !== undefined) editor.reveal(line);
}

function show(run: Run): void {
  shown = run;
  const { report, summary } = run.result;
  const um = (mm: number) => (mm * UM_PER_MM).toFixed(0);
  const verdict =
    `Run in ${report.duration_s.toFixed(1)} s of the machine's time: ` +
    `at most ${um(report.max_deviation_mm)} µm off the curve` +
    (run.isLossy ? `, without corrections ${um(report.open_loop.max_deviation_mm)} µm` : '');
  status.tell(verdict, [...program.notes, ...report.notes]);
  editor.mark('bad', []);
  editor.mark('note', linesOf(report.notes));
  element('summary', HTMLElement).textContent = summary;
  files.allow(true);
  scene.show(run);
  showCharts(run);
  limits.show(run.limits);
  loadCharts.show(run.blobs);
  transport.begin(report.duration_s);
  ready();
}

function showCharts(run: Run): void {
  const [times = [], values = []] = run.speeds;
  const feeds = times.map((it) => run.legAt(it ?? 0)?.feedMmS ?? null);
  speeds.show(
    [
      { label: 'programmed feed', colour: 'series-2', dash: [6, 4] },
      { label: 'speed by the steps', colour: 'series-1' },
    ],
    [times as number[], feeds, values],
  );
  const [when = [], each = []] = run.accelerations;
  const most = Math.max(...run.result.axesMay.map(([, acceleration]) => acceleration));
  accelerations.show(
    [
      { label: 'limit of an axis', colour: 'limit', dash: [6, 4] },
      { label: 'larger axis by the steps', colour: 'series-1' },
    ],
    [when as number[], when.map(() => most), each],
  );
  const [at, closed, open] = run.deviations;
  const inUm = (values: (number | null)[]) => values.map((it) => it && it * UM_PER_MM);
  const closedLine = { label: 'closed loop', colour: 'series-1' };
  if (run.isLossy) {
    const openLine = { label: 'open loop', colour: 'series-3' };
    deviations.show([openLine, closedLine], [at as number[], inUm(open), inUm(closed)]);
  } else {
    deviations.show([closedLine], [at as number[], inUm(closed)]);
  }
  element('corrected', HTMLElement).hidden = !run.isLossy;
  const [corrected, steps] = run.corrections;
  corrections.show([{ label: 'corrected', colour: 'series-1' }], [corrected as number[], steps]);
}

/** The program as telegrams of a board, with the times that the run on the page has for them. */
async function motions(): Promise<Motion[]> {
  const { value } = await machine.call<{
    lines: number[];
    telegrams: string[];
    ends: [number, number][];
  }>('stage.telegrams', { name: program.name, gcode: editor.text });
  const [begin = [0, 0]] = value.ends;
  const toBegin = `line ${begin.map((it) => it.toFixed(4)).join(' ')}`;
  const first = { telegram: toBegin, name: 'the way to its begin', fromS: 0, toS: 0, end: begin };
  const rest = value.telegrams.map((telegram, leg) => {
    const [fromS, toS] = shown?.timesOf(leg) ?? [0, 0];
    const name = `line ${value.lines[leg]}`;
    return { telegram, name, fromS, toS, end: value.ends[leg + 1] ?? begin };
  });
  return [first, ...rest];
}

new Board({
  name: 'stage',
  axes: ['x', 'y'],
  unit: 'By, in mm',
  program: motions,
  show: (place) => scene.say(place as [number, number] | undefined),
  seek,
});
element('input', HTMLFormElement).addEventListener('submit', (event) => event.preventDefault());
onClick('save-program', () => save(program.file, editor.text));
open();
