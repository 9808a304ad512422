// The serial line in the browser: verdicts as the command line prints them, stations that live.
import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { assertAccessible, open, ROOT, saved, shoot, VIEWS } from './browser.js';
import { file, line3964r } from './command-line.js';
import { connectFirmware, MOCK } from './serial-mock.js';

const CAPTURES = join(ROOT, 'crates/monitor3964r/tests/data/captures');

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/**
 * Waits until the verdict, or a refusal, has this in it.
 * @param {import('playwright-core').Page} page
 * @param {string | RegExp} text
 */
async function said(page, text) {
  await page.locator('#status').filter({ hasText: text }).waitFor({ timeout: 60_000 });
}

test('every capture has the conversation and the verdict of the command line', async () => {
  const { page, done } = await browser.visit('line.html');
  const names = readdirSync(CAPTURES);
  assert(names.length >= 18);
  for (const name of names) {
    const path = join(CAPTURES, name);
    const printed = line3964r('monitor', path).text;
    const verdict = printed.split('\n').find((it) => it.startsWith('verdict: '));
    // The capture before may have had the same verdict: wait for this one's.
    await page.locator('#status').evaluate((it) => it.replaceChildren());
    await page.locator('#file').setInputFiles(path);
    await said(page, verdict?.slice('verdict: '.length) ?? '');
    assert.equal((await saved(page, 'conversation.txt')).toString(), printed, name);
    const summary = (await page.locator('#summary').textContent()) ?? '';
    assert(printed.endsWith(`${summary}\n`), summary);
    const report = JSON.parse((await saved(page, 'verdict.json')).toString());
    assert.deepEqual(report, JSON.parse(line3964r('monitor', '--json', path).text), name);
  }
  await done();
});

test('a capture that is chosen while another one loads is the one that stays', async () => {
  const { page, done } = await browser.visit('');
  await page.route(/01a_parity/, async (route) => {
    await new Promise((then) => setTimeout(then, 2000));
    await route.continue();
  });
  const example = page.waitForResponse(/01a_parity/);
  await page.goto(`${browser.url}line.html`);
  await page.locator('#file').setInputFiles(join(CAPTURES, '00_good.txt'));
  await said(page, 'the line works');
  await (await example).finished();
  await page.waitForTimeout(500);
  await said(page, 'the line works');
  await done();
});

test('what is expected of the line changes the verdict as it does on the command line', async () => {
  const { page, done } = await browser.visit('line.html?example=00_good&preset=siemens-3964');
  await said(page, 'both sides are set to 3964R');
  const args = ['monitor', '--preset', 'siemens-3964', join(CAPTURES, '00_good.txt')];
  const printed = line3964r(...args).text;
  assert.equal((await saved(page, 'conversation.txt')).toString(), printed);
  await page.getByLabel('Expected').selectOption('siemens-3964r');
  await said(page, 'the line works');
  await page.waitForURL((url) => !url.search.includes('preset'));
  await done();
});

test('a bad capture is refused as on the command line, and the page lives on', async () => {
  const { page, done } = await browser.visit('line.html');
  await said(page, 'another parity');
  for (const text of [
    '0.1 > 02\nx < 10\n',
    '0.1 > 02\n0.05 < 10\n',
    '0.1 - 02',
    '0.1 > 4z',
    '0.1 >',
  ]) {
    const path = file('bad.txt', text);
    const printed = line3964r('monitor', path);
    assert.equal(printed.status, 1);
    await page.locator('#file').setInputFiles(path);
    const told = printed.text.trim().replace('error: ', '').replace(path, 'bad.txt');
    await said(page, told);
    assert(await page.locator('#status.bad').count());
    await page.getByLabel('Example').selectOption('00_good');
    await said(page, 'the line works');
  }
  await page.getByLabel('Time in s').fill('0 > 02\n0.003 < 15\n1 > 02\n1.003 < 15');
  await said(page, 'B answers NAK to STX: no receive buffer');
  await page.reload();
  await said(page, 'B answers NAK to STX: no receive buffer');
  await done();
});

