// Every machine is a page of its own; all addresses are relative, so that any folder of any web
// server will do.
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { defineConfig, type Plugin } from 'vite';

const pages = readdirSync(import.meta.dirname).filter((name) => name.endsWith('.html'));

/** Parts that pages have in common, each at a comment with its name. */
const PARTS = [
  'head',
  'header',
  'transport',
  'views',
  'limits',
  'working',
  'machine',
  'load',
  'choice',
  'board',
];

/** Puts the common parts into each page. */
function frame(): Plugin {
  const part = (name: string) =>
    readFileSync(resolve(import.meta.dirname, 'src/shared', name), 'utf8');
  return {
    name: 'frame',
    transformIndexHtml: {
      order: 'pre',
      handler: (html, { filename }) => {
        const page = filename.slice(filename.lastIndexOf('/') + 1);
        const header = part('header.part').replace(
          `href="./${page}"`,
          `href="./${page}" aria-current="page"`,
        );
        return PARTS.reduce(
          (text, name) =>
            text.replace(`<!-- ${name} -->`, name === 'header' ? header : part(`${name}.part`)),
          html,
        );
      },
    },
  };
}

/** Writes the list of all files into the service worker, which keeps them for use without a network. */
function offline(): Plugin {
  let folder = '';
  return {
    name: 'offline',
    apply: 'build',
    configResolved: (config) => {
      folder = resolve(config.root, config.build.outDir);
    },
    closeBundle: () => {
      const files = readdirSync(folder, { recursive: true, withFileTypes: true })
        .filter((entry) => entry.isFile() && entry.name !== 'offline.js')
        .map((entry) => join(entry.parentPath, entry.name).slice(folder.length + 1));
      const file = join(folder, 'offline.js');
      // The names of the assets change with what is in them, and the list with these.
      writeFileSync(
        file,
        readFileSync(file, 'utf8').replace('[/* files */]', JSON.stringify(files)),
      );
    },
  };
}

export default defineConfig({
  base: './',
  // The Pico of firmware/emulate has what it needs of npm from here.
  resolve: {
    alias: { rp2040js: resolve(import.meta.dirname, 'node_modules/rp2040js/dist/esm/index.js') },
  },
  plugins: [frame(), offline()],
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    rolldownOptions: { input: pages.map((page) => resolve(import.meta.dirname, page)) },
  },
  // `rp2040js` asks Node.js for its clock in such a way, where there is one.
  worker: { format: 'es', rolldownOptions: { checks: { eval: false } } },
});
