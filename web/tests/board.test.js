// Stage and Delta operate the boards' firmware, run on this computer or in emulation, through the browser's serial port.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { assertAccessible, open, shoot } from './browser.js';
import { connectFirmware, MOCK } from './serial-mock.js';

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/** @typedef {import('playwright-core').Page} Page */

/**
 * @param {Page} page
 * @param {string | RegExp} text
 */
async function said(page, text) {
  const line = page.locator('#board-said');
  await line
    .filter({ hasText: text })
    .waitFor({ timeout: 90_000 })
    .catch(async () => {
      const events = (await page.locator('#board-events').innerText()).trim();
      assert.fail(`not ${text} but ${await line.textContent()}\n${events}`);
    });
}

/** @param {Page} page */
const place = async (page) =>
  ((await page.locator('#board-place').textContent()) ?? '').match(/-?\d+\.\d+/g)?.map(Number) ??
  [];

/**
 * A page with a board that is homed.
 * @param {import('node:test').TestContext} context
 * @param {string} path
 * @param {string} machine
 */
async function homed(context, path, machine) {
  const { page, done } = await browser.visit('', { script: MOCK });
  context.after(await connectFirmware(page, machine));
  await page.goto(browser.url + path);
  await page.locator('main[data-ready]').waitFor();
  await page.getByText('A board on a serial port').click();
  await page.getByRole('button', { name: 'Connect', exact: true }).click();
  await said(page, 'Connected');
  await page.getByRole('button', { name: 'Run the program' }).click();
  await said(page, 'refused: not homed');
  await page.getByRole('button', { name: 'Home', exact: true }).click();
  await said(page, 'Done.');
  return {
    page,
    close: async () => {
      await page.getByRole('button', { name: 'Disconnect' }).click();
      await said(page, 'Disconnected.');
      await done();
    },
  };
}

const PROGRAM = 'G0 X20 Y20\nG1 X50 F1800\nG2 X60 Y30 I0 J10\nG1 X20 Y60\nM2';

test('a program drives a stage, and is held and stopped', async (context) => {
  const { page, close } = await homed(context, 'stage.html', 'stage');
  await page.locator('#board-axis').selectOption('y');
  await page.getByLabel('By, in mm').fill('7.5');
  await page.getByRole('button', { name: 'Jog' }).click();
  await page.locator('#board-place').filter({ hasText: 'y 7.500 mm' }).waitFor();

  await page.locator('#gcode textarea').fill(PROGRAM);
  await page.locator('#status').filter({ hasText: 'Run in' }).waitFor();
  await page.getByRole('button', { name: 'Run the program' }).click();
  await said(page, 'line 2: line 50.0000 20.0000 30.0000');
  await page.getByRole('button', { name: 'Hold' }).click();
  await page.getByText(/received "held, x/).waitFor();
  const [x = 0, y = 0] = await place(page);
  assert(x > 19 && x < 50 && Math.abs(y - 20) < 0.02, `held at ${x} ${y}`);
  assert(await page.getByText('where the board says it is').isVisible());
  await page.getByRole('button', { name: 'Resume' }).click();
  await said(page, 'The program has been run: 5 motions.');
  assert.match(
    (await page.locator('#board-place').textContent()) ?? '',
    /ended line 4 0\.0[01]\d mm from where that ends/,
  );
  await assertAccessible(page);
  await shoot(page, 'stage-board');

  await page.getByRole('button', { name: 'Run the program' }).click();
  await said(page, 'line 1: line 20.0000');
  await page.getByRole('button', { name: 'Stop' }).click();
  await said(page, 'The program ends at line 1: stopped');
  await close();
});

test('points drive a Delta', async (context) => {
  const { page, close } = await homed(context, 'delta.html', 'delta');
  await page.locator('#lines textarea').fill('0 0 -250 200\n40 0 -260 200\n40 40 -260 200');
  await page.locator('#status').filter({ hasText: 'Driven in' }).waitFor();
  // The line has the processor for itself from here on.
  await page.getByRole('button', { name: 'steps.csv' }).and(page.locator(':enabled')).waitFor();
  await page.getByRole('button', { name: 'Run the program' }).click();
  await said(page, 'The program has been run: 3 motions.');
  const [x = 0, y = 0, z = 0] = await place(page);
  assert(Math.hypot(x - 40, y - 40, z + 260) < 0.1, `${x} ${y} ${z}`);
  await shoot(page, 'delta-board');
  await close();
});

test('a board of another machine is named', async (context) => {
  const { page, done } = await browser.visit('', { script: MOCK });
  context.after(await connectFirmware(page, 'delta'));
  await page.goto(`${browser.url}stage.html`);
  await page.getByText('A board on a serial port').click();
  await page.getByRole('button', { name: 'Connect', exact: true }).click();
  await said(page, 'The board moves another machine: delta.');
  await done();
});
