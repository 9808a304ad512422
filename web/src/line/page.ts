// The page of the serial line: a capture, two simulated stations, or real ports.
import '../shared/style.css';
import './line.css';
import '../shared/link';
import '../shared/offline';
import wasm from '../../built/line.wasm?url';
import { element } from '../shared/dom';
import { Machine } from '../shared/machine';
import { Status } from '../shared/result';
import { fromAddress, toAddress } from '../shared/store';
import { Capture } from './capture';
import { Desk, type View } from './desk';
import { Live } from './live';
import { Simulation } from './simulation';

const desk = new Desk(new Machine(wasm), new Status());
const capture = new Capture(desk);
const simulation = new Simulation(desk);
const live = new Live(desk);
const views: Record<string, View> = { capture, simulate: simulation, port: live };
const begun = new Set<string>();

async function show(name: string): Promise<void> {
  const view = views[name];
  if (!view) return;
  toAddress({ view: name === 'capture' ? null : name });
  for (const part of document.querySelectorAll<HTMLElement>('[data-view]')) {
    part.hidden = part.dataset.view !== name;
  }
  if (name !== 'simulate') simulation.pause();
  desk.show(view);
  if (begun.has(name)) return;
  begun.add(name);
  if (view === capture) await capture.begin();
  if (view === simulation) await simulation.begin();
}

async function begin(): Promise<void> {
  const asked = fromAddress('view') ?? 'capture';
  const name = Object.hasOwn(views, asked) ? asked : 'capture';
  for (const choice of document.querySelectorAll<HTMLInputElement>('[name="view"]')) {
    choice.checked = choice.value === name;
    choice.addEventListener('change', () => show(choice.value));
  }
  await show(name);
  element('main', HTMLElement).dataset.ready = '';
}

begin();
