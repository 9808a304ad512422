// The engraver in the browser: the same bytes as from the command line, and a page that lives on.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { assertAccessible, delayed, open, refusal, ROOT, saved, shoot, VIEWS } from './browser.js';
import { commandLine, DRAWINGS, file } from './command-line.js';

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/** @param {import('playwright-core').Page} page */
async function engraved(page) {
  await page.getByRole('status').filter({ hasText: 'Engraved in' }).waitFor();
}

test('the rosette leaves the files of the command line, byte for byte', async () => {
  const { page, done } = await browser.visit('index.html');
  await engraved(page);
  const { folder, text } = commandLine('engrave', []);
  for (const name of ['pattern.bin', 'pulses.vcd', 'engraved.svg', 'report.json']) {
    const bytes = await saved(page, name);
    assert(bytes.equals(readFileSync(join(folder, name))), `${name} differs`);
  }
  const summary = (await page.locator('#summary').textContent()) ?? '';
  assert(text.startsWith(`rosette.svg: ${summary}`), text);
  const header = (await saved(page, 'pattern.h')).toString();
  assert.match(header, /unsigned char code pattern\[6\d{3}\]/);
  await done();
});

test('timed motion leaves the edges of the command line', async () => {
  const { page, done } = await browser.visit('index.html');
  await engraved(page);
  await page.getByLabel('Controller').selectOption('timed');
  await page.waitForURL(/controller=timed/);
  await engraved(page);
  const { folder } = commandLine('engrave', ['--controller', 'timed']);
  for (const name of ['pulses.vcd', 'engraved.svg', 'report.json']) {
    assert((await saved(page, name)).equals(readFileSync(join(folder, name))), `${name} differs`);
  }
  await shoot(page, 'engrave-timed');
  await done();
});

test('a machine whose load is known is chosen, its torque and its tool are shown', async () => {
  const { page, done } = await browser.visit('index.html?controller=timed');
  await engraved(page);
  const path = '<path d="M5 50 95 55 10 20M50 5C90 5 90 60 50 60" fill="none" stroke="black"/>';
  const svg = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">${path}</svg>`;
  const lines = file('lines.svg', svg);
  await page.setInputFiles('#file', lines);
  await page.locator('#machine-choice').selectOption('loaded');
  await page.locator('#summary').filter({ hasText: 'vibration: the tool (40.0 Hz)' }).waitFor();
  assert(await page.locator('#torque-used canvas').isVisible());
  assert(await page.locator('#vibration canvas').isVisible());
  const loaded = ['--machine', join(ROOT, 'machines/engraver/loaded.toml')];
  const { folder } = commandLine('engrave', ['--svg', lines, ...loaded, '--controller', 'timed']);
  for (const name of ['engraved.svg', 'report.json']) {
    assert((await saved(page, name)).equals(readFileSync(join(folder, name))), `${name} differs`);
  }
  await shoot(page, 'engrave-loaded');
  await done();
});

test('settings change the plan as the options of the command line do, and stay in the address', async () => {
  const address =
    'index.html?drawing=star&tolerance=0.02&order=file&placement=0.4,0,0,-0.4,-40,160';
  const { page, done } = await browser.visit(address);
  await engraved(page);
  const placement = ['--placement', '0.4,0,0,-0.4,-40,160'];
  const star = ['--svg', join(DRAWINGS, 'star.svg')];
  const { folder } = commandLine('engrave', [
    ...star,
    '--tolerance',
    '0.02',
    '--keep-order',
    ...placement,
  ]);
  assert((await saved(page, 'pattern.bin')).equals(readFileSync(join(folder, 'pattern.bin'))));
  await page.getByLabel('Tolerance').fill('0.1');
  await page.waitForURL(/tolerance=0\.1/);
  await done();
});

test('what is refused is said as on the command line, and the page lives on', async () => {
  const { page, done } = await browser.visit('index.html');
  await engraved(page);
  const rosette = join(DRAWINGS, 'rosette.svg');

  await page.getByLabel('Placement').fill('1,0,0,1,900,0');
  const far = commandLine('engrave', ['--svg', rosette, '--placement', '1,0,0,1,900,0']);
  const said = await refusal(page, 'stroke');
  assert.equal(far.status, 1);
  assert(far.text.trim().endsWith(said.replace('rosette.svg', rosette)), `${said}\n${far.text}`);
  assert(await page.getByRole('button', { name: 'pattern.bin' }).isDisabled());
  await page.getByLabel('Placement').fill('');
  await engraved(page);

  await page.getByLabel('Tolerance').fill('0');
  const zero = commandLine('engrave', ['--tolerance', '0']);
  assert(zero.text.trim().endsWith(await refusal(page, 'tolerance')));
  await page.getByLabel('Tolerance').fill('0.05');
  await engraved(page);

  const broken = file(
    'broken.svg',
    '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0"></svg>',
  );
  await page.locator('#file').setInputFiles(broken);
  const unread = commandLine('engrave', ['--svg', broken]);
  const why = await refusal(page, 'broken.svg');
  assert(unread.text.trim().endsWith(why.replace('broken.svg', broken)), `${why}\n${unread.text}`);
  await page.getByLabel('Shipped drawing').selectOption('lettering');
  await engraved(page);
  await done();
});

