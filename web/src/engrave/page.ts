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
import { create, element, save, settled, takeFiles } from '../shared/dom';
import { Machine, Superseded } from '../shared/machine';
import { SettingsForm } from '../shared/settings';
import { fromAddress, keep, kept, toAddress } from '../shared/store';
import { Transport } from '../shared/transport';
import { Engraving, type Result } from './engraving';
import { Lanes } from './lanes';
import { Scene } from './scene';

const DRAWINGS: Record<string, string> = { rosette, star, lettering };
const FILES = ['pattern.bin', 'pattern.h', 'pulses.vcd', 'engraved.svg', 'report.json'];

const STAGES = ['Planning', 'Engraving'] as const;

const machine = new Machine(wasm);
const status = element('status', HTMLElement);
const progress = element('progress', HTMLProgressElement);
const drawing = element('drawing', HTMLSelectElement);
const tolerance = element('tolerance', HTMLInputElement);
const placement = element('placement', HTMLInputElement);
const keepOrder = element('keep-order', HTMLInputElement);
const files = element('files', HTMLElement);

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

const settings = new SettingsForm(element('settings', HTMLElement), () => {
  keep('engrave machine', settings.text === shipped ? null : settings.text);
  changed();
});

const replan = settled(150, engrave);

/** What is shown is outdated as soon as something is typed. */
function changed(): void {
  allowFiles(false);
  say(STAGES[0]);
  replan();
}

function allowFiles(isAllowed: boolean): void {
  for (const button of files.querySelectorAll('button')) button.disabled = !isAllowed;
}

function say(text: string, isBad = false): void {
  status.textContent = text;
  status.classList.toggle('bad', isBad);
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
  });
  machine.stop();
  progress.hidden = false;
  const parameters = {
    ...svg(),
    machine: settings.text,
    tolerance_mm: tolerance.valueAsNumber,
    placement: placement.value || null,
    keep_order: keepOrder.checked,
  };
  if (Number.isNaN(parameters.tolerance_mm)) {
    refuse('tolerance: no number');
    return;
  }
  try {
    const answer = await machine.call<Result>('engrave', parameters, (stage, fraction) => {
      progress.value = (stage + fraction) / STAGES.length;
      say(STAGES[stage] ?? '');
    });
    show(new Engraving(answer));
  } catch (error) {
    if (!(error instanceof Superseded))
      refuse(error instanceof Error ? error.message : String(error));
  }
}

function refuse(message: string): void {
  progress.hidden = true;
  say(message, true);
  allowFiles(false);
}

function show(engraving: Engraving): void {
  progress.hidden = true;
  const { report, summary, isWithinBound } = engraving.result;
  const notes = report.notes.map((note) => `note: ${note}`);
  const verdict = isWithinBound
    ? `Engraved in ${report.duration_s.toFixed(0)} s of the machine's time, within ${report.bound_mm.toFixed(3)} mm`
    : 'The tool left the drawing by more than the bound';
  say([verdict, ...notes].join('\n'), !isWithinBound);
  element('summary', HTMLElement).textContent = summary;
  allowFiles(true);
  scene.show(engraving);
  lanes.show(engraving);
  const [seconds, distance] = engraving.deviation;
  const bound = seconds.map(() => report.bound_mm);
  chart.show(
    [
      { label: 'max of each part of the time', colour: 'series-1' },
      { label: 'bound', colour: 'limit', dash: [6, 4] },
    ],
    [seconds, distance, bound],
  );
  transport.pause();
  transport.begin(report.duration_s);
  element('main', HTMLElement).dataset.ready = '';
}

async function saveFile(name: string): Promise<void> {
  try {
    const { blobs } = await machine.call('engrave.file', name);
    if (blobs.file) save(name, blobs.file);
  } catch (error) {
    if (error instanceof Error) say(`${name}: ${error.message}`, true);
  }
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
  settings.text = kept('engrave machine') ?? shipped;

  element('input', HTMLFormElement).addEventListener('submit', (event) => event.preventDefault());
  for (const input of [drawing, tolerance, placement, keepOrder]) {
    input.addEventListener('input', changed);
  }
  takeFiles(element('drop', HTMLElement), element('file', HTMLInputElement), own);
  const machineFile = element('machine-file', HTMLInputElement);
  takeFiles(element('settings', HTMLElement), machineFile, async (file) =>
    settings.replace(await file.text()),
  );
  element('default-machine', HTMLButtonElement).addEventListener('click', () =>
    settings.replace(shipped),
  );
  element('save-machine', HTMLButtonElement).addEventListener('click', () =>
    save('machine.toml', settings.text),
  );
  for (const name of FILES) {
    const button = create('button', { type: 'button', textContent: name, disabled: true });
    button.addEventListener('click', () => saveFile(name));
    files.append(button);
  }
  engrave();
}

begin();
