// What opens by itself, and what a link carries: the page that its sender saw.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { open, ROOT, saved } from './browser.js';
import { file } from './command-line.js';

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/** @typedef {import('playwright-core').Page} Page */

/** @param {Page} page */
const ready = (page) => page.locator('main[data-ready]').waitFor();
/** @param {Page} page */
const seconds = async (page) =>
  Number.parseFloat((await page.locator('#shown-time').textContent()) ?? '');

const MOVING = ['index.html', 'dance.html', 'stage.html', 'delta.html', 'align.html'];

for (const path of MOVING) {
  test(`it moves when it opens, once, in sight: ${path}`, async () => {
    const viewport = path === 'stage.html' ? { width: 390, height: 844 } : undefined;
    const options = { viewport: viewport ?? { width: 1280, height: 720 } };
    const script = `window.times = new Set();
      setInterval(() => times.add(document.getElementById('shown-time')?.textContent), 50);`;
    const { page, done } = await browser.visit(path, { ...options, script, reducedMotion: null });
    await page.waitForFunction('times.size > 5');
    for (const id of ['#play', '.scene']) {
      const box = await page.locator(id).first().boundingBox();
      assert(box && box.y + box.height <= options.viewport.height, `${id} ${JSON.stringify(box)}`);
    }
    // To its end on one page.
    if (path === 'align.html') {
      await page.getByRole('button', { name: 'Play' }).waitFor();
      await page.waitForURL((url) => !url.searchParams.has('time'));
    }
    await done();
  });
}

test('what is set by hand ends the opening; with a time, and without motion, nothing plays', async () => {
  const { page, done } = await browser.visit('delta.html', { reducedMotion: null });
  await page.getByRole('button', { name: 'Pause' }).waitFor();
  await page.getByLabel('Time', { exact: true }).fill('2');
  await page.getByRole('button', { name: 'Play' }).waitFor();
  await page.waitForURL(/time=2(&|$)/);
  await page.reload();
  await ready(page);
  assert.equal(await seconds(page), 2);
  await page.getByRole('button', { name: 'Play' }).waitFor();
  await done();
});

/**
 * The link that the page copies.
 * @param {Page} page
 */
async function link(page) {
  await page.getByRole('button', { name: 'Copy link' }).click();
  await page.locator('#copied').filter({ hasText: 'Copied' }).waitFor();
  return String(await page.evaluate('navigator.clipboard.readText()'));
}

/**
 * What is seen: link, picture and fields.
 * @param {Page} page
 */
async function seen(page) {
  await page.evaluate('document.activeElement?.blur()');
  await page.mouse.move(0, 0);
  const url = await link(page);
  // Canvases are drawn before the next frame.
  await page.evaluate('new Promise((then) => requestAnimationFrame(() => setTimeout(then)))');
  const pictures = await page.evaluate(
    "[...document.querySelectorAll('canvas[id]')].map((it) => it.toDataURL())",
  );
  const summary = await page.locator('#summary').textContent();
  return { url, pictures, summary };
}

const PERMITTED = { permissions: ['clipboard-read', 'clipboard-write'] };

test('a capture of 20 KB is in a link of less than 8 KB', async () => {
  const capture = readFileSync(
    join(ROOT, 'crates/monitor3964r/tests/data/captures/00_good.txt'),
    'utf8',
  );
  const lines = capture.split('\n').filter((it) => /^\d/.test(it));
  /** @type {string[]} */
  const long = [];
  for (let at = 0; long.join('\n').length < 20_000; at += 10) {
    for (const line of lines) {
      const [time = '', rest = ''] = line.split(/ (.*)/);
      long.push(`${(Number(time) + at * 1.7).toFixed(6)} ${rest}`);
    }
  }
  const { page, done } = await browser.visit('line.html', PERMITTED);
  await ready(page);
  await page.locator('#file').setInputFiles(file('long.txt', long.join('\n')));
  await page.locator('#summary').filter({ hasText: 'verdict' }).waitFor();
  const url = await link(page);
  console.log(`${long.join('\n').length} bytes: ${url.length} characters of link`);
  assert(url.length < 8000, `${url.length}`);
  await done();
  const other = await browser.visit('');
  await other.page.goto(url);
  await other.page.locator('#summary').filter({ hasText: 'verdict' }).waitFor();
  assert.equal(await other.page.locator('#capture').inputValue(), long.join('\n'));
  await other.done();
});

