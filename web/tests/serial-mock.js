// Serial ports for a page whose browser has none: at the other end of a port is a station in wasm, a recording that is played, or the firmware.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { ROOT } from './browser.js';

const WASM = readFileSync(join(ROOT, 'web/built/line.wasm')).toString('base64');

/** Replaces the browser's ports: the script for a page, before its own. */
export const MOCK = `(${install})(${JSON.stringify(WASM)})`;

/** A folder of cargo's with programs that are built. */
const BUILT = process.env.PAGE_TEST_PROGRAMS;

/** A folder with the Pico's programs, which run in emulation then: they are `firmware/emulate/run`'s. */
const BOARDS = process.env.PAGE_TEST_BOARDS;

/** Steps of each axis from its switch. @type {Record<string, string[]>} */
const FROM_SWITCHES = {
  arm: ['500', '300'],
  delta: ['-500', '-300', '-400'],
  stage: ['500', '300'],
};

/**
 * The serial line of a machine as a program.
 * @param {string} machine
 */
function firmware(machine) {
  if (BOARDS === undefined) return started(simulator(), [machine]);
  const program = join(ROOT, BOARDS, `${machine}-rp2040`);
  const emulator = join(ROOT, 'firmware/emulate/pico-serial.js');
  return started(process.execPath, [emulator, program, ...(FROM_SWITCHES[machine] ?? [])]);
}

/**
 * @param {string} program
 * @param {string[]} words
 */
function started(program, words) {
  return spawn(program, words, { stdio: ['pipe', 'pipe', 'inherit'] });
}

/** The machine on this computer as a program, which is built where it is not. */
function simulator() {
  if (BUILT) return join(ROOT, BUILT, 'examples/simulate');
  const args = [
    'build',
    '--quiet',
    '--locked',
    '--package',
    'board-machine',
    '--example',
    'simulate',
  ];
  const built = spawnSync('cargo', args, { cwd: ROOT, stdio: 'inherit' });
  assert.equal(built.status, 0);
  return join(ROOT, 'target/debug/examples/simulate');
}

/**
 * Puts the boards' firmware, run on this computer or in emulation, at the other end of the ports that a page with MOCK will open.
 * @param {import('playwright-core').Page} page
 * @param {string} [machine]
 */
export async function connectFirmware(page, machine = 'arm') {
  const board = firmware(machine);
  const ended = new Promise((end) => board.on('close', (status) => end(status)));
  board.stdout.on('data', (/** @type {Buffer} */ bytes) => {
    page.evaluate(`fromFirmware(${JSON.stringify([...bytes])})`).catch(() => undefined);
  });
  await page.exposeFunction('toFirmware', (/** @type {number[]} */ bytes) => {
    board.stdin.write(Uint8Array.from(bytes));
  });
  return async () => {
    board.stdin.end();
    assert.equal(await ended, 0);
  };
}

/**
 * Runs in the page. Each requested port is noted in `ports`.
 * @param {string} wasm
 */
