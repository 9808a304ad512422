"""The STM32F411 as the boards' firmware uses it, by `unicorn`.

`unicorn` carries out the instructions of a Cortex-M4F; what lies around it is here: interrupts with
their priorities, WFE and SEV, clocks, TIM5 as the clock, USART2, TIM3 and TIM4 as counters of scales,
and TIM1 whose every update makes the DMA write a word to a port. An instruction takes a cycle:
`unicorn` does not know how many. Time goes on by slices of at most `SLICE` instructions; what the
program reads of it is the slice's begin.
"""

import struct

from unicorn import UC_ARCH_ARM, UC_HOOK_CODE, UC_MODE_MCLASS, UC_MODE_THUMB
from unicorn import Uc, UcError
from unicorn.arm_const import (
    UC_ARM_REG_LR,
    UC_ARM_REG_PC,
    UC_ARM_REG_PRIMASK,
    UC_ARM_REG_SP,
    UC_ARM_REG_XPSR,
    UC_CPU_ARM_CORTEX_M4,
)
from unicorn.arm_const import UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3, UC_ARM_REG_R12

CYCLES_PER_SECOND = 84_000_000
SLICE = 400
MASKED_SLICE = 40
NEVER = 1 << 62

FLASH, FLASH_SIZE = 0x0800_0000, 512 << 10
RAM, RAM_SIZE = 0x2000_0000, 128 << 10
# Where handlers return to: there is nothing.
RETURN = 0x3000_0000
# What an exception keeps: eight words, FPSCR and 16 registers of the FPU, and one to align them.
FRAME = 26 * 4

PERIPHERALS, PERIPHERALS_SIZE = 0x4000_0000, 0x80000
SYSTEM, SYSTEM_SIZE = 0xE000_0000, 0x100000

WFI, WFE, SEV = (struct.pack("<H", opcode) for opcode in (0xBF30, 0xBF20, 0xBF40))


class Peripheral:
    """Registers that keep what is written to them. `read_NAME` and `write_NAME` of a subclass take
    the place of what `registers` names."""

    registers = {}

    def __init__(self, chip):
        self.chip = chip
        self.values = {}
        self.reads = {at: getattr(self, f"read_{name}", None) for at, name in self.registers.items()}
        self.writes = {at: getattr(self, f"write_{name}", None) for at, name in self.registers.items()}

    def read(self, offset):
        read = self.reads.get(offset)
        return read() if read else self.values.get(offset, 0)

    def write(self, offset, value):
        write = self.writes.get(offset)
        if write:
            write(value)
        else:
            self.values[offset] = value

    def advance(self, cycle):
        """What has happened up to a cycle."""

    def next_event(self):
        """The cycle at which an interrupt may be asked for next."""
        return NEVER

    def pending(self):
        """Interrupts that are asked for."""
        return ()


class Rcc(Peripheral):
    """Clocks that are ready as soon as they are switched on."""

    registers = {0x00: "cr", 0x08: "cfgr", 0x70: "bdcr", 0x74: "csr"}

    def read_cr(self):
        on = self.values.get(0x00, 0x81)
        return on | (on & 0x0101_0001) << 1 | (on & 0x0400_0000) << 1

    def read_cfgr(self):
        value = self.values.get(0x08, 0)
        return (value & ~0xC) | (value & 3) << 2

    def read_csr(self):
        on = self.values.get(0x74, 0)
        return on | (on & 1) << 1


class Pwr(Peripheral):
    registers = {0x04: "csr"}

    def read_csr(self):
        return 0x4000


class Gpio(Peripheral):
    """A port; inputs come from `chip.inputs`."""

    registers = {0x10: "idr", 0x18: "bsrr"}

    def __init__(self, chip, name, base):
        super().__init__(chip)
        self.name = name
        self.set_reset_address = PERIPHERALS + base + 0x18

    def read_idr(self):
        return self.chip.inputs(self.name) | self.driven()

    def write_bsrr(self, value):
        self.set_reset(value, self.chip.cycle)

    def set_reset(self, value, cycle):
        output = self.values.get(0x14, 0)
        self.values[0x14] = (output & ~(value >> 16)) | value & 0xFFFF
        self.chip.outputs(self.name, self.driven(), cycle)

    def driven(self):
        """Levels of the pins that are outputs."""
        modes, levels = self.values.get(0x00, 0), self.values.get(0x14, 0)
        return sum(1 << pin for pin in range(16) if modes >> 2 * pin & 3 == 1 and levels >> pin & 1)


