// The built page on a server of its own, in Debian's Chromium, with everything that goes wrong noted.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize, resolve } from 'node:path';
import axe from 'axe-core';
import { chromium } from 'playwright-core';

export const ROOT = resolve(import.meta.dirname, '../..');
const DIST = resolve(import.meta.dirname, '../dist');
const SHOTS = resolve(import.meta.dirname, '../screenshots');

/** The page must work from any folder of a server. */
const FOLDER = '/some/folder/';

/** @type {Record<string, string>} */
const TYPES = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.svg': 'image/svg+xml',
  '.wasm': 'application/wasm',
};

/** Serves the built page; tells its address. */
export async function serve() {
  const server = createServer((request, response) => {
    const path = new URL(request.url ?? '', 'http://localhost').pathname;
    try {
      assert(path.startsWith(FOLDER));
      const file = join(DIST, normalize(path.slice(FOLDER.length)) || 'index.html');
      assert(file.startsWith(DIST));
      const body = readFileSync(file);
      response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'text/plain' }).end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((ready) => server.listen(0, '127.0.0.1', () => ready(undefined)));
  const address = server.address();
  assert(address && typeof address === 'object');
  return { url: `http://127.0.0.1:${address.port}${FOLDER}`, close: () => server.close() };
}

/** Starts Chromium and the server, and closes both after the tests of a file. */
export async function open() {
  const server = await serve();
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox'],
  });
  /**
   * A page of its own browser profile; what the console says against it ends the test. No path: an empty page.
   * @param {string} path
   * @param {import('playwright-core').BrowserContextOptions & { script?: string }} [options]
   */
  async function visit(path, options = {}) {
    const { script, ...context } = {
      viewport: { width: 1280, height: 1000 },
      // Nothing plays by itself, unless a test wants it.
      reducedMotion: /** @type {const} */ ('reduce'),
      ...options,
    };
    const page = await (await browser.newContext(context)).newPage();
    if (script) await page.addInitScript(script);
    /** @type {string[]} */
    const complaints = [];
    page.on('console', (message) => {
      if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
    });
    page.on('pageerror', (error) => complaints.push(String(error)));
    page.on('request', (request) => {
      const { origin } = new URL(server.url);
      const isOwn = ['blob:', 'data:', origin].some((it) => request.url().startsWith(it));
      if (!isOwn) complaints.push(`a request to another host: ${request.url()}`);
    });
    if (path !== '') await page.goto(server.url + path);
    const done = async () => {
      assert.deepEqual(complaints, []);
      await page.context().close();
    };
    return { page, done };
  }
  const close = async () => {
    await browser.close();
    server.close();
  };
  return { visit, close, url: server.url };
}

/**
 * A script for a page: an order to its machine is on its way for a second.
 * @param {string} operation
 */
export const delayed = (operation) => `
  const post = Worker.prototype.postMessage;
  Worker.prototype.postMessage = function (order, ...rest) {
    if (order.operation !== '${operation}') post.call(this, order, ...rest);
    else setTimeout(() => post.call(this, order, ...rest), 1000);
  };`;

const SIZES = /** @type {const} */ ([
  ['wide', { width: 1280, height: 1000 }],
  ['phone', { width: 390, height: 844 }],
]);

/** In which a page is looked at: each size and each scheme once, or with PAGE_TEST_VIEWS=all both in both. */
export const VIEWS = SIZES.flatMap(([size, viewport], index) => {
  const schemes = /** @type {const} */ (['light', 'dark']);
  const own = process.env.PAGE_TEST_VIEWS === 'all' ? schemes : [schemes[index] ?? 'light'];
  return own.map((scheme) => ({ scheme, size, viewport }));
});

/**
 * A picture for a person to look at.
 * @param {import('playwright-core').Page} page
 * @param {string} name
 */
export async function shoot(page, name) {
  mkdirSync(SHOTS, { recursive: true });
  await page.screenshot({ path: join(SHOTS, `${name}.png`), fullPage: true });
}

/**
 * What axe finds serious.
 * @param {import('playwright-core').Page} page
 */
export async function assertAccessible(page) {
  await page.evaluate(axe.source);
  const found = await page.evaluate('axe.run()');
  const { violations } = /** @type {import('axe-core').AxeResults} */ (found);
  const serious = violations.filter((it) => ['serious', 'critical'].includes(it.impact ?? ''));
  const told = serious.map((it) => `${it.id}: ${it.nodes.map((node) => node.html).join('\n')}`);
  assert.deepEqual(told, []);
}

/** Chromium drops the tenth download of a page within a second, without a word. */
const BETWEEN_DOWNLOADS_MS = 150;

/**
 * The bytes that a button saves.
 * @param {import('playwright-core').Page} page
 * @param {string} name
 */
export async function saved(page, name) {
  const button = page.getByRole('button', { name, exact: true });
  const [download] = await Promise.all([
    page.waitForEvent('download', { timeout: 60_000 }),
    button.click(),
  ]).catch(async (error) => {
    const said = await page.locator('#status').textContent();
    const enabled = await button.isEnabled();
    assert.fail(`no ${name}, enabled: ${enabled}; the page says ${said}\n${error}`);
  });
  const bytes = readFileSync(await download.path());
  await page.waitForTimeout(BETWEEN_DOWNLOADS_MS);
  return bytes;
}

/**
 * Waits for a refusal and gives its words.
 * @param {import('playwright-core').Page} page
 * @param {string} part
 */
export async function refusal(page, part) {
  const status = page.locator('#status.bad').filter({ hasText: part });
  await status.waitFor();
  return (await status.textContent()) ?? '';
}
