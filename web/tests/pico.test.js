// The Pico's firmware in the page: it answers as the machine on the PC does, and its pins move the arm.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { assertAccessible, open, shoot, VIEWS } from './browser.js';
import { connectFirmware, MOCK } from './serial-mock.js';

/** As `web/build` has it. */
const IS_BUILT = process.env.PAGE_FIRMWARE !== 'no';
const HZ = 125_000_000;
/** Of the arm of the Pico's firmware. */
const HOMING_FAST_HZ = 800;

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/** @typedef {import('playwright-core').Page} Page */

/** @param {Page} page */
async function connectPico(page) {
  await page.getByRole('button', { name: 'Connect to the Pico on this page' }).click();
  await page.locator('#live-activity').filter({ hasText: 'idle' }).waitFor();
}

/**
 * Sends a telegram, and gives the answer to it, or to what it has begun: the last that matches.
 * @param {Page} page
 * @param {string} text
 * @param {RegExp} awaited
 */
async function ask(page, text, awaited = /received/) {
  const events = page.locator('#live-events');
  await events.evaluate((it) => it.replaceChildren());
  const telegram = page.locator('#live-send').getByLabel('Telegram', { exact: true });
  await telegram.fill(text);
  await telegram.press('Enter');
  const answer = events.locator('li').filter({ hasText: awaited });
  await answer.waitFor({ timeout: 60_000 }).catch(async () => {
    assert.fail(`no ${awaited} after ${text}:\n${await events.innerText()}`);
  });
  const told = (await events.locator('li').allTextContents()).map((it) => it.match(/"(.*)"/)?.[1]);
  return told.filter((it) => it !== undefined);
}

/**
 * Where the page has the arm, by the edges, once it has been told of the last of them.
 * @param {Page} page
 */
async function byEdges(page) {
  const ran = page.locator('#pico-ran');
  const now = () =>
    ran.evaluate(
      (it) =>
        new Promise((done) => {
          new MutationObserver(() => done([it.textContent, performance.now()])).observe(it, {
            childList: true,
          });
        }),
    );
  // What is told may have been reckoned before the answer came.
  await now();
  const [text, ms] = /** @type {[string, number]} */ (await now());
  const numbers = text.match(/-?\d+(\.\d+)?/g)?.map(Number) ?? [];
  const [seconds = 0, , x = 0, y = 0, shoulder = 0, elbow = 0, edges = 0] = numbers;
  return { seconds, ms, tool: [x, y], steps: [shoulder, elbow], edges };
}

/** @param {string | undefined} place As `where` tells it. */
function parse(place) {
  const found = place
    ?.match(/x (\S+) y (\S+) mm.* steps (\S+) (\S+)/)
    ?.slice(1)
    .map(Number);
  assert(found, String(place));
  const [x = 0, y = 0, shoulder = 0, elbow = 0] = found;
  return { tool: [x, y], steps: [shoulder, elbow] };
}

test('a page without the firmware says so, and how to build it', { skip: IS_BUILT }, async () => {
  const { page, done } = await browser.visit('line.html?view=port', { script: MOCK });
  const button = page.getByRole('button', { name: 'Connect to the Pico on this page' });
  assert(await button.isDisabled());
  await page.getByText('built without the firmware of the Pico: web/build builds it').waitFor();
  await done();
});