class Clock(Peripheral):
    """TIM5, 16 bits of it, from 0 to 65535 and on: compares 1 and 2, and the overflow."""

    registers = {0x00: "cr1", 0x0C: "dier", 0x10: "sr", 0x14: "egr", 0x24: "cnt"}
    IRQ = 50
    PERIOD = 0x10000

    def __init__(self, chip):
        super().__init__(chip)
        self.flags = 0
        self.started = None
        # The counts of `advance`, all that there have been.
        self.counted = 0

    def write_cr1(self, value):
        self.values[0x00] = value
        if value & 1 and self.started is None:
            self.started, self.counted = self.chip.cycle, 0

    def cycles_per_count(self):
        return self.values.get(0x28, 0) + 1

    def read_cnt(self):
        return self.counted % self.PERIOD

    def read_dier(self):
        return self.values.get(0x0C, 0)

    def read_sr(self):
        return self.flags

    def write_sr(self, value):
        self.flags &= value

    def write_egr(self, value):
        del value

    def marks(self):
        """Flags, with the counts that set them."""
        return [(1, 0), (2, self.values.get(0x34, 0)), (4, self.values.get(0x38, 0))]

    def advance(self, cycle):
        if self.started is None:
            return
        now = (cycle - self.started) // self.cycles_per_count()
        for flag, mark in self.marks():
            if (now - mark) // self.PERIOD > (self.counted - mark) // self.PERIOD:
                self.flags |= flag
        self.counted = now

    def next_event(self):
        if self.started is None:
            return NEVER
        counts = min((mark - self.counted - 1) % self.PERIOD + 1 for _, mark in self.marks())
        return self.started + (self.counted + counts) * self.cycles_per_count()

    def pending(self):
        return (self.IRQ,) if self.flags & self.read_dier() else ()


class Usart(Peripheral):
    """USART2: one character in the shift register and one in the data register, each way."""

    registers = {0x00: "sr", 0x04: "dr"}
    IRQ = 38
    PARITY, FRAMING, OVERRUN, IDLE, RXNE, TC, TXE = (1 << bit for bit in (0, 1, 3, 4, 5, 6, 7))

    def __init__(self, chip):
        super().__init__(chip)
        self.status = self.TC | self.TXE
        self.received = 0
        self.sending = None
        self.waiting = None
        self.sent_at = NEVER
        self.idle_at = NEVER
        # Characters on their way in: end, byte, error flag.
        self.coming = []

    def character(self):
        cr1, brr = self.values.get(0x0C, 0), self.values.get(0x08, 1)
        bits = 11 if cr1 >> 12 & 1 else 10
        # PCLK1 is half of the processor's clock.
        return bits * brr * 2

    def read_sr(self):
        return self.status

    def write_sr(self, value):
        # Only these are cleared by a write.
        self.status &= value | ~(self.TC | self.RXNE)

    def read_dr(self):
        self.status &= ~(self.RXNE | self.OVERRUN | self.IDLE | self.PARITY | self.FRAMING)
        return self.received

    def write_dr(self, value):
        self.status &= ~self.TC
        if self.sending is None:
            self.begin(value & 0xFF, self.chip.cycle)
        else:
            self.waiting = value & 0xFF
            self.status &= ~self.TXE

    def begin(self, byte, cycle):
        self.sending = byte
        self.sent_at = cycle + self.character()

    def advance(self, cycle):
        while self.sent_at <= cycle:
            self.chip.sent.append((self.sent_at, self.sending))
            at, self.sending, self.sent_at = self.sent_at, None, NEVER
            if self.waiting is None:
                self.status |= self.TC
            else:
                self.begin(self.waiting, at)
                self.waiting = None
                self.status |= self.TXE
        while self.coming and self.coming[0][0] <= cycle:
            end, byte, error = self.coming.pop(0)
            if not self.values.get(0x0C, 0) & 4:
                continue
            if self.status & self.RXNE:
                self.status |= self.OVERRUN
            else:
                self.received = byte
                self.status |= self.RXNE | error
            self.idle_at = end + self.character()
        if self.idle_at <= cycle:
            self.idle_at = NEVER
            if not (self.coming and self.coming[0][0] - self.character() <= cycle):
                self.status |= self.IDLE

    def next_event(self):
        return min(self.sent_at, self.idle_at, self.coming[0][0] if self.coming else NEVER)

    def pending(self):
        cr1 = self.values.get(0x0C, 0)
        asked = self.status & cr1 & (self.IDLE | self.RXNE | self.TC | self.TXE)
        asked |= self.status & self.OVERRUN if cr1 & self.RXNE else 0
        asked |= self.status & self.PARITY if cr1 & 0x100 else 0
        return (self.IRQ,) if asked else ()