test('inside another page there are scene and Play alone', async () => {
  const { page, done } = await browser.visit('delta.html?embed&input=spiral');
  await ready(page);
  await page.locator('#play').waitFor();
  await page.locator('#scene').waitFor();
  for (const name of ['.top', '.intro', '#input', '#speeds', '.legend', '#status']) {
    assert(await page.locator(name).first().isHidden(), name);
  }
  const height = await page.evaluate('document.documentElement.scrollHeight');
  assert.equal(height, page.viewportSize()?.height);
  await page.getByRole('link', { name: 'Open the page' }).hover();
  await page.waitForFunction("/spiral/.test(document.getElementById('whole').href)");
  assert.doesNotMatch(
    String(await page.evaluate("document.getElementById('whole').href")),
    /embed/,
  );
  await done();
});

test('a link has how far the wire of a simulated line is zoomed', async () => {
  const { page, done } = await browser.visit('line.html?view=simulate', PERMITTED);
  await ready(page);
  await page.getByRole('button', { name: 'Run 20 s' }).click();
  await page.locator('#simulated-time').filter({ hasText: '20.0000 s' }).waitFor();
  const note = page.locator('#wire-note');
  const first = (await note.textContent()) ?? '';
  await page.locator('#wire').press('+');
  const zoomed = (await note.textContent()) ?? '';
  assert.notEqual(zoomed, first);
  const url = await link(page);
  await done();
  const other = await browser.visit('', PERMITTED);
  await other.page.goto(url);
  await other.page.locator('#wire-note').filter({ hasText: zoomed }).waitFor();
  await other.done();
});

/** How many random states, of one page after the other; `.ci/nightly` takes a hundred. */
const STATES = Number(process.env.PAGE_TEST_STATES ?? 3);

/** @param {number} seed */
function random(seed) {
  let state = seed * 2654435761 + 1;
  const next = () => {
    state = Math.imul(state ^ (state >>> 15), 0x2c1b3c6d);
    state = Math.imul(state ^ (state >>> 12), 0x297a2d39);
    state ^= state >>> 15;
    return (state >>> 0) / 2 ** 32;
  };
  /** @template T @param {readonly T[]} list */
  const of = (list) => /** @type {T} */ (list[Math.floor(next() * list.length)]);
  return { next, of };
}

/**
 * Sets a page as somebody might; tells the file to compare.
 * @type {Record<string, (page: Page, from: ReturnType<typeof random>) => Promise<string>>}
 */
