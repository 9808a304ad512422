// The dancer in the browser: edited by hand, and the same bytes as from the command line.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { assertAccessible, delayed, open, refusal, saved, shoot, VIEWS } from './browser.js';
import { commandLine, file } from './command-line.js';

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/** @param {import('playwright-core').Page} page */
async function danced(page) {
  await page.getByRole('status').filter({ hasText: 'Danced' }).waitFor();
}

test('the shipped score leaves the files of the command line, byte for byte', async () => {
  const { page, done } = await browser.visit('dance.html');
  await danced(page);
  const { folder, text } = commandLine('dance', []);
  for (const name of ['data.h', 'dance.svg', 'dance.vcd', 'report.json']) {
    const bytes = await saved(page, name);
    assert(bytes.equals(readFileSync(join(folder, name))), `${name} differs`);
  }
  const summary = (await page.locator('#summary').textContent()) ?? '';
  assert(text.startsWith(`score.toml: ${summary}`), text);
  await done();
});

test('an edited score is the same to the command line, under another law too', async () => {
  const { page, done } = await browser.visit('dance.html?law=carry&code=4000&time=0');
  await danced(page);
  const bow = page.getByRole('button', { name: 'waist, to -25°, smooth, at 2 s' });

  // By keys: a frame later, a frame longer, a copy, another motor, and one move less.
  await bow.press('ArrowRight');
  await page.getByRole('button', { name: 'at 2.2 s for 3 s' }).press('Shift+ArrowRight');
  await page.getByRole('button', { name: 'at 2.2 s for 3.2 s' }).press('c');
  const copy = page.getByRole('button', { name: 'at 5.4 s for 3.2 s' });
  await page.locator('#status.bad').filter({ hasText: 'before move' }).waitFor();
  assert(await page.locator('.move.bad').count());
  await copy.press('Delete');
  await danced(page);

  // By a pointer: dragged, and stretched at its end.
  await page.getByRole('slider', { name: 'Zoom' }).fill('20');
  /**
   * Drags a block by a place in it.
   * @param {string} name
   * @param {(width: number) => number} from
   * @param {number} by
   */
  async function drag(name, from, by) {
    const box = await page.getByRole('button', { name }).boundingBox();
    assert(box);
    const x = box.x + from(box.width);
    await page.mouse.move(x, box.y + 10);
    await page.mouse.down();
    await page.mouse.move(x + by, box.y + 10, { steps: 4 });
    await page.mouse.up();
  }
  await drag('at 2.2 s for 3.2 s', () => 10, -20);
  await drag('at 1.2 s for 3.2 s', (width) => width - 3, 20);
  await page.getByRole('button', { name: 'at 1.2 s for 4.2 s' }).click();

  // By the fields.
  await page.getByLabel('Value', { exact: true }).fill('-30');
  await page.getByLabel('Value', { exact: true }).press('Tab');
  await page.getByRole('button', { name: 'waist, to -30°' }).waitFor();
  await page.getByRole('button', { name: 'Add a move' }).click();
  await page.getByLabel('Start in s').fill('20');
  await page.getByLabel('Start in s').press('Tab');
  await page.locator('#action').selectOption('speed');
  await danced(page);
  const score = file('score.toml', await saved(page, 'Save score.toml'));
  const { folder } = commandLine('dance', [
    '--score',
    score,
    '--law',
    'carry',
    '--code-bytes',
    '4000',
  ]);
  for (const name of ['data.h', 'report.json']) {
    assert((await saved(page, name)).equals(readFileSync(join(folder, name))), `${name} differs`);
  }

  // Kept, and taken back.
  await page.reload();
  await page.getByRole('button', { name: 'waist, to -30°' }).waitFor();
  await page.getByRole('button', { name: 'As shipped' }).click();
  await page.getByRole('button', { name: 'waist, to -25°, smooth, at 2 s' }).waitFor();
  await page.getByRole('button', { name: 'Undo' }).click();
  await page.getByRole('button', { name: 'waist, to -30°' }).waitFor();
  await danced(page);
  await done();
});

test('what is refused is said as on the command line, and the page lives on', async () => {
  const { page, done } = await browser.visit('dance.html');
  await danced(page);
  for (const text of [
    'title = "no motor"\n',
    'motor = [{ name = "a", half_step_deg = 0.9 }]\nmove = [\n{ motor = "b", at_s = 0, for_s = 1, speed = 9 }]\n',
    'motor = [\n',
  ]) {
    const score = file('broken.toml', text);
    await page.locator('#file').setInputFiles(score);
    const status = page.locator('#status.bad').filter({ hasText: 'broken.toml' });
    await status.waitFor();
    const said = (await status.textContent()) ?? '';
    const printed = commandLine('dance', ['--score', score]).text.trim();
    assert(printed.endsWith(said.replace('broken.toml', score)), `${said}\n${printed}`);
    await page.getByRole('button', { name: 'As shipped' }).click();
    await danced(page);
  }
  const fast = page.getByRole('button', { name: 'waist, to -25°, smooth, at 2 s' });
  await fast.click();
  await page.getByLabel('Length in s').fill('0.2');
  await page.getByLabel('Length in s').press('Tab');
  const status = page.locator('#status.bad').filter({ hasText: 'needs a speed' });
  await status.waitFor();
  const score = file('score.toml', await saved(page, 'Save score.toml'));
  const printed = commandLine('dance', ['--score', score]).text.trim();
  const said = (await status.textContent()) ?? '';
  assert(printed.endsWith(said.replace('score.toml', score)), `${said}\n${printed}`);
  await page.keyboard.press('Control+z');
  await page.getByRole('button', { name: 'Undo' }).click();
  await danced(page);
  await done();
});