test('steps and characters are found by pointer and keys', async () => {
  const { page, done } = await browser.visit('line.html?example=00_good');
  await said(page, 'the line works');
  await page.getByText('A block of').first().click();
  const note = page.locator('#wire-note');
  const before = await note.textContent();
  await page.locator('#wire').press('ArrowRight');
  assert.notEqual(await note.textContent(), before);
  await page.locator('#wire').press('0');
  assert.match((await note.textContent()) ?? '', /^0\.\d+ s to \d+/);
  await done();
});

/** What is clicked in, and what the verdict is after it. */
const FAULTS = {
  none: /^the line works$/,
  parity: /B sends (another parity|characters outside the procedure: another parity)/,
  baud: /B sends characters outside the procedure/,
  open: /A is not heard by B/,
  'both-open': /neither side hears the other/,
  off: /B does not answer STX/,
  'both-high': /the same priority, high/,
  'both-low': /the same priority, low/,
  echo: /echo of a two-wire line/,
  'own-echo': /A breaks off its own blocks/,
  noise: /blocks of B/,
  late: /B answers .*later|B .*late/,
  pause: /B pauses/,
  'no-bcc': /B neither awaits a BCC nor sends one/,
  bcc: /B computes the BCC otherwise/,
  buffer: /B answers NAK to STX: no receive buffer/,
};

test('each simulated fault ends in its verdict', async () => {
  const { page, done } = await browser.visit('line.html?view=simulate');
  await page.locator('main[data-ready]').waitFor();
  const time = page.locator('#simulated-time');
  for (const [fault, verdict] of Object.entries(FAULTS)) {
    await page.locator('#scenario').selectOption(fault);
    await time.filter({ hasText: /^0\.0000 s/ }).waitFor();
    await page.getByRole('button', { name: 'Run 20 s' }).click();
    // The verdict may come before the end, and the files are of what was heard so far.
    await time.filter({ hasText: '20.0000 s' }).waitFor();
    await said(page, verdict);
    // What the tap has heard is a capture, and what is told of it is what the command line tells.
    const capture = file('capture.txt', await saved(page, 'capture.txt'));
    const printed = line3964r('monitor', capture).text;
    assert.equal((await saved(page, 'conversation.txt')).toString(), printed, fault);
  }
  await done();
});

test('the procedure is seen step by step', async () => {
  const script = `window.answers = 0;
    const Plain = Worker;
    window.Worker = class extends Plain {
      constructor(...parameters) {
        super(...parameters);
        this.addEventListener('message', () => (answers += 1));
      }
    };`;
  const { page, done } = await browser.visit('line.html?view=simulate', { script });
  await page.locator('main[data-ready]').waitFor();
  await page.getByLabel('both send by themselves').uncheck();
  await page.getByRole('button', { name: 'Run 20 s' }).click();
  const [a, b] = ['#station-a', '#station-b'].map((it) => page.locator(it));
  assert(a && b);
  await a.locator('.activity').filter({ hasText: 'idle' }).waitFor();
  await a.getByLabel('Telegram', { exact: true }).fill('41 10 1');
  await a.getByLabel('Telegram as').selectOption('hex');
  await a.getByRole('button', { name: 'Send' }).press('Enter');
  /** @type {string[]} */
  const seen = [];
  for (let step = 0; step < 40; step += 1) {
    const answers = await page.evaluate('answers');
    await page.getByRole('button', { name: 'Step' }).click();
    await page.waitForFunction(`answers > ${answers}`);
    const both = await Promise.all([a, b].map((it) => it.locator('.activity').textContent()));
    const now = both.join(' | ');
    if (seen.at(-1) !== now) seen.push(now);
    if (seen.length > 2 && now === 'idle | idle') break;
  }
  const expected = [
    'STX sent, waits for DLE: QVZ | idle',
    'STX sent, waits for DLE: QVZ | DLE sent, waits for the block: ZVZ',
    'sends the block | receives the block: ZVZ',
    'block sent, waits for DLE: QVZ | idle',
    'idle | idle',
  ];
  for (const state of expected) assert(seen.includes(state), `${state}\n${seen.join('\n')}`);
  await b.getByText('received 41 10 01').waitFor();
  await a.getByText('sent 3 bytes').waitFor();

  await a.getByLabel('Telegram', { exact: true }).fill('4g');
  await a.getByRole('button', { name: 'Send' }).click();
  await said(page, '`4g` is not made of hexadecimal bytes');
  await b.getByText('Faults').click();
  await b.getByLabel('Answers later').fill('-1');
  await b.getByLabel('Answers later').press('Tab');
  await said(page, 'B: delay: -1 is not a time in ms');
  await b.getByLabel('Answers later').fill('0');
  await b.getByLabel('Answers later').press('Tab');
  await a.getByLabel('Telegram', { exact: true }).fill('42');
  await a.getByRole('button', { name: 'Send' }).click();
  await page.locator('#rate').selectOption('10');
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.waitForFunction("parseFloat(document.getElementById('simulated-time').value) > 25");
  await page.getByRole('button', { name: 'Pause' }).click();
  await said(page, 'the line works');
  await done();
});

