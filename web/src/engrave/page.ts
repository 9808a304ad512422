// The page of the engraver: input on the right, what the machine makes of it on the left.
import '../shared/style.css';
import './engrave.css';
import '../shared/offline';
import lettering from '../../../machines/engraver/drawings/lettering.svg?raw';
import rosette from '../../../machines/engraver/drawings/rosette.svg?raw';
import star from '../../../machines/engraver/drawings/star.svg?raw';
import shipped from '../../../machines/engraver/machine.toml?raw';
import wasm from '../../built/engrave.wasm?url';
import { Chart } from '../shared/chart';
import { element, settled, takeFiles } from '../shared/dom';
import { Machine, Superseded } from '../shared/machine';
import { machineForm } from '../shared/settings';
import { FileButtons, Status } from '../shared/result';
import { fromAddress, keep, kept, toAddress } from '../shared/store';
import { Transport } from '../shared/transport';
import { Engraving, type Result } from './engraving';
import { Lanes } from './lanes';
import { Scene } from './scene';

const DRAWINGS: Record<string, string> = { rosette, star, lettering };

const STAGES = ['Planning', 'Engraving'] as const;

const machine = new Machine(wasm);
const status = new Status();
const progress = element('progress', HTMLProgressElement);
const drawing = element('drawing', HTMLSelectElement);
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
});
const chart = new Chart(element('deviation', HTMLElement), 'mm', 180, (seconds) =>
  transport.set(seconds),
);
lanes.onSeek((seconds) => transport.set(seconds));

const settings = machineForm('engrave machine', shipped, changed);

const replan = settled(150, engrave);

/** What is shown is outdated as soon as something is typed. */
function changed(): void {
  files.allow(false);
  status.say(STAGES[0]);
  replan();
}

function svg(): { name: string; svg: string } {
  const text = DRAWINGS[drawing.value];
  if (text !== undefined) return { name: `${drawing.value}.svg`, svg: text };
  return { name: kept('engrave name') ?? 'drawing', svg: kept('engrave drawing') ?? '' };
}

async function engrave(): Promise<void> {
  toAddress({
    drawing: drawing.value === 'own' ? null : drawing.value,
    tolerance: tolerance.value === '0.05' ? null : tolerance.value,
    placement: placement.value || null,
    order: keepOrder.checked ? 'file' : null,
    controller: controller.value === 'pattern' ? null : controller.value,
  });
  machine.stop();
  progress.hidden = false;
  const parameters = {
    ...svg(),
    machine: settings.text,
    tolerance_mm: tolerance.valueAsNumber,
    placement: placement.value || null,
    keep_order: keepOrder.checked,
    controller: controller.value,
  };
  if (Number.isNaN(parameters.tolerance_mm)) {
    refuse('tolerance: no number');
    return;
  }
  try {
    const answer = await machine.call<Result>('engrave', parameters, (stage, fraction) => {
      progress.value = (stage + fraction) / STAGES.length;
      status.say(STAGES[stage] ?? '');
    });
    show(new Engraving(answer));
  } catch (error) {
    if (!(error instanceof Superseded)) refuse(error);
  }
}

function refuse(error: unknown): void {
  progress.hidden = true;
  status.refuse('', error);
  files.allow(false);
}

function show(engraving: Engraving): void {
  progress.hidden = true;
  const { report, summary, isWithinBound } = engraving.result;
  const { duration_s, bound_mm } = engraving.shown;
  const notes = report.notes.map((note) => `note: ${note}`);
  const verdict = isWithinBound
    ? `Engraved in ${duration_s.toFixed(0)} s of the machine's time, within ${bound_mm.toFixed(3)} mm`
    : 'The tool left the drawing by more than the bound';
  status.say([verdict, ...notes].join('\n'), !isWithinBound);
  // Columns are as wide as a terminal; here they would be broken.
  element('summary', HTMLElement).textContent = summary.replace(/ {3,}/g, '  ');
  files.allow(true);
  scene.show(engraving);
  lanes.show(engraving);
  const [seconds, distance] = engraving.deviation;
  const bound = seconds.map(() => bound_mm);
  chart.show(
    [
      { label: 'max of each part of the time', colour: 'series-1' },
      { label: 'bound', colour: 'limit', dash: [6, 4] },
    ],
    [seconds, distance, bound],
  );
  transport.pause();
  transport.begin(duration_s);
  element('main', HTMLElement).dataset.ready = '';
}

async function own(file: File): Promise<void> {
  keep('engrave drawing', await file.text());
  keep('engrave name', file.name);
  offerOwn(file.name);
  drawing.value = 'own';
  changed();
}

function offerOwn(name: string): void {
  const option = drawing.querySelector<HTMLOptionElement>('option[value=own]');
  if (!option) return;
  option.hidden = false;
  option.textContent = name;
}

function begin(): void {
  const ownName = kept('engrave name');
  if (ownName) offerOwn(ownName);
  const asked = fromAddress('drawing');
  drawing.value = asked && asked in DRAWINGS ? asked : ownName ? 'own' : 'rosette';
  tolerance.value = fromAddress('tolerance') ?? '0.05';
  placement.value = fromAddress('placement') ?? '';
  keepOrder.checked = fromAddress('order') === 'file';
  controller.value = fromAddress('controller') === 'timed' ? 'timed' : 'pattern';

  element('input', HTMLFormElement).addEventListener('submit', (event) => event.preventDefault());
  for (const input of [drawing, controller, tolerance, placement, keepOrder]) {
    input.addEventListener('input', changed);
  }
  takeFiles(element('drop', HTMLElement), element('file', HTMLInputElement), own);
  engrave();
}

begin();