test('the machine has its settings as fields; they are kept until it is as shipped again', async () => {
  const { page, done } = await browser.visit('index.html');
  await engraved(page);
  await page.getByText('Machine', { exact: true }).click();
  await page.getByLabel('upper mm').fill('-1');
  assert.match(await refusal(page, 'machine.toml'), /\[arm\].*-1/);
  await page.getByLabel('upper mm').fill('140');
  await engraved(page);
  const machine = file('machine.toml', await saved(page, 'Save the machine file'));
  const { folder } = commandLine('engrave', ['--machine', machine]);
  const pattern = readFileSync(join(folder, 'pattern.bin'));
  await page.reload();
  await engraved(page);
  assert((await saved(page, 'pattern.bin')).equals(pattern));
  await page.getByText('Machine', { exact: true }).click();
  await page.getByRole('button', { name: 'As shipped' }).click();
  await engraved(page);
  assert(!(await saved(page, 'pattern.bin')).equals(pattern));
  await done();
});

test('time is played, set and zoomed by keys alone', async () => {
  const { page, done } = await browser.visit('index.html');
  await engraved(page);
  const shown = async () =>
    Number.parseFloat((await page.locator('#shown-time').textContent()) ?? '');
  await page.getByRole('button', { name: 'Play' }).press('Enter');
  await page.waitForFunction("parseFloat(document.getElementById('shown-time').textContent) > 2");
  await page.getByRole('button', { name: 'Pause' }).press('Enter');
  const before = await shown();
  assert(before < 300, `${before}`);
  await page.getByLabel('Time', { exact: true }).press('PageUp');
  assert((await shown()) > before);
  const lanes = page.locator('#lanes');
  // A click sets the time; a drag moves what is in sight alone.
  for (let press = 0; press < 4; press += 1) await lanes.press('+');
  await lanes.click({ position: { x: 300, y: 40 } });
  const clicked = await shown();
  await lanes.hover({ position: { x: 100, y: 40 } });
  await page.mouse.down();
  await lanes.hover({ position: { x: 200, y: 40 } });
  await page.mouse.up();
  assert.equal(await shown(), clicked);
  for (let press = 0; press < 40; press += 1) await lanes.press('+');
  await shoot(page, 'engrave-edges');
  assert.match((await page.locator('#lanes-note').textContent()) ?? '', /^\d+\.\d{5,} s/);
  await lanes.press('0');
  assert.match((await page.locator('#lanes-note').textContent()) ?? '', /^0\.\d+ s to 339/);
  await done();
});

test('a drawing is engraved although the browser keeps nothing', async () => {
  const script = "Storage.prototype.setItem = () => { throw new Error('there is no room'); };";
  const { page, done } = await browser.visit('index.html', { script });
  await engraved(page);
  await page.locator('#file').setInputFiles(join(DRAWINGS, 'star.svg'));
  await page.getByLabel('Shipped drawing').locator('option', { hasText: 'star.svg' }).waitFor({
    state: 'attached',
  });
  await engraved(page);
  const { folder } = commandLine('engrave', ['--svg', join(DRAWINGS, 'star.svg')]);
  assert((await saved(page, 'pattern.bin')).equals(readFileSync(join(folder, 'pattern.bin'))));
  await done();
});

test('a file that a newer input has made useless is not refused', async () => {
  const { page, done } = await browser.visit('index.html', { script: delayed('engrave.file') });
  await engraved(page);
  await page.evaluate(`window.refusals = [];
    const status = document.getElementById('status');
    new MutationObserver(() => {
      if (status.classList.contains('bad')) refusals.push(status.textContent);
    }).observe(status, { attributes: true });`);
  await page.getByRole('button', { name: 'pulses.vcd' }).click();
  await page.getByLabel('Tolerance').fill('0.1');
  await page.waitForURL(/tolerance=0\.1/);
  await engraved(page);
  assert.deepEqual(await page.evaluate('refusals'), []);
  await done();
});

for (const { scheme, size, viewport } of VIEWS) {
  test(`it is readable: ${scheme}, ${size}`, async () => {
    const { page, done } = await browser.visit('index.html', { viewport, colorScheme: scheme });
    await engraved(page);
    await page.getByLabel('Time', { exact: true }).fill('150');
    await page.getByText('Machine', { exact: true }).click();
    await assertAccessible(page);
    await page.getByText('Machine', { exact: true }).click();
    assert.equal(await page.evaluate('document.documentElement.scrollWidth'), viewport.width);
    await shoot(page, `engrave-${scheme}-${size}`);
    await done();
  });
}
