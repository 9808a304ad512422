// The page of the dancer: the score in the middle, what the robot makes of it above.
import '../shared/style.css';
import './dance.css';
import '../shared/link';
import '../shared/offline';
import shipped from '../../../machines/dancer/score.toml?raw';
import wasm from '../../built/dance.wasm?url';
import { Chart } from '../shared/chart';
import { element, onClick, save, settled, takeFiles } from '../shared/dom';
import { AddressFields } from '../shared/fields';
import { Machine, Superseded } from '../shared/machine';
import { FileButtons, Status } from '../shared/result';
import {
  intoAddress,
  intoLink,
  isLinked,
  keep,
  kept,
  linkChanged,
  numbersFromLink,
  textFromLink,
  toAddress,
  Trial,
} from '../shared/store';
import { Transport } from '../shared/transport';
import { Dance, type Result } from './dance';
import { Inspector } from './inspector';
import { Music } from './music';
import { Robot } from './robot';
import { liveliest, type Move, type Score, snap, toText } from './score';
import { Timeline } from './timeline';

interface Refused {
  refused: { message: string; move: number | null };
}

/** Of an AT89C52. */
const MEMORY_BYTES = 8192;
/** Of the dance that is shown when the page opens, as fast as it is. */
const OPENING_S = 8;
const KEPT = 'dance score';

const machine = new Machine(wasm);
const status = new Status();
const names = ['data.h', 'dance.svg', 'dance.vcd', 'report.json'];
const files = new FileButtons(machine, 'dance.file', names, status);
const law = element('law', HTMLSelectElement);
const code = element('code', HTMLInputElement);

let text = shipped;
let score: Score = { motor: [] };
let selected: number | undefined;
/** The move that is refused. */
let bad: number | undefined;
let dance: Dance | undefined;
/** Texts that the machine reads now. */
let reading = 0;
/** Texts that can be taken back to. */
const before: string[] = [];

const music = new Music();
const robot = new Robot(element('robot', HTMLCanvasElement));
const transport = new Transport(
  (seconds) => {
    robot.at(seconds);
    timeline.at(seconds);
    chart.at(seconds);
    apart.at(seconds);
  },
  {
    playing: (isPlaying, seconds, rate) => (isPlaying ? music.play(seconds, rate) : music.pause()),
    speeds: [1, 4, 20],
    speed: 1,
  },
);
const seek = (seconds: number) => transport.set(seconds);
const chart = new Chart(element('angles', HTMLElement), '°', 200, seek);
const apart = new Chart(element('apart', HTMLElement), '°', 140, seek);
const zoom = element('zoom', HTMLInputElement);
const timeline = new Timeline(element('timeline', HTMLElement), music.canvas, Number(zoom.value), {
  select: (index) => {
    selected = index;
    linkChanged();
    draw();
  },
  change: (index, change) => edit((moves) => Object.assign(moves[index] ?? {}, change), index),
  copy,
  remove,
  seek,
});
const inspector = new Inspector((move) => {
  const index = selected;
  if (index !== undefined) edit((moves) => moves.splice(index, 1, move), index);
});
const fields = new AddressFields({ law, code }, changed);
const looks = new AddressFields({ zoom }, () => {
  timeline.zoom = Number(zoom.value);
  music.stretch(timeline.zoom);
  linkChanged();
});
intoAddress(() => looks.values);
const trial = new Trial(KEPT);
const perform = settled(100, run);

function draw(): void {
  timeline.show(score, selected, bad);
  music.stretch(timeline.zoom);
  inspector.show(score, selected);
  showAngles();
  for (const id of ['copy', 'delete']) {
    element(id, HTMLButtonElement).disabled = selected === undefined;
  }
  element('undo', HTMLButtonElement).disabled = before.length === 0;
}

/** Changes the moves; what was before can be taken back. */
function edit(change: (moves: Move[]) => void, then: number | undefined): void {
  before.push(text);
  score.move ??= [];
  change(score.move);
  text = toText(score);
  selected = then;
  changed();
}

function changed(): void {
  // To stop the machine were to lose what it reads.
  if (reading === 0) machine.stop();
  keep(KEPT, text === shipped ? null : text);
  bad = undefined;
  files.allow(false);
  status.say('Dancing');
  draw();
  perform();
}

/** The same move again, right after it and its repetitions. */
function copy(index: number): void {
  const move = score.move?.[index];
  if (!move) return;
  const last = move.at_s + ((move.repeat ?? 1) - 1) * (move.every_s ?? 0);
  const again = { ...move, at_s: snap(score, last + move.for_s) };
  edit((moves) => moves.splice(index + 1, 0, again), index + 1);
  timeline.focus(index + 1);
}

function remove(index: number): void {
  edit((moves) => moves.splice(index, 1), undefined);
  element('timeline', HTMLElement).focus();
}

function add(): void {
  const motor = score.move?.[selected ?? 0]?.motor ?? score.motor[0]?.name ?? '';
  const at_s = snap(score, transport.seconds);
  const index = score.move?.length ?? 0;
  edit((moves) => moves.push({ motor, at_s, for_s: 2, turn_deg: 45, easing: 'smooth' }), index);
  timeline.focus(index);
}

async function takeBack(): Promise<void> {
  const last = before.pop();
  if (last !== undefined) await read(last, 'score.toml');
}

/** Takes a text as the score, if it is one. */
async function read(given: string, name: string): Promise<boolean> {
  reading += 1;
  try {
    ({ value: score } = await machine.call<Score>('dance.read', given));
  } catch (error) {
    status.refuse(name, error);
    return false;
  } finally {
    reading -= 1;
  }
  text = given;
  selected = undefined;
  changed();
  return true;
}