test('music lies under the lanes; what is no music is refused', async () => {
  const { page, done } = await browser.visit('dance.html');
  await danced(page);
  await page.locator('#music').setInputFiles(file('tone.wav', tone(2)));
  await page.locator('canvas.wave').waitFor();
  assert.equal(await page.locator('canvas.wave').evaluate((it) => it.style.width), '48px');
  await page.locator('#music').setInputFiles(file('no.wav', 'no music'));
  await page.locator('#status.bad').filter({ hasText: 'no.wav' }).waitFor();
  await done();
});

test('music goes on from the time that is set while it plays', async () => {
  const script = `const Sound = Audio;
    window.Audio = class extends Sound {
      constructor() {
        super();
        window.sound = this;
      }
    };`;
  const { page, done } = await browser.visit('dance.html?time=0', { script });
  await danced(page);
  await page.locator('#music').setInputFiles(file('tone.wav', tone(60)));
  await page.locator('canvas.wave').waitFor();
  await page.getByRole('button', { name: 'Play' }).click();
  await page.waitForFunction('!sound.paused');
  await page.getByLabel('Time', { exact: true }).fill('40');
  await page.waitForFunction('sound.currentTime >= 40');
  await page.getByRole('combobox', { name: 'Speed', exact: true }).selectOption('4');
  await page.waitForFunction('sound.playbackRate === 4');
  // After its end, and faster than browsers play, it is silent.
  await page.getByLabel('Time', { exact: true }).fill('200');
  await page.waitForFunction('sound.paused');
  await done();
});

test('the time on show is in sight on the lanes, and told under the charts', async () => {
  const { page, done } = await browser.visit('dance.html');
  await danced(page);
  await page.getByLabel('Time', { exact: true }).fill('200');
  const seen = await page.locator('#timeline').boundingBox();
  const now = await page.locator('#timeline .now').boundingBox();
  assert(seen && now && now.x > seen.x && now.x < seen.x + seen.width);
  await page.locator('#angles').getByText('200.00 s').waitFor();
  await done();
});

/**
 * A tone as a WAV file.
 * @param {number} seconds
 */
function tone(seconds) {
  const samples = 8000 * seconds;
  const bytes = Buffer.alloc(44 + samples, 128);
  bytes.write('RIFF', 0);
  bytes.writeUInt32LE(36 + samples, 4);
  bytes.write('WAVEfmt ', 8);
  for (const [offset, value] of /** @type {const} */ ([
    [16, 16],
    [24, 8000],
    [28, 8000],
    [40, samples],
  ])) {
    bytes.writeUInt32LE(value, offset);
  }
  for (const [offset, value] of /** @type {const} */ ([
    [20, 1],
    [22, 1],
    [32, 1],
    [34, 8],
  ])) {
    bytes.writeUInt16LE(value, offset);
  }
  bytes.write('data', 36);
  for (let index = 0; index < samples; index += 1) bytes[44 + index] = 128 + 100 * Math.sin(index);
  return bytes;
}

test('what comes of an older input does not hide a refusal', async () => {
  const { page, done } = await browser.visit('dance.html', { script: delayed('dance') });
  await page.waitForTimeout(300);
  await page.getByLabel('Code in bytes').fill('');
  await refusal(page, 'Code in bytes: a number is needed');
  await page.waitForTimeout(1500);
  assert.match((await page.locator('#status').textContent()) ?? '', /^Code in bytes: /);
  await done();
});

test('what comes of an older input is not shown while a newer one waits', async () => {
  // A second and a half from a change to its run, one more to its answer.
  const script = `${delayed('dance')}
    const timer = window.setTimeout;
    window.setTimeout = (then, ms) => timer(then, ms === 100 ? 1500 : ms);`;
  const { page, done } = await browser.visit('dance.html', { script });
  await danced(page);
  await page.locator('#law').selectOption('carry');
  await page.waitForURL(/law=carry/);
  await page.locator('#law').selectOption('signed');
  await page.locator('#files button:enabled').first().waitFor();
  assert.match(page.url(), /law=signed/);
  await done();
});

test('a score is read although the machine has another one to dance', async () => {
  const { page, done } = await browser.visit('dance.html', { script: delayed('dance.read') });
  await danced(page);
  await page.getByRole('button', { name: 'waist, to -25°, smooth, at 2 s' }).press('Delete');
  await page.getByRole('button', { name: 'As shipped' }).click();
  await page.locator('#law').selectOption('carry');
  await page.getByRole('button', { name: 'waist, to -25°, smooth, at 2 s' }).waitFor();
  await danced(page);
  await done();
});

for (const { scheme, size, viewport } of VIEWS) {
  test(`it is readable: ${scheme}, ${size}`, async () => {
    const { page, done } = await browser.visit('dance.html', { viewport, colorScheme: scheme });
    await danced(page);
    await page.getByLabel('Time', { exact: true }).fill('24.6');
    await page.getByRole('button', { name: 'left arm, to 80°' }).click();
    await assertAccessible(page);
    assert.equal(await page.evaluate('document.documentElement.scrollWidth'), viewport.width);
    await shoot(page, `dance-${scheme}-${size}`);
    await done();
  });
}
