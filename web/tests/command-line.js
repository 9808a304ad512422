// The command lines of the machines, which the page is compared with.
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { ROOT } from './browser.js';

export const DRAWINGS = join(ROOT, 'machines/engraver/drawings');
export const STAGE_DRAWINGS = join(ROOT, 'machines/stage/drawings');

/** A folder of cargo's with programs that are built: any profile gives the same bytes. */
const BUILT = process.env.PAGE_TEST_PROGRAMS;

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
 * Runs a program: what is built, or else what `cargo run` builds.
 * @param {string} path below the folder of what is built
 * @param {string[]} cargo
 * @param {string[]} args
 */
function run(path, cargo, args) {
  const command = BUILT ? join(ROOT, BUILT, path) : 'cargo';
  const all = BUILT ? args : ['run', '--quiet', '--release', ...cargo, '--', ...args];
  const ended = spawnSync(command, all, { cwd: ROOT, encoding: 'utf8' });
  if (ended.error) throw ended.error;
  return { status: ended.status, text: ended.stdout + ended.stderr };
}

/**
 * Runs a machine; tells where its files are, what it printed and its exit status.
 * @param {string} example
 * @param {string[]} args
 */
export function commandLine(example, args) {
  const folder = folderOfTests(`${example}-`);
  const all = [...args, '--out', folder];
  return { folder, ...run(`examples/${example}`, ['--example', example], all) };
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
 * Runs `line3964r`; tells what it printed and its exit status.
 * @param {string[]} args
 */
export function line3964r(...args) {
  const cargo = ['--package', 'line3964r', '--no-default-features', '--features', 'cli'];
  return run('line3964r', cargo, args);
}
