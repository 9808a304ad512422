// The Delta robot in the browser: the same steps as from the command line, points dragged, calibration.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { assertAccessible, delayed, open, refusal, ROOT, saved, shoot, VIEWS } from './browser.js';
import { commandLine, file } from './command-line.js';

const INPUTS = join(ROOT, 'machines/delta/inputs');

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/** @param {import('playwright-core').Page} page */
async function driven(page) {
  await page.getByRole('status').filter({ hasText: 'Driven in' }).waitFor();
}

/**
 * Asserts that the page saves what a run of the command line left.
 * @param {import('playwright-core').Page} page
 * @param {{ folder: string }} run
 */
async function assertSameFiles(page, { folder }) {
  for (const name of ['steps.csv', 'delta.svg', 'report.json']) {
    const bytes = await saved(page, name);
    assert(bytes.equals(readFileSync(join(folder, name))), `${name} differs`);
  }
}

test('the shipped points leave the files of the command line, byte for byte', async () => {
  const { page, done } = await browser.visit('delta.html');
  await driven(page);
  const run = commandLine('delta', []);
  await assertSameFiles(page, run);
  const summary = (await page.locator('#summary').textContent()) ?? '';
  assert(run.text.includes(summary), run.text);
  await done();
});

test('a machine whose load is known is chosen, its torque and its tool are shown', async () => {
  const { page, done } = await browser.visit('delta.html');
  await driven(page);
  assert(await page.locator('#torque-used').isHidden());
  const text = '0 0 -230 300\n40 0 -230 300\n';
  await page.getByLabel('Points', { exact: true }).fill(text);
  await page.locator('#machine-choice').selectOption('loaded');
  await page.locator('#summary').filter({ hasText: 'vibration: the tool (40.0 Hz)' }).waitFor();
  assert(await page.locator('#torque-used canvas').isVisible());
  assert(await page.locator('#vibration canvas').isVisible());
  const loaded = ['--geometry', join(ROOT, 'machines/delta/loaded.toml')];
  const input = ['--input', file('points.txt', text)];
  await assertSameFiles(page, commandLine('delta', [...input, ...loaded]));
  await shoot(page, 'delta-loaded');
  // It is in the address, and one of its numbers changed is one's own.
  await page.reload();
  await driven(page);
  const chosen = page.locator('#machine-choice');
  assert.equal(await chosen.inputValue(), 'loaded');
  await page.getByText('Machine', { exact: true }).click();
  await page.getByLabel('payload kg').fill('0.5');
  await driven(page);
  assert.equal(await chosen.inputValue(), 'own');
  await page.getByLabel('payload kg').fill('-1');
  assert.match(await refusal(page, 'machine.toml'), /payload is -1/);
  await chosen.selectOption('published');
  await driven(page);
  assert(await page.locator('#torque-used').isHidden());
  await done();
});