test('a station on a port exchanges telegrams with a station at its other end', async () => {
  const { page, done } = await browser.visit('line.html?view=port&parity=odd&baud=9600', {
    script: MOCK,
  });
  await page.getByRole('button', { name: 'Connect', exact: true }).click();
  await page.locator('#live-activity').filter({ hasText: 'idle' }).waitFor();
  assert.deepEqual(await page.evaluate('ports[0].options'), {
    baudRate: 9600,
    parity: 'odd',
    bufferSize: 4096,
  });
  const events = page.locator('#live-events');
  const telegram = page.locator('#live-send').getByLabel('Telegram', { exact: true });
  await telegram.fill('tare');
  await telegram.press('Enter');
  await events.getByText('sent 4 bytes').waitFor();
  await events.getByText('"tare: done"').waitFor();
  await said(page, 'the line works');

  // Commands of the machine, one after the other although each is a telegram.
  await page.getByRole('button', { name: 'home' }).click();
  await page.getByLabel('X in mm').fill('120.5');
  await page.getByRole('button', { name: 'line', exact: true }).click();
  await page.getByRole('button', { name: 'hold' }).click();
  await events.getByText('"hold: done"').waitFor();
  assert.deepEqual(await page.evaluate('ports[0].partner.received'), [
    'tare',
    'home',
    'line 120.5 100',
    'hold',
  ]);
  await page.getByText('A block of 4: 74 61 72 65').waitFor();

  // A damaged character is one more, and the port goes on.
  await page.evaluate("ports[0].damage('ParityError')");
  await page.getByText('B parity error in 00').waitFor();
  await page.evaluate("ports[0].damage('BreakError')");
  await events.getByText('BREAK on the line').waitFor();
  await page.getByRole('button', { name: 'where' }).click();
  await events.getByText('"where: done"').waitFor();

  await page.evaluate('ports[0].unplug()');
  await said(page, 'port: The device has been lost.');
  await page.getByRole('button', { name: 'Connect', exact: true }).click();
  await page.getByRole('button', { name: 'status' }).click();
  await events.getByText('"status: done"').waitFor();
  await page.getByRole('button', { name: 'Disconnect' }).click();
  await page.waitForFunction('!ports[1].isOpen');
  await page.getByLabel('Example').waitFor({ state: 'hidden' });
  const conversation = (await saved(page, 'conversation.txt')).toString();
  assert.match(conversation, /A block of 6: 73 74 61 74 75 73\n/);
  await done();
});

