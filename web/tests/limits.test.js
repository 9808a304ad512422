// What limits a timed run at any instant; and jobs that are too large to be done at once.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { open, refusal } from './browser.js';
import { file } from './command-line.js';

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/** Keeps what the machine last gave as shares of the limits, and how many there are at a time. */
const KEEP = `const Plain = Worker;
  window.Worker = class extends Plain {
    constructor(...parameters) {
      super(...parameters);
      this.addEventListener('message', ({ data }) => {
        if (!data.blobs?.shares) return;
        window.shares = [...new Float32Array(data.blobs.shares.slice(0))];
        window.looks = data.blobs.looks.byteLength / 8;
      });
    }
  };`;

for (const [address, machine] of /** @type {const} */ ([
  ['stage.html', 'published'],
  ['stage.html', 'loaded'],
  ['delta.html', 'published'],
  ['delta.html', 'loaded'],
  ['index.html?controller=timed&drawing=star', 'published'],
])) {
  test(`no instant is above a limit, most are at one: ${address}, ${machine}`, async () => {
    const { page, done } = await browser.visit(address, { script: KEEP });
    await page.waitForFunction('window.looks > 0');
    if (machine === 'loaded') {
      // Soon done.
      const points = page.getByLabel('Points', { exact: true });
      if (await points.count()) await points.fill('0 0 -230 300\n40 0 -230 300\n');
      await page
        .getByRole('status')
        .filter({ hasText: /^(Run|Driven) in/ })
        .waitFor();
      await page.evaluate('window.looks = 0');
      await page.locator('#machine-choice').selectOption(machine);
      await page.waitForFunction('window.looks > 0');
    }
    const { shares, looks } = /** @type {{ shares: number[], looks: number }} */ (
      await page.evaluate('({ shares, looks })')
    );
    const width = shares.length / looks;
    /** @param {number} from @param {number} to */
    const largest = (from, to) =>
      Array.from({ length: looks }, (_, look) => {
        const some = shares.slice(look * width + from, look * width + to);
        return Math.max(...some.filter(Number.isFinite), 0);
      });
    const nearest = largest(4, width);
    // Axes and feed, and the tool's acceleration along the path.
    const [most = 0, along = 0] = [largest(4, width - 1), largest(width - 1, width)].map((parts) =>
      parts.reduce((a, b) => Math.max(a, b), 0),
    );
    // Numbers of 32 bits; the tool's, from places beside each other.
    assert(most < 1.002, `${most}`);
    assert(along < 1.02, `${along} of the acceleration along the path`);
    const at = nearest.filter((it) => it > 0.985).length;
    console.log(`${address}, ${machine}: ${looks} looks, ${at} at a limit, the nearest ${most}`);
    assert(at > looks / (machine === 'loaded' ? 4 : 2), `${at} of ${looks}`);
    await done();
  });
}

test('limit, row and line are told at the time on show, and at the pointer', async () => {
  const { page, done } = await browser.visit('stage.html?drawing=test&time=5');
  const limit = page.locator('#limit');
  await limit.filter({ hasText: /^5\.000 s: limited by feed 100 % of 10 mm\/s; / }).waitFor();
  await limit.filter({ hasText: /Row \d+, line 4: G1 X100 F600/ }).waitFor();
  await page.locator('#speeds .u-over').hover({ position: { x: 200, y: 50 } });
  await limit.filter({ hasNotText: '5.000 s' }).waitFor();
  assert.match((await limit.textContent()) ?? '', /^1\d\.\d{3} s: .* line \d+: /);
  await page.mouse.move(0, 0);
  await limit.filter({ hasText: '5.000 s' }).waitFor();
  // Steps at the feed have no rows.
  await page.locator('#steps').selectOption('published');
  await page.locator('#limited').waitFor({ state: 'hidden' });
  await done();
});

/**
 * A zigzag of so many lines, each so long, in mm.
 * @param {number} lines
 * @param {number} long
 */
function zigzag(lines, long) {
  const moves = Array.from(
    { length: lines },
    (_, line) => `G1 X${line % 2 ? long : 0} Y${line % 90}`,
  );
  return file('zigzag.gcode', `G21 G90 F6000\n${moves.join('\n')}\n`);
}

test('a long program is shown in parts, drawn before it is run, stopped, and run again', async () => {
  const { page, done } = await browser.visit('stage.html');
  await page.locator('main[data-ready]').waitFor();
  await page.locator('#file').setInputFiles(zigzag(20_000, 5));
  await page.locator('#progress[value]').waitFor();
  await page.getByText('lines 1 to 500 of 20002').waitFor();
  await page.getByRole('button', { name: 'Later' }).click();
  assert.match(await page.getByLabel('G-code').inputValue(), /^G1 X5 Y49\n/);
  await page.getByRole('button', { name: 'Stop' }).click();
  await page.getByRole('status').filter({ hasText: 'Stopped' }).waitFor();
  await page.getByRole('button', { name: 'Run it again' }).click();
  await page.locator('#progress[value]').waitFor();
  await page.getByLabel('Shipped program').selectOption('test');
  await page.getByRole('status').filter({ hasText: 'Run in' }).waitFor();
  assert(await page.locator('#working').isHidden());
  await done();
});

test('more steps than there is room for are refused with their number', async () => {
  const { page, done } = await browser.visit('stage.html');
  await page.locator('main[data-ready]').waitFor();
  await page.locator('#file').setInputFiles(zigzag(20_000, 119));
  const said = await refusal(page, 'zigzag.gcode: 2');
  assert.match(said, /: 2\d{8} steps, and this page runs 20000000 at most/);
  await done();
});