function install(wasm) {
  /** Eleven bits at 9600 bit/s, in ms. */
  const CHARACTER_MS = 11 / 9.6;
  const later = (/** @type {number} */ ms) => new Promise((done) => setTimeout(done, ms));

  /** A station behind the exports of the machine's wasm. */
  class Partner {
    /** @type {any} */ #exports;
    #begin = performance.now();
    /** @type {(bytes: number[]) => void} */ #send = () => undefined;
    /** @type {string[]} */ received = [];
    /** Answers that wait until the one before has left. @type {string[]} */
    #answers = [];
    #deadline = 0;

    /** @param {(bytes: number[]) => void} send */
    async start(send) {
      const bytes = Uint8Array.from(atob(wasm), (it) => it.charCodeAt(0));
      const page = { progress: () => undefined };
      const { instance } = await WebAssembly.instantiate(bytes, { page });
      this.#exports = instance.exports;
      this.#send = send;
      const settings = { preset: 'siemens-3964r', priority: 'low', baud: 9600, bits: 11 };
      this.#call('line.station.begin', settings);
      this.push({});
    }

    /** @param {Record<string, unknown>} happened */
    push(happened) {
      const now_s = (performance.now() - this.#begin) / 1000;
      const answer = this.#call('line.station', { now_s, ...happened });
      const { transmit, events, deadlineS, isBusy } = answer;
      if (transmit.length > 0) this.#send(transmit);
      clearTimeout(this.#deadline);
      if (deadlineS !== null) {
        this.#deadline = window.setTimeout(() => this.push({}), (deadlineS - now_s) * 1000 + 1);
      }
      for (const { telegram } of events) {
        if (!telegram) continue;
        const text = String.fromCharCode(...telegram);
        this.received.push(text);
        // It answers as a machine does.
        this.#answers.push(`${text}: done`);
      }
      if (isBusy) return;
      const text = this.#answers.shift();
      if (text !== undefined) this.push({ send: { text, is_hex: false } });
    }

    /**
     * @param {string} operation
     * @param {unknown} parameters
     */
    #call(operation, parameters) {
      const { memory, input, call, output, output_length } = this.#exports;
      for (const text of [operation, JSON.stringify(parameters)]) {
        const bytes = new TextEncoder().encode(text);
        const address = input(bytes.length);
        new Uint8Array(memory.buffer, address, bytes.length).set(bytes);
      }
      const isDone = call() === 1;
      const answer = new Uint8Array(memory.buffer, output(0), output_length(0));
      const text = new TextDecoder().decode(answer);
      if (!isDone) throw new Error(text);
      return JSON.parse(text).value;
    }
  }

  /** The firmware in a process of its own, if a test has started one. */
  class Firmware {
    /** @param {(bytes: number[]) => void} send */
    async start(send) {
      Object.assign(window, { fromFirmware: send });
    }

    /** @param {{ bytes: number[] }} happened */
    push({ bytes }) {
      /** @type {any} */ (window).toFirmware(bytes);
    }
  }

  class Port extends EventTarget {
    /** @type {any} */ #controller;
    partner = 'toFirmware' in window ? new Firmware() : new Partner();
    /** @type {unknown} */ options;
    isOpen = false;
    /** Characters are on the wire one after the other. */
    #toPartner = Promise.resolve();
    #toPage = Promise.resolve();

    #stream() {
      this.readable = new ReadableStream({
        start: (controller) => (this.#controller = controller),
      });
    }

    /** @param {unknown} options */
    async open(options) {
      this.options = options;
      this.isOpen = true;
      this.#stream();
      this.writable = new WritableStream({
        write: (bytes) => {
          this.#toPartner = this.#toPartner.then(async () => {
            await later(bytes.length * CHARACTER_MS);
            this.partner.push({ bytes: [...bytes] });
          });
        },
      });
      await this.partner.start((bytes) => this.play(bytes));
    }

    async close() {
      this.isOpen = false;
    }

    /** @param {number[]} bytes What the page hears. */
    play(bytes) {
      this.#toPage = this.#toPage.then(async () => {
        await later(bytes.length * CHARACTER_MS + 2);
        if (this.isOpen) this.#controller.enqueue(new Uint8Array(bytes));
      });
    }

    /** @param {string} name A damaged character, after which the port has another stream. */
    damage(name) {
      const { error } = this.#controller;
      const failed = this.#controller;
      this.#stream();
      error.call(failed, new DOMException('damaged', name));
    }

    unplug() {
      this.#controller.error(new DOMException('The device has been lost.', 'NetworkError'));
      this.readable = null;
    }
  }

  /** @type {Port[]} */
  const ports = [];
  Object.assign(window, { ports });
  const requestPort = async () => {
    ports.push(new Port());
    return ports.at(-1);
  };
  Object.defineProperty(navigator, 'serial', { value: { requestPort } });
}