const SETTERS = {
  'stage.html': async (page, { next, of }) => {
    await page.locator('#drawing').selectOption(of(['test', 'link', 'rosette', 'fast']));
    await page.locator('#steps').selectOption(of(['timed', 'published', 'bresenham']));
    await page.locator('#lose').fill((next() * 0.5).toFixed(2));
    const gcode = page.getByLabel('G-code');
    if (next() < 0.5)
      await gcode.fill(`G21 G90 F600 (täst ${next()})\nG1 X${(next() * 100).toFixed(2)}\n`);
    await turn(page, '#scene', of);
    return 'steps.csv';
  },
  'line.html': async (page, { next, of }) => {
    if (next() < 0.5) {
      await page.locator('#example').selectOption(of(['00_good', '06b_B_bcc_undoubled']));
      await page.locator('#preset').selectOption(of(['siemens-3964r', 'linux']));
    } else {
      await page.getByLabel('Two simulated stations').check();
      await page.locator('#scenario').selectOption(of(['late', 'noise', 'echo']));
      await page.locator('#station-b').getByText('Faults').click();
      await page
        .locator('#station-b')
        .getByLabel('Answers later')
        .fill(of(['0', '500']));
      await page.getByRole('button', { name: 'Run 20 s' }).click();
      await page.locator('#simulated-time').filter({ hasText: '20.0000 s' }).waitFor();
    }
    await turn(page, '#wire', of);
    return 'conversation.txt';
  },
  'dance.html': async (page, { next, of }) => {
    await page.locator('#law').selectOption(of(['reset', 'carry', 'signed']));
    await page.locator('#zoom').fill(String(10 + Math.floor(next() * 60)));
    const move = page.locator('.move').nth(Math.floor(next() * 5));
    await move.click();
    if (next() < 0.5) await move.press('Shift+ArrowRight');
    // It may end too late for the next one: then there is nothing to save.
    await page.locator('#files button:enabled, #status.bad').first().waitFor();
    if (await page.locator('#status.bad').isVisible()) await move.press('Shift+ArrowLeft');
    await turn(page, '#robot', of);
    return 'data.h';
  },
  'index.html': async (page, { next, of }) => {
    await page.locator('#drawing').selectOption(of(['rosette', 'star', 'lettering']));
    await page.locator('#controller').selectOption(of(['pattern', 'timed']));
    await page.locator('#tolerance').fill((0.02 + next() * 0.2).toFixed(3));
    if (next() < 0.5) await machine(page, 'upper mm', (139 + next() * 3).toFixed(2));
    await turn(page, '#scene', of);
    await turn(page, '#lanes', of);
    return 'report.json';
  },
  'delta.html': async (page, { next, of }) => {
    await page.locator('#shipped').selectOption(of(['pick-and-place', 'spiral']));
    await page.locator('#motion').selectOption(of(['rounded', 'trains']));
    await page.locator('#load').fill(String(Math.floor(next() * 400)));
    if (next() < 0.5) await machine(page, 'lower mm', (239 + next() * 2).toFixed(2));
    await turn(page, '#scene', of);
    return 'steps.csv';
  },
  'align.html': async (page, { next, of }) => {
    await page.getByLabel('y in mm', { exact: true }).fill((next() * 20 - 20).toFixed(2));
    await page.locator('#mode').selectOption(of(['pvt', 'pt']));
    await page.locator('#factor').selectOption(of(['1', '5', '20']));
    await turn(page, '#scene', of);
    return 'report.json';
  },
};

/**
 * @param {Page} page
 * @param {string} label
 * @param {string} value
 */
async function machine(page, label, value) {
  await page.locator('summary').filter({ hasText: 'Machine' }).click();
  await page.getByLabel(label).first().fill(value);
  await page.locator('label.changed').first().waitFor();
}

/**
 * @param {Page} page
 * @param {string} canvas
 * @param {(keys: readonly string[]) => string} of
 */
async function turn(page, canvas, of) {
  for (let press = 0; press < 3; press += 1) {
    await page.locator(canvas).press(of(['ArrowLeft', 'ArrowUp', '+', 'ArrowRight', '-']));
  }
}

for (let state = 0; state < STATES; state += 1) {
  const path = Object.keys(SETTERS)[state % 6] ?? '';
  test(`a random state is that of its link: ${state}, ${path}`, async () => {
    const from = random(state);
    const { page, done } = await browser.visit(path, PERMITTED);
    await ready(page);
    const name = (await SETTERS[path]?.(page, from)) ?? '';
    const button = page.getByRole('button', { name, exact: true });
    await page.locator('#files button:enabled').first().waitFor();
    if (path !== 'line.html') {
      const time = page.getByLabel('Time', { exact: true });
      const end = Number(await time.getAttribute('max'));
      await time.fill(String(end * from.next()));
    }
    await button.and(page.locator(':enabled')).waitFor();
    const sent = { ...(await seen(page)), bytes: await saved(page, name) };
    await done();

    const other = await browser.visit('', PERMITTED);
    await other.page.goto(sent.url);
    await ready(other.page);
    await other.page
      .getByRole('button', { name, exact: true })
      .and(other.page.locator(':enabled'))
      .waitFor();
    const got = await seen(other.page);
    assert.equal(got.url, sent.url);
    assert.equal(got.summary, sent.summary);
    assert.deepEqual(got.pictures, sent.pictures);
    assert((await saved(other.page, name)).equals(sent.bytes), `${name} differs`);
    await other.done();
  });
}