/** Another score, by hand. */
async function open(given: string, name: string): Promise<void> {
  const last = text;
  if (!(await read(given, name))) return;
  before.push(last);
  draw();
}

async function run(): Promise<void> {
  if (reading > 0) {
    perform();
    return;
  }
  const turn = machine.stop();
  await toAddress({ score: text === shipped ? 'shipped' : 'own', ...fields.values });
  if (!machine.isTurn(turn)) return;
  const parameters = { score: text, law: law.value, code_bytes: code.valueAsNumber };
  if (fields.problem !== undefined) {
    status.refuse('', fields.problem);
    return;
  }
  if (text !== shipped) trial.begin();
  try {
    const { value, blobs } = await machine.call<Result | Refused>('dance', parameters);
    if ('refused' in value) {
      const { message, move } = value.refused;
      bad = move === null ? undefined : move - 1;
      draw();
      refuse(message);
    } else {
      show(new Dance({ value, blobs }));
    }
  } catch (error) {
    if (!(error instanceof Superseded)) refuse(error);
  }
}

function refuse(error: unknown): void {
  ready();
  status.refuse('score.toml', error);
}

/** The machine has answered. */
function ready(): void {
  trial.end();
  element('main', HTMLElement).dataset.ready = '';
}

function show(danced: Dance): void {
  const isFirst = dance === undefined;
  dance = danced;
  const { report, summary, isAsAsked } = danced.result;
  status.tell(
    isAsAsked
      ? `Danced: ${report.frames} frames in ${report.duration_s} s, ${report.bytes_packed} bytes`
      : 'A turn ends more than a half step from what was asked',
    trial.hasFailed ? ['a score of your own ended the page when it was opened last'] : [],
    !isAsAsked,
  );
  element('summary', HTMLElement).textContent = summary;
  const used = report.bytes_packed + report.code_bytes;
  element('memory', HTMLMeterElement).value = used;
  element('memory-note', HTMLElement).textContent =
    `${used} of ${MEMORY_BYTES} bytes: ${report.fits_at89c52 ? 'fits' : 'does not fit'}`;
  files.allow(true);
  robot.show(danced);
  const now = transport.seconds;
  const fromS = liveliest(score, report.duration_s, OPENING_S);
  transport.begin(report.duration_s, {
    fromS,
    toS: Math.min(fromS + OPENING_S, report.duration_s),
  });
  // A move that is changed does not move the time.
  if (!isFirst) transport.set(now);
  draw();
  ready();
}

/** The angle of the chosen move's motor, and how far off it were under the other law. */
function showAngles(): void {
  if (!dance) return;
  const { frames, frameS, result } = dance;
  const danced = dance;
  const name = score.move?.[selected ?? 0]?.motor;
  const found = result.motors.findIndex((it) => it.name === name);
  const motor = Math.max(found, 0);
  element('chart-title', HTMLElement).textContent = `Angle: ${result.motors[motor]?.name}`;
  const each = (value: (frame: number) => number) =>
    Array.from({ length: frames + 1 }, (_, frame) => value(frame));
  const times = each((frame) => frame * frameS);
  const { law: here, other_law: there } = result.report;
  const angle = { label: `angle under the law ${here}`, colour: 'series-1' };
  chart.show([angle], [times, each((frame) => danced.angle(motor, frame))]);
  const away = { label: `difference under the law ${there.law}`, colour: 'series-2' };
  const off = (frame: number) => danced.otherAngle(motor, frame) - danced.angle(motor, frame);
  apart.show([away], [times, each(off)]);
}

async function openMusic(file: File): Promise<void> {
  try {
    await music.open(file);
    music.stretch(timeline.zoom);
  } catch {
    status.refuse(file.name, 'this browser cannot decode it');
  }
}

function begin(): void {
  onClick('add', add);
  onClick('copy', () => selected !== undefined && copy(selected));
  onClick('delete', () => selected !== undefined && remove(selected));
  onClick('undo', takeBack);
  onClick('save-score', () => save('score.toml', text));
  onClick('shipped', () => open(shipped, 'score.toml'));
  document.addEventListener('keydown', (event) => {
    const isUndo = (event.ctrlKey || event.metaKey) && event.key === 'z';
    if (!isUndo || event.target instanceof HTMLInputElement) return;
    event.preventDefault();
    takeBack();
  });
  takeFiles(element('drop', HTMLElement), element('file', HTMLInputElement), async (file) => {
    if (file.type.startsWith('audio/')) openMusic(file);
    else open(await file.text(), file.name);
  });
  takeFiles(element('robot', HTMLElement), element('music', HTMLInputElement), openMusic);
  timeline.zoom = Number(zoom.value);
  intoLink('score', () => (text === shipped ? undefined : text));
  intoLink('selected', () => (selected === undefined ? undefined : [selected]));
  beginWith(textFromLink('score') ?? (isLinked ? null : kept(KEPT)));
}

/** The score that is asked for, unless it has ended the page, or the one that is shipped. */
async function beginWith(asked: string | null): Promise<void> {
  const [index] = numbersFromLink('selected', 1) ?? [];
  if (asked === null || trial.hasFailed) await read(shipped, 'score.toml');
  else if (!(await read(asked, 'score.toml'))) ready();
  selected = index !== undefined && score.move?.[index] ? index : undefined;
  draw();
}

begin();
