// The page of the alignment platform: pose and pendant on the right, body and axes on the left.
import '../shared/style.css';
import './align.css';
import '../shared/link';
import '../shared/offline';
import shipped from '../../../machines/platform/platform.toml?raw';
import wasm from '../../built/align.wasm?url';
import { Chart } from '../shared/chart';
import { element, onClick, settled } from '../shared/dom';
import { AddressFields } from '../shared/fields';
import { Machine, Superseded } from '../shared/machine';
import { FileButtons, Status } from '../shared/result';
import { machineForm } from '../shared/settings';
import { viewButtons } from '../shared/space';
import { fromAddress, intoAddress, linkChanged, toAddress } from '../shared/store';
import { Transport } from '../shared/transport';
import { momentAt, type Result } from './aligned';
import { Pendant } from './pendant';
import { Scene } from './scene';
import { PoseSliders } from './sliders';

const UM_PER_MM = 1000;
const COLOURS = ['series-1', 'series-2', 'series-4', 'series-3'] as const;
const TABLES = ['pvt.csv', 'pt.csv'];

const machine = new Machine(wasm);
const status = new Status();
const files = new FileButtons(
  machine,
  'align.file',
  [...TABLES, 'align.svg', 'jog.svg', 'line.log', 'report.json'],
  status,
);
const mode = element('mode', HTMLSelectElement);
const factor = element('factor', HTMLSelectElement);

/** As the address or the sliders have it; otherwise that of the platform file. */
let pose: number[] | undefined;
let shown: Result | undefined;
let isLive = false;

const scene = new Scene(element('scene', HTMLCanvasElement));
viewButtons(element('views', HTMLElement), scene.space);
const transport = new Transport((seconds) => {
  if (!isLive) scene.now = momentAt(shown?.moments ?? [], seconds);
  errors.at(seconds);
  axes.at(seconds);
});
const seek = (seconds: number) => transport.set(seconds);
const errors = new Chart(element('errors', HTMLElement), 'µm', 180, seek);
const axes = new Chart(element('axes', HTMLElement), 'mm/s', 220, seek);
const sliders = new PoseSliders(element('sliders', HTMLElement), () => {
  pose = sliders.pose;
  changed();
});
const fields = new AddressFields({ mode }, changed);
const looks = new AddressFields({ factor }, () => {
  scene.factor = Number(factor.value);
  linkChanged();
});
intoAddress(() => looks.values);
const settings = machineForm('align platform', shipped, changed, 'platform.toml');
const pendant = new Pendant(
  wasm,
  () => settings.text,
  (moment) => {
    isLive = moment !== undefined;
    scene.now = moment ?? momentAt(shown?.moments ?? [], transport.seconds);
  },
  (error) => status.refuse('', error),
);
const realign = settled(150, align);

function changed(): void {
  machine.stop();
  pendant.switchOff();
  files.allow(false);
  status.say('Aligning');
  realign();
}

async function align(): Promise<void> {
  const turn = machine.stop();
  await toAddress({ to: pose?.join(',') ?? null, ...fields.values });
  if (!machine.isTurn(turn)) return;
  if (pose?.some((it) => Number.isNaN(it))) {
    refuse('pose: six numbers are needed');
    return;
  }
  const parameters = { platform: settings.text, to: pose ?? null, mode: mode.value };
  try {
    show((await machine.call<Result>('align', parameters)).value);
  } catch (error) {
    if (!(error instanceof Superseded)) refuse(error);
  }
}

function refuse(error: unknown): void {
  element('main', HTMLElement).dataset.ready = '';
  status.refuse('', error);
  files.allow(false);
}

function show(result: Result): void {
  shown = result;
  const { report, summary, note, isWithinBounds } = result;
  const um = (mm: number) => (mm * UM_PER_MM).toFixed(3);
  const verdict =
    `Aligned in ${report.duration_s.toFixed(1)} s of the machine's time: distance error at most ` +
    `${um(report.max_distance_error_mm)} µm, the bound is ${um(report.distance_error_bound_mm)} µm`;
  status.tell(verdict, note ? [note] : [], !isWithinBounds);
  element('summary', HTMLElement).textContent = summary;
  files.allow(
    true,
    TABLES.filter((it) => it !== `${mode.value}.csv`),
  );
  sliders.show(result.to, result.from);
  scene.start = result.moments[0];
  showCharts(result);
  transport.begin(report.duration_s);
  element('main', HTMLElement).dataset.ready = '';
}

function showCharts({ moments, report }: Result): void {
  const times = moments.map((it) => it.s);
  errors.show(
    [
      { label: 'bound', colour: 'limit', dash: [6, 4] },
      { label: 'distance error', colour: 'series-1' },
    ],
    [
      times,
      times.map(() => report.distance_error_bound_mm * UM_PER_MM),
      moments.map((it) => it.error * UM_PER_MM),
    ],
  );
  const dashes = [[], [8, 3], [2, 3]];
  const lines = (moments[0]?.locators ?? []).flatMap((_, locator) =>
    ['X', 'Y', 'Z'].map((axis, index) => ({
      line: {
        label: `${locator + 1}${axis}`,
        colour: COLOURS[locator % COLOURS.length] ?? 'series-1',
        dash: dashes[index] ?? [],
      },
      values: moments.map((it) => it.speeds[locator]?.[index] ?? 0),
    })),
  );
  axes.show(
    lines.map((it) => it.line),
    [times, ...lines.map((it) => it.values)],
  );
}

const asked = fromAddress('to')?.split(',').map(Number);
if (asked?.length === 6 && asked.every(Number.isFinite)) pose = asked;
scene.factor = Number(factor.value);
onClick('default-pose', () => {
  pose = undefined;
  changed();
});
element('input', HTMLFormElement).addEventListener('submit', (event) => event.preventDefault());
changed();