test('a port drives the firmware: home, lines, jogs, hold and resume', async (context) => {
  const { page, done } = await browser.visit('', { script: MOCK });
  context.after(await connectFirmware(page));
  await page.goto(`${browser.url}line.html?view=port`);
  await page.getByRole('button', { name: 'Connect', exact: true }).click();
  const events = page.locator('#live-events');
  /**
   * Gives a command, and waits for its answer.
   * @param {string} command
   * @param {RegExp} answer
   */
  const order = async (command, answer) => {
    await page.getByRole('button', { name: command, exact: true }).click();
    const told = events.locator('li:last-child').filter({ hasText: answer });
    await told.waitFor({ timeout: 60_000 }).catch(async () => {
      assert.fail(`no ${answer} after ${command}:\n${(await events.innerText()).trim()}`);
    });
  };
  await order('status', /"not homed, feed 100 %, 0 underruns"/);
  await order('line', /"refused: not homed"/);
  await order('home', /"done, x [-\d.]+ y [-\d.]+ mm, shoulder -90\.\d+ elbow 20\.\d+ degrees/);
  await order('jog', /"ok, in [\d.]+ s"/);
  await events.getByText('"done, x').nth(1).waitFor();

  await page.getByLabel('Feed, mm/s').fill('40');
  await order('line', /"ok, [\d.]+ mm in [\d.]+ s, within 0\.\d+ mm"/);
  await order('hold', /"held, x/);
  await order('status', /"held, feed 100 %/);
  await order('resume', /"done, x (149\.9|150\.0)\d+ y (99\.9|100\.0)\d+ mm/);
  await order('where', /"x (149\.9|150\.0)\d+ y (99\.9|100\.0)\d+ mm/);

  await page.getByLabel('X in mm').fill('500');
  await order('line', /"refused: /);
  await page.getByLabel('X in mm').fill('wide');
  await order('line', /"column 6: `wide` is no number of mm"/);
  await order('limits', /"reach 0\.0 to 264\.0 mm/);
  await said(page, 'the line works');
  await page.getByRole('button', { name: 'Disconnect' }).click();
  await page
    .getByRole('button', { name: 'Connect', exact: true })
    .and(page.locator(':enabled'))
    .waitFor();
  await done();
});

test('a tap on two ports hears both directions', async () => {
  const { page, done } = await browser.visit('line.html?view=port&role=tap', { script: MOCK });
  await page.getByRole('button', { name: 'Connect', exact: true }).click();
  await page.getByRole('button', { name: 'Disconnect' }).and(page.locator(':enabled')).waitFor();
  // The mock's stations say NAK at start-up.
  await page.getByText('A NAK without a question').waitFor();
  await page.getByText('B NAK without a question').waitFor();
  await page.evaluate('ports[0].play([0x02])');
  await page.getByText('A STX, attempt 1').waitFor();
  await page.evaluate('ports[1].play([0x15])');
  await page.getByText('B NAK to STX').waitFor();
  await said(page, 'B answers NAK to STX: no receive buffer');
  await done();
});

test('a browser without Web Serial is told so, and all else works', async () => {
  const script = "Object.defineProperty(navigator, 'serial', { value: undefined })";
  const { page, done } = await browser.visit('line.html?view=port', { script });
  await said(page, 'no Web Serial');
  assert(await page.getByRole('button', { name: 'Connect', exact: true }).isDisabled());
  await page.getByLabel('A capture').check();
  await said(page, 'another parity');
  await done();
});

for (const { scheme, size, viewport } of VIEWS) {
  test(`it is readable: ${scheme}, ${size}`, async () => {
    const options = { viewport, colorScheme: scheme, script: MOCK };
    const { page, done } = await browser.visit('line.html', options);
    await said(page, 'another parity');
    const look = async (/** @type {string} */ name) => {
      await assertAccessible(page);
      assert.equal(await page.evaluate('document.documentElement.scrollWidth'), viewport.width);
      await shoot(page, `line-${name}-${scheme}-${size}`);
    };
    await look('capture');
    await page.getByLabel('Two simulated stations').check();
    await page.locator('#scenario').selectOption('late');
    await page.getByRole('button', { name: 'Run 20 s' }).click();
    await said(page, 'B answers');
    await page.locator('#station-b').getByText('Faults').click();
    await look('simulation');
    await page.getByLabel('A serial port').check();
    await page.getByRole('button', { name: 'Connect', exact: true }).click();
    await page.getByRole('button', { name: 'home' }).click();
    await page.locator('#live-events').getByText('"home: done"').waitFor();
    await said(page, 'the line works');
    await look('port');
    await done();
  });
}
