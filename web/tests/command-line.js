// The command lines of the machines, which the page is compared with.
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { ROOT } from './browser.js';

export const DRAWINGS = join(ROOT, 'machines/engraver/drawings');
export const STAGE_DRAWINGS = join(ROOT, 'machines/stage/drawings');

/** Any profile gives the same bytes. */
const PROFILE = process.env.PAGE_TEST_PROFILE ?? 'release';

/** @type {string[]} */
const folders = [];
process.once('exit', () => {
  for (const folder of folders) rmSync(folder, { recursive: true });
});

/**
 * A new folder, gone with the tests.
 * @param {string} prefix
 */
function folderOfTests(prefix) {
  const folder = mkdtempSync(join(tmpdir(), prefix));
  folders.push(folder);
  return folder;
}

/**
 * Runs a machine; tells where its files are, what it printed and its exit status.
 * @param {string} example
 * @param {string[]} args
 */
export function commandLine(example, args) {
  const folder = folderOfTests(`${example}-`);
  const cargo = ['run', '--quiet', '--profile', PROFILE, '--example', example, '--'];
  const all = [...cargo, ...args, '--out', folder];
  const run = spawnSync('cargo', all, { cwd: ROOT, encoding: 'utf8' });
  if (run.error) throw run.error;
  return { folder, status: run.status, text: run.stdout + run.stderr };
}

/**
 * A file in a folder of its own.
 * @param {string} name
 * @param {string | Buffer} contents
 */
export function file(name, contents) {
  const path = join(folderOfTests('page-'), name);
  writeFileSync(path, contents);
  return path;
}

/**
 * Runs `line3964r`, without its gateway; tells what it printed and its exit status.
 * @param {string[]} args
 */
export function line3964r(...args) {
  const cargo = ['run', '--quiet', '--profile', PROFILE, '--package', 'line3964r'];
  const all = [...cargo, '--no-default-features', '--features', 'cli', '--', ...args];
  const run = spawnSync('cargo', all, { cwd: ROOT, encoding: 'utf8' });
  if (run.error) throw run.error;
  return { status: run.status, text: run.stdout + run.stderr };
}
