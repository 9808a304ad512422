// Writes docs/page.png: the six built pages beside each other, as a visitor finds them.
import { join } from 'node:path';
import { open, ROOT } from './browser.js';

/** Each with the time at which its machine is shown, if it has one, in s. */
const PAGES = Object.entries({
  'index.html': 150,
  'dance.html': 24.6,
  'stage.html': 24,
  'delta.html': 4.5,
  'align.html': 4.5,
  'line.html': undefined,
});
const VIEW = { width: 1280, height: 960 };
/** Of each page, so that two stand side by side. */
const WIDTH = 632;

const browser = await open();
/** @type {string[]} */
const shots = [];
for (const [path, seconds] of PAGES) {
  const { page, done } = await browser.visit(path, { viewport: VIEW });
  await page.locator('main[data-ready]').waitFor({ timeout: 120_000 });
  if (seconds !== undefined) {
    const time = page.locator('#time');
    await time.fill(String(seconds));
    await time.blur();
  }
  // The canvases are drawn before the next frame.
  await page.waitForTimeout(500);
  shots.push((await page.screenshot()).toString('base64'));
  await done();
}
const { page, done } = await browser.visit('', { viewport: { width: 1280, height: 800 } });
const pictures = shots.map((it) => `<img src="data:image/png;base64,${it}">`);
await page.setContent(`<style>
  body { margin: 0; padding: 4px; display: grid; grid-template-columns: 1fr 1fr; gap: 8px; background: #d4d8de; }
  img { width: ${WIDTH}px; display: block; }
</style>${pictures.join('')}`);
await page.screenshot({ path: join(ROOT, 'docs/page.png'), fullPage: true });
await done();
await browser.close();
