// The stage in the browser: the same steps as from the command line, and errors at their lines.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { assertAccessible, open, refusal, ROOT, saved, shoot, VIEWS } from './browser.js';
import { commandLine, file, STAGE_DRAWINGS } from './command-line.js';

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/** @param {import('playwright-core').Page} page */
async function ran(page) {
  await page.getByRole('status').filter({ hasText: 'Run in' }).waitFor();
}

/**
 * Asserts that the page saves what a run of the command line left.
 * @param {import('playwright-core').Page} page
 * @param {{ folder: string }} run
 */
async function assertSameFiles(page, { folder }) {
  for (const name of ['steps.csv', 'stage.svg', 'report.json']) {
    const bytes = await saved(page, name);
    assert(bytes.equals(readFileSync(join(folder, name))), `${name} differs`);
  }
}

test('the test path leaves the files of the command line, byte for byte', async () => {
  const { page, done } = await browser.visit('stage.html');
  await ran(page);
  const run = commandLine('stage', ['--lose-steps', '0.1%']);
  await assertSameFiles(page, run);
  const summary = (await page.locator('#summary').textContent()) ?? '';
  assert(run.text.startsWith(summary), run.text);
  await done();
});

test('a machine whose load is known is chosen, its torque and its tables are shown', async () => {
  const { page, done } = await browser.visit('stage.html?drawing=test&lose=0&tolerance=0.5');
  await ran(page);
  assert(await page.locator('#torque-used').isHidden());
  await page.locator('#machine-choice').selectOption('loaded');
  await page
    .locator('#summary')
    .filter({ hasText: 'vibration: the table of X (45.0 Hz)' })
    .waitFor();
  await ran(page);
  assert(await page.locator('#torque-used canvas').isVisible());
  assert(await page.locator('#vibration').getByText('Y, without shaping').isVisible());
  const program = ['--gcode', join(STAGE_DRAWINGS, 'test.gcode'), '--tolerance', '0.5'];
  const loaded = ['--machine', join(ROOT, 'machines/stage/loaded.toml')];
  await assertSameFiles(page, commandLine('stage', [...program, ...loaded]));
  await shoot(page, 'stage-loaded');
  await done();
});

test('a machine whose load is known stays chosen, is edited, and is as shipped again', async () => {
  const { page, done } = await browser.visit('stage.html?drawing=test&lose=0&tolerance=0.5');
  await ran(page);
  await page.locator('#machine-choice').selectOption('loaded');
  await page.locator('#summary').filter({ hasText: 'vibration: ' }).waitFor();
  await page.reload();
  await ran(page);
  const chosen = page.locator('#machine-choice');
  assert.equal(await chosen.inputValue(), 'loaded');
  await page.getByText('Machine', { exact: true }).click();
  await page.getByLabel('x kg').fill('-1');
  assert.match(await refusal(page, 'machine.toml'), /x_kg = -1 is not zero or above/);
  await chosen.selectOption('published');
  await ran(page);
  assert(await page.locator('#torque-used').isHidden());
  await done();
});

test('settings are those of the command line, and stay in the address', async () => {
  const address = 'stage.html?drawing=rosette&steps=bresenham&lose=0.5&seed=7';
  const { page, done } = await browser.visit(address);
  await ran(page);
  const rosette = ['--gcode', join(STAGE_DRAWINGS, 'rosette.gcode')];
  const lost = ['--lose-steps', '0.5%', '--seed', '7'];
  const ways = ['--steps', 'bresenham'];
  await assertSameFiles(page, commandLine('stage', [...rosette, ...lost, ...ways]));
  await page.getByLabel('Lost steps').fill('0');
  await page.waitForURL(/lose=0(&|$)/);
  await ran(page);
  assert(await page.locator('#corrected').isHidden());
  await done();
});

test('errors are said as on the command line, at their line, and the page lives on', async () => {
  const { page, done } = await browser.visit('stage.html');
  await ran(page);
  const gcode = page.getByLabel('G-code');
  for (const [text, line] of /** @type {const} */ ([
    ['G21 G90\nG1 X10 F600\nG1 Y1O\n', 3],
    ['G21 G90 F600\nG1 X200\n', 2],
    ['G21 G90 F600\nG1 X10\n\nG2 X20 Y0 I1 J1\n', 4],
  ])) {
    await gcode.fill(text);
    const said = await refusal(page, `line ${line}`);
    const path = file('broken.gcode', text);
    const run = commandLine('stage', ['--gcode', path]);
    assert.equal(run.status, 1);
    const expected = said.replace('test.gcode, changed', path);
    assert(run.text.trim().endsWith(expected), `${said}\n${run.text}`);
    const mark = page.locator('#gcode .bad');
    assert.equal(await mark.count(), 1);
    assert.equal(await mark.evaluate((it) => it.style.top), `${20 * (line - 1)}px`);
    assert(await page.getByRole('button', { name: 'steps.csv' }).isDisabled());
  }
  await shoot(page, 'stage-refused');
  await gcode.fill('G21 G90 F600\nG1 X10\nG1 X10 Y10 Z-1\n');
  await ran(page);
  await page.locator('#gcode .note').waitFor();
  assert.match((await page.locator('#status').textContent()) ?? '', /note: line 3: Z/);
  await page.reload();
  await ran(page);
  assert.match(await gcode.inputValue(), /^G21 G90 F600\nG1 X10\n/);
  await done();
});

test('time is played and set by keys alone, and its line is marked', async () => {
  const { page, done } = await browser.visit('stage.html');
  await ran(page);
  const line = () => page.locator('#gcode .now').evaluate((it) => it.style.top);
  assert.equal(await line(), '200px');
  const slider = page.getByLabel('Time', { exact: true });
  await slider.press('Home');
  assert.equal(await line(), '40px');
  await page.getByRole('button', { name: 'Play' }).press('Enter');
  await page.waitForFunction("parseFloat(document.getElementById('shown-time').textContent) > 2");
  await page.getByRole('button', { name: 'Pause' }).press('Enter');
  const scene = page.locator('#scene');
  for (let press = 0; press < 8; press += 1) await scene.press('+');
  await shoot(page, 'stage-near');
  await done();
});

test('the shipped program stays although there is one of the own', async () => {
  const { page, done } = await browser.visit('stage.html');
  await ran(page);
  const gcode = page.getByLabel('G-code');
  await gcode.fill('G21 G90 F600\nG1 X10\n');
  await page.getByLabel('Shipped program').selectOption('test');
  await page.waitForURL(/drawing=test/);
  await page.reload();
  await ran(page);
  assert.match(await gcode.inputValue(), /^; The stage's test path/);
  await page.getByLabel('Shipped program').selectOption('own');
  await ran(page);
  assert.equal(await gcode.inputValue(), 'G21 G90 F600\nG1 X10\n');
  const download = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Save the program' }).click();
  assert.equal((await download).suggestedFilename(), 'test.gcode');
  await done();
});

for (const { scheme, size, viewport } of VIEWS) {
  test(`it is readable: ${scheme}, ${size}`, async () => {
    const { page, done } = await browser.visit('stage.html?lose=1', {
      viewport,
      colorScheme: scheme,
    });
    await ran(page);
    await page.getByLabel('Time', { exact: true }).fill('14');
    await assertAccessible(page);
    assert.equal(await page.evaluate('document.documentElement.scrollWidth'), viewport.width);
    await shoot(page, `stage-${scheme}-${size}`);
    await done();
  });
}