test('motion and input stay in the address; a point is dragged in the view from above', async () => {
  const { page, done } = await browser.visit('delta.html?motion=trains&load=250');
  await driven(page);
  const lines = page.getByLabel('Points', { exact: true });
  await lines.fill('0 0 -230 100\n40 0 -230 100 # the other end\n');
  await driven(page);
  await page.getByRole('button', { name: 'Above' }).click();
  // The dot of the second point: found by its place to the right of the middle.
  const box = await page.locator('#scene').boundingBox();
  assert(box);
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  let isHeld = false;
  for (let by = 0; by < box.width / 3 && !isHeld; by += 8) {
    await page.mouse.move(x + by, y);
    await page.mouse.down();
    await page.mouse.move(x + by + 1, y - 20, { steps: 3 });
    await page.mouse.up();
    isHeld = !(await lines.inputValue()).startsWith('0 0 -230 100\n40 0 ');
    if (!isHeld) await page.getByRole('button', { name: 'Above' }).click();
  }
  assert(isHeld, await lines.inputValue());
  await driven(page);
  const text = await lines.inputValue();
  assert.match(text, / -230 100 # the other end\n$/);
  const input = ['--input', file('points.txt', text), '--motion', 'trains'];
  await assertSameFiles(page, commandLine('delta', input));
  await page.reload();
  await driven(page);
  assert.equal(await lines.inputValue(), text);
  await done();
});

test('what is refused is said as on the command line, at its line, and the page lives on', async () => {
  const { page, done } = await browser.visit('delta.html');
  await driven(page);
  const lines = page.getByLabel('Points', { exact: true });
  const text = '0 0 -230\n300 0 -230\n10 x -230\n20 0 -240\n';
  await lines.fill(text);
  const said = await refusal(page, 'lines refused');
  // The page goes on to the next line, as the command line does when it is told to.
  const run = commandLine('delta', ['--skip', '--input', file('points.txt', text)]);
  assert.equal(run.status, 1);
  assert(run.text.trim().endsWith(said), `${said}\n${run.text}`);
  assert.equal(await page.locator('#lines .bad').count(), 2);
  await assertSameFiles(page, run);
  await shoot(page, 'delta-refused');
  await page.getByLabel('Shipped points').selectOption('spiral');
  await driven(page);
  const spiral = ['--input', join(INPUTS, 'spiral.txt')];
  await assertSameFiles(page, commandLine('delta', spiral));
  await page.getByText('Machine', { exact: true }).click();
  await page.getByLabel('upper mm').fill('-1');
  assert.match(await refusal(page, 'machine.toml'), /-1/);
  await page.getByLabel('upper mm').fill('120');
  await driven(page);
  await done();
});

test('measured points calibrate the machine, and what is wrong with them is said', async () => {
  const { page, done } = await browser.visit('delta.html');
  await driven(page);
  await page.getByText('Calibrate', { exact: true }).first().click();
  const measured = page.getByLabel('Measured points');
  const calibrate = page.getByRole('button', { name: 'Calibrate' });
  const found = page.locator('#calibrated');
  await measured.fill('0 0 0 0 0 -200\n1 2 3\n');
  await calibrate.click();
  await found.filter({ hasText: 'line 2: 3 numbers' }).waitFor();
  assert.equal(await page.locator('#measured .bad').count(), 1);
  await page.getByRole('button', { name: 'Example' }).click();
  await page.getByLabel('Fit').selectOption('lower');
  await calibrate.click();
  await found.filter({ hasText: '24 points: ' }).waitFor();
  assert.match((await found.textContent()) ?? '', /zero of arm 1: \+0\.(29|30|31)\d+ deg/);
  await shoot(page, 'delta-calibrated');
  await page.getByRole('button', { name: 'Use in the machine' }).click();
  await driven(page);
  await page.getByText('Machine', { exact: true }).click();
  const machine = file('machine.toml', await saved(page, 'Save the machine file'));
  await assertSameFiles(page, commandLine('delta', ['--geometry', machine]));
  assert.equal(await page.getByLabel('home deg').count(), 4);
  await done();
});

test('a calibration that an input has ended is not lost in silence', async () => {
  const { page, done } = await browser.visit('delta.html', { script: delayed('delta.calibrate') });
  await driven(page);
  await page.getByText('Calibrate', { exact: true }).first().click();
  await page.getByRole('button', { name: 'Example' }).click();
  await page.getByRole('button', { name: 'Calibrate' }).click();
  await page.getByLabel('Load in g').fill('250');
  await page.locator('#calibrated').filter({ hasText: 'calibrate again' }).waitFor();
  await driven(page);
  await done();
});

test('time and view are set by keys alone', async () => {
  const { page, done } = await browser.visit('delta.html');
  await driven(page);
  const shown = () => page.locator('#shown-time').textContent();
  const end = await shown();
  await page.getByLabel('Time', { exact: true }).press('Home');
  assert.notEqual(await shown(), end);
  const scene = page.locator('#scene');
  const other = "document.getElementById('scene').toDataURL() !== picture";
  const look = "picture = document.getElementById('scene').toDataURL()";
  for (const key of ['ArrowLeft', 'ArrowDown', '+', '0']) {
    await page.evaluate(look);
    await scene.press(key);
    await page.waitForFunction(other);
  }
  await page.evaluate(look);
  await page.getByRole('button', { name: 'Front' }).press('Enter');
  await page.waitForFunction(other);
  await shoot(page, 'delta-front');
  await done();
});

for (const { scheme, size, viewport } of VIEWS) {
  test(`it is readable: ${scheme}, ${size}`, async () => {
    const { page, done } = await browser.visit('delta.html', { viewport, colorScheme: scheme });
    await driven(page);
    await page.getByLabel('Time', { exact: true }).fill('3');
    for (const name of ['Calibrate', 'Machine']) {
      await page.locator('summary').filter({ hasText: name }).click();
    }
    await assertAccessible(page);
    assert.equal(await page.evaluate('document.documentElement.scrollWidth'), viewport.width);
    for (const name of ['Calibrate', 'Machine']) {
      await page.locator('summary').filter({ hasText: name }).click();
    }
    await shoot(page, `delta-${scheme}-${size}`);
    await done();
  });
}
