// Inputs that nobody means to give: the page says what is wrong, stays alive, and opens again.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { open, refusal } from './browser.js';
import { file } from './command-line.js';
import { MOCK } from './serial-mock.js';

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/** @param {import('playwright-core').Page} page */
const ready = (page) => page.locator('main[data-ready]').waitFor();

/**
 * The processor's time that scripts of the page take while something is done, in s.
 * @param {import('playwright-core').Page} page
 * @param {() => Promise<void>} act
 */
async function computed(page, act) {
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable', { timeDomain: 'threadTicks' });
  const seconds = async () => {
    const { metrics } = await session.send('Performance.getMetrics');
    return metrics.find((it) => it.name === 'ScriptDuration')?.value ?? Number.NaN;
  };
  const before = await seconds();
  await act();
  return (await seconds()) - before;
}

test('a line of 200 kB without a blank is refused, and the page does not stand still', async () => {
  const { page, done } = await browser.visit('delta.html');
  await ready(page);
  const s = await computed(page, async () => {
    await page.locator('#file').setInputFiles(file('long.txt', '1'.repeat(200_000)));
    await refusal(page, 'lines refused');
  });
  // Its square was 22 s.
  assert(s < 2, `${s} s`);
  await page.reload();
  await refusal(page, 'lines refused');
  await done();
});

test('a text that has ended the page is not opened again by itself', async () => {
  const script = `if (!localStorage.getItem('pose2pulse delta lines')) {
      localStorage.setItem('pose2pulse delta lines', '0 0 -240');
      localStorage.setItem('pose2pulse delta name', 'bad.txt');
      localStorage.setItem('pose2pulse delta lines trying', 'yes');
    }`;
  const { page, done } = await browser.visit('delta.html', { script });
  await page.getByRole('status').filter({ hasText: 'bad.txt ended the page' }).waitFor();
  await page.getByLabel('Shipped points').selectOption('own');
  await page
    .getByRole('status')
    .filter({ hasText: /^Driven in [^b]*$/ })
    .waitFor();
  assert.equal(await page.getByLabel('Points', { exact: true }).inputValue(), '0 0 -240');
  await done();
});

test('names that every object has are no views and no examples', async () => {
  const { page, done } = await browser.visit('');
  for (const name of ['constructor', '__proto__']) {
    await page.goto(`${browser.url}line.html?view=${name}&example=${name}`);
    await page.locator('#status').filter({ hasText: 'another parity' }).waitFor();
    assert(await page.getByLabel('A capture').isChecked());
  }
  await done();
});

test('a capture with 200 kB in a line has its verdict', async () => {
  const { page, done } = await browser.visit('line.html?example=00_good');
  await ready(page);
  const path = file('wide.txt', `0.1 > ${'02 '.repeat(70_000)}\n`);
  await page.locator('#file').setInputFiles(path);
  await page.locator('#summary').filter({ hasText: 'verdict: ' }).waitFor();
  await page.locator('#status').filter({ hasNotText: 'Judging' }).waitFor();
  assert.doesNotMatch((await page.locator('#status').textContent()) ?? '', /call stack/);
  await done();
});

test('what a port is refused stays to be read', async () => {
  const { page, done } = await browser.visit('line.html?view=port', { script: MOCK });
  await page.getByRole('button', { name: 'Connect', exact: true }).click();
  await page.locator('#live-activity').filter({ hasText: 'idle' }).waitFor();
  const form = page.locator('#live-send');
  await form.getByLabel('Telegram', { exact: true }).fill('4g');
  await form.getByLabel('Telegram as').selectOption('hex');
  await form.getByRole('button', { name: 'Send' }).click();
  const said = await refusal(page, '4g');
  // Verdicts come twice a second: two of them are seen in what is told below.
  await page.evaluate(`window.verdicts = 0;
    new MutationObserver(() => (verdicts += 1)).observe(
      document.getElementById('summary'), { childList: true });`);
  await page.waitForFunction('verdicts >= 3');
  assert.equal(await page.locator('#status').textContent(), said);
  await form.getByLabel('Telegram', { exact: true }).fill('41');
  await form.getByRole('button', { name: 'Send' }).click();
  await page.locator('#status').filter({ hasText: 'the line works' }).waitFor();
  await done();
});

test('a chooser that is closed without a port is no error', async () => {
  const script = `Object.defineProperty(navigator, 'serial', { value: {
    requestPort: () => Promise.reject(new DOMException('No port selected by the user.', 'NotFoundError')) } });`;
  const { page, done } = await browser.visit('line.html?view=port', { script });
  await page.getByRole('button', { name: 'Connect', exact: true }).click();
  await page.locator('#status').filter({ hasText: 'No port was chosen' }).waitFor();
  assert.equal(await page.locator('#status.bad').count(), 0);
  await done();
});

const OUTSIDE = /** @type {const} */ ([
  ['delta.html?load=-5', 'Load in g: -5 is below 0'],
  ['delta.html?load=x', 'Load in g: a number is needed'],
  ['index.html?tolerance=1e300', 'Tolerance in mm: 1e+300 is above 10'],
  ['stage.html?tolerance=1e300', 'Corners within: 1e+300 is above 1'],
  ['stage.html?seed=1.5', 'Which are lost: 1.5 is no whole number'],
  ['dance.html?code=-1', 'Code in bytes: -1 is below 0'],
]);

test('numbers out of their ranges are refused by their names', async () => {
  const { page, done } = await browser.visit('');
  for (const [address, said] of OUTSIDE) {
    await page.goto(browser.url + address);
    assert.equal(await refusal(page, said), said);
  }
  await done();
});

test('a file without a point is refused', async () => {
  const { page, done } = await browser.visit('delta.html');
  await ready(page);
  for (const text of ['', '# nothing\n']) {
    await page.getByLabel('Points', { exact: true }).fill(text);
    await refusal(page, 'there is no point to drive to');
    await page.getByLabel('Points', { exact: true }).fill('0 0 -240');
    await page.getByRole('status').filter({ hasText: 'Driven in' }).waitFor();
  }
  await done();
});

test('a link that is damaged is told so, and the page opens', async () => {
  const { page, done } = await browser.visit('stage.html?drawing=own#not~deflated');
  await page.getByRole('status').filter({ hasText: 'the link is damaged' }).waitFor();
  await page.getByRole('status').filter({ hasText: 'Run in' }).waitFor();
  await done();
});

test('a server that calls the wasm by another type will do', async () => {
  const { page, done } = await browser.visit('');
  await page.route(/\.wasm$/, async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, contentType: 'application/octet-stream' });
  });
  await page.goto(`${browser.url}stage.html`);
  await page.getByRole('status').filter({ hasText: 'Run in' }).waitFor();
  await done();
});

test('a wasm that the server has not is told by its name', async () => {
  const { page } = await browser.visit('');
  await page.route(/\.wasm$/, (route) => route.fulfill({ status: 404 }));
  await page.goto(`${browser.url}stage.html`);
  assert.match(
    await refusal(page, 'the server answers 404'),
    /^\w+-.*\.wasm: the server answers 404$/,
  );
  await page.context().close();
});

test('without JavaScript, and from a file, the page says what to do', async () => {
  const { page, done } = await browser.visit('delta.html', { javaScriptEnabled: false });
  // Texts in there are not looked for as others are.
  await page.locator('noscript p').filter({ hasText: 'needs JavaScript' }).waitFor();
  await done();
  const { page: local } = await browser.visit('');
  await local.goto(new URL('../dist/delta.html', import.meta.url).href);
  await local.getByText('A browser runs this page from a server').waitFor();
  await local.context().close();
});