/** What both are asked, and until which answer. @type {[string, RegExp?][]} */
const TELEGRAMS = [
  ['status'],
  ['line 60 150'],
  ['home', /"done/],
  ['where'],
  ['jog shoulder 60', /"done/],
  ['line 60 150', /"done/],
  ['line -100 150', /"done/],
  ['line 60 150 40', /"done/],
  ['where'],
  ['limits'],
  ['status'],
];

/**
 * The answers of the machine on this computer.
 * @param {import('node:test').TestContext} context
 */
async function answersOfThePc(context) {
  const { page, done } = await browser.visit('', { script: MOCK });
  context.after(await connectFirmware(page));
  await page.goto(`${browser.url}line.html?view=port`);
  await page.getByRole('button', { name: 'Connect', exact: true }).click();
  const answers = [];
  for (const [text, awaited] of TELEGRAMS) answers.push(await ask(page, text, awaited));
  await done();
  return answers;
}

test(
  'the Pico answers as the PC, and its edges alone move the arm',
  { skip: !IS_BUILT },
  async (context) => {
    const planned = await answersOfThePc(context);
    // A browser without Web Serial has this one.
    const script = "Object.defineProperty(navigator, 'serial', { value: undefined })";
    const { page, done } = await browser.visit('line.html?view=port', { script });
    await connectPico(page);
    const begin = await byEdges(page);
    /** @type {number[]} */
    let home = [];
    /**
     * The page's arm is where the Pico says.
     * @param {string | undefined} where
     */
    const compare = async (where) => {
      const said = parse(where);
      const drawn = await byEdges(page);
      if (home.length === 0) home = said.steps;
      const made = said.steps.map((it, joint) => it - (home[joint] ?? 0));
      assert.deepEqual(drawn.steps, made);
      for (const axis of [0, 1]) {
        const off = Math.abs((said.tool[axis] ?? 0) - (drawn.tool[axis] ?? 0));
        assert(off < 0.02, `${said.tool} by the Pico, ${drawn.tool} by its edges`);
      }
    };
    for (const [index, [text, awaited]] of TELEGRAMS.entries()) {
      const told = await ask(page, text, awaited);
      assert.deepEqual(told, planned[index], text);
      if (text === 'where') await compare(told[0]);
    }
    const end = await byEdges(page);
    const share = (end.seconds - begin.seconds) / ((end.ms - begin.ms) / 1000);
    context.diagnostic(`home, jog and three lines at ${(100 * share).toFixed(0)} % of real time`);

    await ask(page, 'line 200 -60 100', /"ok, /);
    const held = (await ask(page, 'hold', /"held/)).find((it) => it?.startsWith('held'));
    const [where] = await ask(page, 'where');
    assert(held?.startsWith(`held, ${where?.slice(0, 20)}`), `${held}, ${where}`);
    assert.notDeepEqual(parse(where).tool.map(Math.round), [200, -60]);
    await compare(where);
    const ended = await ask(page, 'resume', /"done/);
    assert.deepEqual(parse(ended.at(-1)).tool.map(Math.round), [200, -60]);
    await compare((await ask(page, 'where'))[0]);
    assert.deepEqual(await ask(page, 'status'), ['ready, feed 100 %, 0 underruns']);

    await page.getByRole('button', { name: 'Supply off and on' }).click();
    assert.deepEqual(await ask(page, 'status'), ['not homed, feed 100 %, 0 underruns']);
    await done();
  },
);

test('edges are found to the cycle, by pointer and keys', { skip: !IS_BUILT }, async () => {
  const { page, done } = await browser.visit('line.html?view=port');
  await connectPico(page);
  await page.getByRole('button', { name: 'Home', exact: true }).click();
  await page.locator('#pico-said').filter({ hasText: 'done, x' }).waitFor({ timeout: 60_000 });
  const pins = page.locator('#pico-pins');
  const cursor = page.locator('#pico-cursor');
  // A click where nothing has moved, then from edge to edge: the way to the first switch.
  await pins.press('0');
  assert(!(await page.getByLabel('follows the pins').isChecked()));
  await pins.click({ position: { x: 2, y: 40 } });
  const rises = [];
  let wasHigh = false;
  for (let edge = 0; edge < 12; edge += 1) {
    await pins.press(']');
    const text = (await cursor.textContent()) ?? '';
    const [, cycle] = text.match(/cycle (\d+)/) ?? [];
    const isHigh = /GP2 high|GP4 high/.test(text);
    if (isHigh && !wasHigh) rises.push(Number(cycle));
    wasHigh = isHigh;
  }
  assert(rises.length >= 4, String(rises));
  for (const [index, cycle] of rises.entries()) {
    if (index > 0) assert.equal(cycle - (rises[index - 1] ?? 0), HZ / HOMING_FAST_HZ);
  }
  await page.getByRole('button', { name: 'Mark here' }).click();
  await page.getByRole('button', { name: 'Edge before' }).click();
  await page.getByRole('button', { name: 'Edge before' }).click();
  await cursor
    .filter({ hasText: `From the mark: -${HZ / HOMING_FAST_HZ} cycles, -1.25` })
    .waitFor();
  await cursor.filter({ hasText: '800.00 Hz; 1 steps' }).waitFor();
  await done();
});

test('a line is drawn to the place that is clicked', { skip: !IS_BUILT }, async () => {
  const { page, done } = await browser.visit('line.html?view=port');
  await connectPico(page);
  const said = page.locator('#pico-said');
  await page.getByRole('button', { name: 'Home', exact: true }).click();
  await said.filter({ hasText: 'done, x' }).waitFor({ timeout: 60_000 });
  await page.getByRole('button', { name: 'Turn the shoulder' }).click();
  await said.filter({ hasText: 'shoulder -29.99' }).waitFor({ timeout: 60_000 });
  const arm = page.locator('#pico-arm');
  const { width, height } = (await arm.boundingBox()) ?? assert.fail('no arm');
  await arm.click({ position: { x: width / 2 + height / 6, y: height / 4 } });
  const go = page.getByRole('button', { name: 'Line to x' });
  const [x, y] = (await go.textContent())?.match(/[\d.]+/g)?.map(Number) ?? [];
  await go.click();
  const place = new RegExp(
    `done, x ${Math.trunc(x ?? 0)}\\.\\d+ y ${Math.trunc(y ?? 0)}\\.\\d+ mm`,
  );
  await said.filter({ hasText: place }).waitFor({ timeout: 60_000 });

  // Another rate is refused by name.
  await page.getByRole('button', { name: 'Disconnect' }).click();
  await page.locator('#baud').selectOption('19200');
  await page.getByRole('button', { name: 'Connect to the Pico on this page' }).click();
  await page.locator('#status.bad').filter({ hasText: 'has 9600 bits per second' }).waitFor();
  await done();
});

for (const { scheme, size, viewport } of VIEWS) {
  test(`the Pico is readable: ${scheme}, ${size}`, { skip: !IS_BUILT }, async () => {
    const options = { viewport, colorScheme: scheme };
    const { page, done } = await browser.visit('line.html?view=port', options);
    await connectPico(page);
    await page.getByRole('button', { name: 'Home', exact: true }).click();
    await page.locator('#pico-said').filter({ hasText: 'done, x' }).waitFor({ timeout: 60_000 });
    await ask(page, 'jog shoulder 60', /"done/);
    await ask(page, 'line 60 150', /"done/);
    await page.locator('#pico-pins').click();
    await assertAccessible(page);
    assert.equal(await page.evaluate('document.documentElement.scrollWidth'), viewport.width);
    await shoot(page, `line-pico-${scheme}-${size}`);
    await done();
  });
}
