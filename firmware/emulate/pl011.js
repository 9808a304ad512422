// The UART of the RP2040, an ARM PL011: FIFOs with thresholds, characters that take their time on the
// line, the receive timeout, and a transmit interrupt that comes when the FIFO empties and ends when
// it is cleared.

import { BasePeripheral } from "rp2040js";

const DR = 0x00;
const FR = 0x18;
const IBRD = 0x24;
const FBRD = 0x28;
const LCR_H = 0x2c;
const CR = 0x30;
const IFLS = 0x34;
const IMSC = 0x38;
const RIS = 0x3c;
const MIS = 0x40;
const ICR = 0x44;
const DMACR = 0x48;

const RX = 1 << 4;
const TX = 1 << 5;
const RECEIVE_TIMEOUT = 1 << 6;
const FRAMING = 1 << 7;
const PARITY = 1 << 8;
const BREAK = 1 << 9;
const OVERRUN = 1 << 10;

const FIFO_SIZE = 32;
/** Eighths of the FIFO that IFLS chooses. */
const EIGHTHS = [1, 2, 4, 6, 7];
/** Bits without a character until the receive timeout. */
const TIMEOUT_BITS = 32;

/** Errors of a received character, as DR has them above its data. */
export const CHARACTER_ERRORS = {
  framing: 1 << 8,
  parity: 1 << 9,
  break: 1 << 10,
  overrun: 1 << 11,
};

const INTERRUPT_OF = [
  [CHARACTER_ERRORS.framing, FRAMING],
  [CHARACTER_ERRORS.parity, PARITY],
  [CHARACTER_ERRORS.break, BREAK],
  [CHARACTER_ERRORS.overrun, OVERRUN],
];

export class Pl011 extends BasePeripheral {
  #irq;
  #clock;
  #received = [];
  #overrun = false;
  #toSend = [];
  /** In the shift register. */
  #sending;
  #sent;
  #timeout;
  #registers = { [IBRD]: 0, [FBRD]: 0, [LCR_H]: 0, [CR]: 0x300, [IFLS]: 0x12, [IMSC]: 0, [DMACR]: 0 };
  #raw = 0;
  /** Called with each byte when its stop bit ends. */
  onByte = () => {};

  constructor(rp2040, name, irq) {
    super(rp2040, name);
    this.#irq = irq;
    this.#clock = rp2040.clock;
    this.#sent = this.#clock.createAlarm(() => this.#endCharacter());
    this.#timeout = this.#clock.createAlarm(() => {
      this.#raw |= RECEIVE_TIMEOUT;
      this.#update();
    });
  }

  get #bitNanos() {
    const divider = this.#registers[IBRD] + this.#registers[FBRD] / 64;
    return (16e9 * divider) / this.rp2040.clkPeri;
  }

  get #characterNanos() {
    const lcr = this.#registers[LCR_H];
    const [parity, stop, data] = [(lcr >> 1) & 1, 1 + ((lcr >> 3) & 1), 5 + ((lcr >> 5) & 3)];
    return (1 + data + parity + stop) * this.#bitNanos;
  }

  #threshold(shift) {
    return (FIFO_SIZE * (EIGHTHS[(this.#registers[IFLS] >> shift) & 7] ?? 7)) / 8;
  }

  /** A character that has come in. */
  receive(byte, errors = 0) {
    const isOn = (this.#registers[CR] & 0x201) === 0x201;
    if (!isOn) {
      return;
    }
    if (this.#received.length < FIFO_SIZE) {
      const lost = this.#overrun ? CHARACTER_ERRORS.overrun : 0;
      this.#overrun = false;
      this.#received.push(byte | errors | lost);
    } else {
      this.#overrun = true;
      this.#raw |= OVERRUN;
    }
    for (const [error, interrupt] of INTERRUPT_OF) {
      this.#raw |= errors & error ? interrupt : 0;
    }
    if (this.#received.length >= this.#threshold(3)) {
      this.#raw |= RX;
    }
    this.#timeout.schedule(TIMEOUT_BITS * this.#bitNanos);
    this.#update();
  }

  #read() {
    const word = this.#received.shift() ?? 0;
    if (this.#received.length < this.#threshold(3)) {
      this.#raw &= ~RX;
    }
    if (this.#received.length === 0) {
      this.#raw &= ~RECEIVE_TIMEOUT;
      this.#timeout.cancel();
    }
    this.#update();
    return word;
  }

  #send(byte) {
    if (this.#toSend.length < FIFO_SIZE) {
      this.#toSend.push(byte & 0xff);
    }
    if (this.#toSend.length > this.#threshold(0)) {
      this.#raw &= ~TX;
    }
    if (this.#sending === undefined) {
      this.#begin();
    }
    this.#update();
  }

  #begin() {
    const wasAbove = this.#toSend.length > this.#threshold(0);
    this.#sending = this.#toSend.shift();
    if (this.#sending === undefined) {
      return;
    }
    this.#sent.schedule(this.#characterNanos);
    if (wasAbove && this.#toSend.length <= this.#threshold(0)) {
      this.#raw |= TX;
    }
  }

  #endCharacter() {
    const byte = this.#sending;
    this.#begin();
    this.#update();
    this.onByte(byte);
  }

  #update() {
    this.rp2040.setInterrupt(this.#irq, (this.#raw & this.#registers[IMSC]) !== 0);
  }

  readUint32(offset) {
    switch (offset) {
      case DR:
        return this.#read();
      case FR:
        return (
          (this.#toSend.length === 0 ? 1 << 7 : 0) |
          (this.#received.length === FIFO_SIZE ? 1 << 6 : 0) |
          (this.#toSend.length === FIFO_SIZE ? 1 << 5 : 0) |
          (this.#received.length === 0 ? 1 << 4 : 0) |
          (this.#sending !== undefined ? 1 << 3 : 0)
        );
      case RIS:
        return this.#raw;
      case MIS:
        return this.#raw & this.#registers[IMSC];
      case ICR:
        return 0;
      default:
        return this.#registers[offset] ?? super.readUint32(offset);
    }
  }

  writeUint32(offset, value) {
    if (offset === DR) {
      this.#send(value);
    } else if (offset === ICR) {
      this.#raw &= ~this.rawWriteValue;
    } else if (offset in this.#registers) {
      this.#registers[offset] = value;
    } else {
      super.writeUint32(offset, value);
    }
    this.#update();
  }
}