class Ticker(Peripheral):
    """TIM1: an update every (PSC + 1) (ARR + 1) cycles, from when it is enabled."""

    registers = {0x00: "cr1", 0x14: "egr"}

    def __init__(self, chip):
        super().__init__(chip)
        self.started = None

    def write_cr1(self, value):
        self.values[0x00] = value
        if value & 1 and self.started is None:
            self.started = self.chip.cycle
        elif not value & 1:
            self.started = None

    def write_egr(self, value):
        del value

    def period(self):
        return (self.values.get(0x28, 0) + 1) * (self.values.get(0x2C, 0xFFFF) + 1)

    def asks_dma(self):
        return self.started is not None and self.values.get(0x0C, 0) & 0x100


class Counter(Peripheral):
    """TIM3 or TIM4 as the counter of a scale: both edges of both signals, up and down."""

    registers = {0x00: "cr1", 0x24: "cnt"}
    BOTH_EDGES, DIRECT_INPUTS = 3, 0x0101
    ALTERNATE = 2

    def __init__(self, chip, scale, port, pins):
        super().__init__(chip)
        self.scale, self.port, self.pins = scale, port, pins
        self.started = None

    def write_cr1(self, value):
        self.values[0x00] = value
        if value & 1 and self.started is None:
            self.started = self.scale()

    def read_cnt(self):
        if self.started is None or not self.hears_scale():
            return 0
        return (self.scale() - self.started) % (self.values.get(0x2C, 0xFFFF) + 1)

    def hears_scale(self):
        """Whether slave mode, inputs and pins are those of a counter."""
        mode, inputs = self.values.get(0x08, 0) & 7, self.values.get(0x18, 0) & 0x0303
        return (mode, inputs) == (self.BOTH_EDGES, self.DIRECT_INPUTS) and all(map(self.is_heard, self.pins))

    def is_heard(self, pin):
        modes, functions = self.port.values.get(0x00, 0), self.port.values.get(0x20, 0)
        return (modes >> 2 * pin & 3, functions >> 4 * pin & 15) == (2, self.ALTERNATE)


class Dma(Peripheral):
    """DMA2, its stream 5: words of a ring to a port, one for each update of TIM1."""

    registers = {0x04: "hisr", 0x0C: "hifcr", 0x88: "cr5", 0x8C: "ndtr5"}
    IRQ = 68
    HALF, COMPLETE = 1 << 10, 1 << 11

    def __init__(self, chip, ticker, port):
        super().__init__(chip)
        self.ticker, self.port = ticker, port
        self.flags = 0
        self.length = self.left = 0
        # Updates of the timer that are done.
        self.updates = 0

    def read_hisr(self):
        return self.flags

    def write_hifcr(self, value):
        self.flags &= ~value

    def write_cr5(self, value):
        self.values[0x88] = value
        if value & 1 and self.values.get(0x90) != self.port.set_reset_address:
            raise RuntimeError(f"DMA to {self.values.get(0x90):#x}, which is no port's register")

    def read_ndtr5(self):
        return self.left

    def write_ndtr5(self, value):
        self.length = self.left = value

    def is_on(self):
        return self.values.get(0x88, 0) & 1 and self.ticker.asks_dma()

    def advance(self, cycle):
        if not self.is_on():
            return
        started, period = self.ticker.started, self.ticker.period()
        due = (cycle - started) // period
        half = self.length // 2
        while self.updates < due:
            count = min(due - self.updates, self.left - (half if self.left > half else 0))
            start = self.values[0x94] + 4 * (self.length - self.left)
            words = bytes(self.chip.core.mem_read(start, 4 * count))
            if words.strip(b"\0"):
                for index, (word,) in enumerate(struct.iter_unpack("<I", words), self.updates + 1):
                    if word:
                        self.port.set_reset(word, started + index * period)
            self.updates += count
            self.left -= count
            if self.left == half:
                self.flags |= self.HALF
            elif self.left == 0:
                self.flags |= self.COMPLETE
                self.left = self.length

    def next_event(self):
        if not self.is_on():
            return NEVER
        half = self.length // 2
        updates = self.updates + self.left - (half if self.left > half else 0)
        return self.ticker.started + updates * self.ticker.period()

    def pending(self):
        control = self.values.get(0x88, 0)
        asked = self.flags & self.HALF and control & 8 or self.flags & self.COMPLETE and control & 16
        return (self.IRQ,) if asked else ()


