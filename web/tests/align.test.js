// The alignment platform in the browser: the operator's files are those of the command line, and the
// pendant is in one's own hands.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { assertAccessible, open, refusal, saved, shoot, VIEWS } from './browser.js';
import { commandLine, file } from './command-line.js';

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/** @param {import('playwright-core').Page} page */
async function aligned(page) {
  await page.getByRole('status').filter({ hasText: 'Aligned in' }).waitFor();
}

/**
 * Asserts that the page saves what a run of the command line left.
 * @param {import('playwright-core').Page} page
 * @param {{ folder: string }} run
 * @param {string} table
 */
async function assertSameFiles(page, { folder }, table) {
  for (const name of [table, 'align.svg', 'jog.svg', 'line.log', 'report.json']) {
    const bytes = await saved(page, name);
    assert(bytes.equals(readFileSync(join(folder, name))), `${name} differs`);
  }
}

test('the shipped pose leaves the files of the command line, byte for byte', async () => {
  const { page, done } = await browser.visit('align.html');
  await aligned(page);
  const run = commandLine('align', []);
  await assertSameFiles(page, run, 'pvt.csv');
  assert(await page.getByRole('button', { name: 'pt.csv', exact: true }).isDisabled());
  const summary = (await page.locator('#summary').textContent()) ?? '';
  assert(run.text.includes(summary), run.text);
  await done();
});

test('sliders and table stay in the address', async () => {
  const { page, done } = await browser.visit('align.html?to=10,0,1200,0,0,0.5&mode=pt');
  await aligned(page);
  await page.getByLabel('y in mm, slider').fill('-12.5');
  await page.waitForURL(/to=10%2C-12\.5%2C1200/);
  await aligned(page);
  const run = commandLine('align', ['--to', '10 -12.5 1200 0 0 0.5', '--mode', 'pt']);
  await assertSameFiles(page, run, 'pt.csv');
  await page.getByRole('button', { name: 'As shipped' }).first().click();
  await page.waitForURL(/^(?!.*to=)/);
  await aligned(page);
  assert.equal(await page.getByLabel('y in mm', { exact: true }).inputValue(), '-20');
  await done();
});

test('what is refused is said as on the command line, and the page lives on', async () => {
  const { page, done } = await browser.visit('align.html');
  await aligned(page);
  const z = page.getByLabel('z in mm', { exact: true });
  await z.fill('1900');
  const said = await refusal(page, 'out of reach');
  const run = commandLine('align', ['--to', '35 -20 1900 1.2 -0.8 2.5']);
  assert.equal(run.status, 1);
  assert(run.text.trim().endsWith(said), `${said}\n${run.text}`);
  await z.fill('');
  await refusal(page, 'six numbers');
  await z.fill('1240');
  await aligned(page);
  await page.locator('summary').filter({ hasText: 'Machine' }).click();
  await page.getByLabel('full jog mm s').fill('50');
  assert.match(await refusal(page, 'platform.toml'), /full_jog_mm_s = 50/);
  await page.getByLabel('full jog mm s').fill('5');
  await aligned(page);
  const platform = file('platform.toml', await saved(page, 'Save the machine file'));
  await assertSameFiles(page, commandLine('align', ['--platform', platform]), 'pvt.csv');
  await done();
});

test('the pendant is used by keys alone: a locator is jogged, and stands when it is let go', async () => {
  const { page, done } = await browser.visit('align.html');
  await aligned(page);
  const display = page.locator('#display');
  /** @param {string} text */
  const shows = (text) => display.filter({ hasText: text }).waitFor();
  await page.getByRole('button', { name: 'Switch on' }).press('Enter');
  await shows('>LOCATOR  1 IDLE');
  await page.getByRole('button', { name: 'Enter' }).press('Enter');
  await shows('SPEED');
  const wheel = page.getByRole('slider', { name: 'Wheel' });
  await page.getByLabel('Multiplier').selectOption('3');
  await shows('x100');
  await wheel.press('PageUp');
  await shows('ENABLE SWITCHES?');
  await page.getByLabel('Both enabling switches').press('Space');
  await page.locator('.led.on').waitFor();
  for (let press = 0; press < 6; press += 1) await wheel.press('PageUp');
  await page.waitForFunction(
    "/X +\\+(?!0\\.000)[\\d.]+ mm/.test(document.getElementById('display').textContent)",
  );
  await shoot(page, 'align-pendant');
  await page.getByLabel('Both enabling switches').press('Space');
  await page.locator('.led.off').waitFor();
  // It brakes.
  await page.waitForTimeout(1000);
  const rest = await display.textContent();
  await page.waitForTimeout(400);
  assert.equal(await display.textContent(), rest);
  await page.getByRole('button', { name: 'Switch off' }).press('Enter');
  assert.equal(await display.textContent(), '');
  await done();
});

test('a pendant that is clicked twice is off again, and can be switched on', async () => {
  const { page, done } = await browser.visit('align.html');
  await aligned(page);
  const display = page.locator('#display');
  await page.locator('#power').dblclick();
  // The pendant's machine has answered by then.
  await page.waitForTimeout(500);
  assert.equal(await display.textContent(), '');
  await page.getByRole('button', { name: 'Switch on' }).click();
  await display.filter({ hasText: '>LOCATOR  1 IDLE' }).waitFor();
  await done();
});

for (const { scheme, size, viewport } of VIEWS) {
  test(`it is readable: ${scheme}, ${size}`, async () => {
    const { page, done } = await browser.visit('align.html', { viewport, colorScheme: scheme });
    await aligned(page);
    await page.getByLabel('Time', { exact: true }).fill('6');
    await page.getByRole('button', { name: 'Switch on' }).click();
    await page.locator('#display').filter({ hasText: 'SINGLE' }).waitFor();
    await page.locator('summary').filter({ hasText: 'Machine' }).click();
    await assertAccessible(page);
    assert.equal(await page.evaluate('document.documentElement.scrollWidth'), viewport.width);
    await page.locator('summary').filter({ hasText: 'Machine' }).click();
    await shoot(page, `align-${scheme}-${size}`);
    await done();
  });
}
