// What a visitor loads: how much, from where, and whether it opens without a network.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { open } from './browser.js';

/** @type {Awaited<ReturnType<typeof open>>} */
let browser;
before(async () => {
  browser = await open();
});
after(() => browser.close());

/**
 * Compressed, of a page until it shows its machine at work; of one module for all pages not looked at. Engrave
 * is the largest: a fifth of its code reads SVG, an eighth TOML.
 */
const MAX_FIRST_VIEW_BYTES = process.env.PAGE_MODULES === 'one' ? Infinity : 640_000;
/** On the slowest machine that tests run on; a PC takes a second. */
const MAX_FIRST_VIEW_MS = 10_000;

const PAGES = ['index.html', 'dance.html', 'stage.html', 'delta.html', 'align.html', 'line.html'];

for (const path of PAGES) {
  test(`the first view of ${path} is small and soon there`, async () => {
    const { page, done } = await browser.visit('');
    /** @type {string[]} */
    const urls = [];
    page.on('request', (request) => urls.push(request.url()));
    const begin = performance.now();
    await page.goto(browser.url + path);
    await page.locator('main[data-ready]').waitFor();
    const ms = performance.now() - begin;
    // Asked for again: the browser does not keep for long what it has loaded.
    const bodies = urls.map(async (url) => (await fetch(url)).arrayBuffer());
    const sizes = (await Promise.all(bodies)).map((body) => gzipSync(body).length);
    const bytes = sizes.reduce((sum, size) => sum + size, 0);
    console.log(`${path}: ${Math.round(bytes / 1000)} KB compressed, ${Math.round(ms)} ms`);
    assert(bytes < MAX_FIRST_VIEW_BYTES, `${bytes} bytes`);
    assert(ms < MAX_FIRST_VIEW_MS, `${ms} ms`);
    await done();
  });
}

test('once loaded, all pages open without a network', async () => {
  const { page, done } = await browser.visit('index.html');
  await page.evaluate('navigator.serviceWorker.ready');
  await page.context().setOffline(true);
  for (const path of PAGES) {
    await page.goto(browser.url + path);
    await page.locator('main[data-ready]').waitFor();
  }
  await done();
});