class System(Peripheral):
    """The NVIC, and what else is the processor's own."""

    def __init__(self, chip):
        super().__init__(chip)
        self.enabled = set()
        self.software = set()
        self.priorities = {}

    def read(self, offset):
        if offset == 0xED04:
            return self.chip.active[-1][0] + 16 if self.chip.active else 0
        if 0xE400 <= offset < 0xE4F0:
            return sum(self.priorities.get(offset - 0xE400 + i, 0) << 8 * i for i in range(4))
        base, irqs = offset & ~0x7F, range((offset & 0x7F) * 8, (offset & 0x7F) * 8 + 32)
        chosen = {0xE100: self.enabled, 0xE180: self.enabled, 0xE200: self.software, 0xE280: self.software}
        if base in chosen:
            return sum(1 << irq % 32 for irq in irqs if irq in chosen[base])
        return self.values.get(offset, 0)

    def write(self, offset, value):
        irqs = {(offset & 0x7F) * 8 + bit for bit in range(32) if value >> bit & 1}
        match offset & ~0x7F:
            case 0xE100:
                self.enabled |= irqs
            case 0xE180:
                self.enabled -= irqs
            case 0xE200:
                self.software |= irqs
            case 0xE280:
                self.software -= irqs
            case _ if 0xE400 <= offset < 0xE4F0:
                self.write_priority(offset - 0xE400, value)
            case _ if offset == 0xEF00:
                self.software.add(value & 0x1FF)
            case _:
                self.values[offset] = value

    def write_priority(self, irq, value):
        self.priorities[irq] = value & 0xF0


class Chip:
    """The microcontroller. `inputs` gives the levels of a port's pins, `outputs` takes them with the
    cycle in which they change. `scales` are two functions that give the counts of TIM3 and TIM4."""

    def __init__(self, segments, inputs, outputs, scales, cycle=0):
        self.inputs, self.outputs, self.cycle = inputs, outputs, cycle
        self.begun = cycle
        self.sent = []
        self.core = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        self.core.ctl_set_cpu_model(UC_CPU_ARM_CORTEX_M4)
        self.core.mem_map(FLASH, FLASH_SIZE)
        self.core.mem_map(RAM, RAM_SIZE)
        self.core.mem_map(RETURN, 0x1000)
        for address, data in segments:
            self.core.mem_write(address, data)
            self.hear_events(address, data)
        places = zip("ABCDEH", (0x2_0000, 0x2_0400, 0x2_0800, 0x2_0C00, 0x2_1000, 0x2_1C00))
        self.ports = {name: Gpio(self, name, base) for name, base in places}
        self.usart, ticker = Usart(self), Ticker(self)
        self.system = System(self)
        of_tim3, of_tim4 = scales
        self.peripherals = {
            0x0400: Counter(self, of_tim3, self.ports["A"], (6, 7)),
            0x0800: Counter(self, of_tim4, self.ports["B"], (6, 7)),
            0x0C00: Clock(self),
            0x4400: self.usart,
            0x7000: Pwr(self),
            0x1_0000: ticker,
            0x2_3800: Rcc(self),
            0x2_6400: Dma(self, ticker, self.ports["A"]),
        } | {port.set_reset_address - PERIPHERALS - 0x18: port for port in self.ports.values()}
        self.timed = [self.peripherals[base] for base in (0x0C00, 0x4400, 0x2_6400)]
        self.core.mmio_map(PERIPHERALS, PERIPHERALS_SIZE, self.read, None, self.write, None)
        self.core.mmio_map(SYSTEM, SYSTEM_SIZE, self.read_system, None, self.write_system, None)
        # Interrupts that are being served: number, what was interrupted.
        self.active = []
        self.event = False
        self.asleep = False
        self.waits_at = None
        stack, start = struct.unpack("<II", self.core.mem_read(FLASH, 8))
        self.core.reg_write(UC_ARM_REG_SP, stack)
        self.pc = start & ~1

    def hear_events(self, address, data):
        """`unicorn` passes over SEV, and knows no WFE."""

        def set_event(core, place, size, chip):
            del core, place, size
            chip.event = True

        def wait_for_event(core, place, size, chip):
            del size
            chip.waits_at = place
            core.emu_stop()

        for opcode, hook in ((SEV, set_event), (WFE, wait_for_event)):
            at = data.find(opcode)
            while at >= 0:
                # Elsewhere it is the half of another instruction, where the hook is never called.
                if at % 2 == 0:
                    self.core.hook_add(UC_HOOK_CODE, hook, self, address + at, address + at)
                at = data.find(opcode, at + 1)

    def peripheral(self, offset):
        base = offset & ~0x3FF
        if base not in self.peripherals:
            self.peripherals[base] = Peripheral(self)
        return self.peripherals[base]

    def read(self, core, offset, size, data):
        del core, size, data
        value = self.peripheral(offset).read(offset & 0x3FC)
        return value >> 8 * (offset & 3)

    def write(self, core, offset, size, value, data):
        del core, size, data
        self.peripheral(offset).write(offset & 0x3FF, value)

    def read_system(self, core, offset, size, data):
        del core, size, data
        return self.system.read(offset & ~3) >> 8 * (offset & 3)

    def write_system(self, core, offset, size, value, data):
        del core, size, data
        self.system.write(offset, value)

    def run(self, until):
        """Goes on to a cycle, or until a byte has been sent."""
        while not self.sent and self.cycle < until:
            event = min(until, *(peripheral.next_event() for peripheral in self.timed))
            self.serve()
            if self.asleep:
                self.cycle = max(self.cycle + 1, event)
            else:
                limit = MASKED_SLICE if self.core.reg_read(UC_ARM_REG_PRIMASK) else SLICE
                count = max(1, min(limit, event - self.cycle))
                self.execute(count)
                self.cycle += count
            for peripheral in self.timed:
                peripheral.advance(self.cycle)

    def execute(self, count):
        try:
            self.core.emu_start(self.pc | 1, RETURN, count=count)
        except UcError as error:
            pc, link = (self.core.reg_read(register) for register in (UC_ARM_REG_PC, UC_ARM_REG_LR))
            raise RuntimeError(f"the program has stopped: {error} at {pc:#x}, from {link:#x}") from None
        self.pc = self.core.reg_read(UC_ARM_REG_PC) & ~1
        if self.waits_at is not None:
            self.pc, self.waits_at = self.waits_at + 2, None
            self.asleep, self.event = not self.event, False
        elif self.pc == RETURN:
            self.leave()
        elif bytes(self.core.mem_read(self.pc - 2, 2)) == WFI and count > 1:
            self.asleep = True

    def serve(self):
        """Begins the interrupt of the highest priority, if one may interrupt."""
        asked = self.system.software.union(*(peripheral.pending() for peripheral in self.timed))
        asked &= self.system.enabled
        if not asked:
            return
        priorities = self.system.priorities
        irq = min(asked, key=lambda irq: (priorities.get(irq, 0), irq))
        current = min((priorities.get(irq, 0) for irq, _, _ in self.active), default=256)
        if priorities.get(irq, 0) >= current:
            return
        self.asleep = False
        if not self.core.reg_read(UC_ARM_REG_PRIMASK):
            self.enter(irq)

    def enter(self, irq):
        core = self.core
        self.active.append((irq, core.context_save(), self.pc))
        self.system.software.discard(irq)
        kept = (UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3, UC_ARM_REG_R12, UC_ARM_REG_LR)
        words = [core.reg_read(register) for register in kept]
        stack = (core.reg_read(UC_ARM_REG_SP) - FRAME) & ~7
        core.mem_write(stack, struct.pack("<8I", *words, self.pc, core.reg_read(UC_ARM_REG_XPSR)))
        core.reg_write(UC_ARM_REG_SP, stack)
        core.reg_write(UC_ARM_REG_LR, RETURN | 1)
        (vector,) = struct.unpack("<I", core.mem_read(FLASH + 4 * (16 + irq), 4))
        self.pc = vector & ~1

    def leave(self):
        _, context, self.pc = self.active.pop()
        self.core.context_restore(context)
        self.event = True
