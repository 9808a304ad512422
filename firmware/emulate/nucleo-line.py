"""A Nucleo-F411RE that runs a machine's firmware, on standard input and output, as README.md says:
`nucleo-line.py PROGRAM BOUNCE A B..`.
"""

import struct
import sys

from stm32f411 import CYCLES_PER_SECOND, Chip, Usart

# STEP and DIR of each axis, all of port A; home switches of port C, closed to ground.
DRIVER_PINS = (0, 1, 4, 10, 8, 9)
SWITCH_PINS = (1, 0, 7)
# Counts of the scales of the first two axes, of which the second stays at 0 where there is one axis.
COUNTS_PER_STEP = 5
# Changes of a contact while it bounces.
BOUNCES = 6
ERRORS = {"parity": Usart.PARITY, "framing": Usart.FRAMING, "overrun": Usart.OVERRUN, "break": Usart.FRAMING}


def loaded_segments(path):
    """What a program of 32-bit ELF puts where: load addresses and bytes."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:5] != b"\x7fELF\x01":
        raise SystemExit(f"{path}: not a program of 32-bit ELF")
    (first,), (size, count) = struct.unpack_from("<I", data, 28), struct.unpack_from("<HH", data, 42)
    headers = (struct.unpack_from("<5I", data, first + size * index) for index in range(count))
    return [(to, data[at : at + length]) for kind, at, _, to, length in headers if kind == 1 and length]


class Nucleo:
    def __init__(self, program, from_switches, bounce):
        self.segments = loaded_segments(program)
        self.from_switches, self.bounce = list(from_switches), bounce
        self.axes = range(len(self.from_switches))
        self.changed = [-1 << 62 for _ in self.axes]
        # On the negative side at first: the switch is closed on the other.
        self.above = [steps < 0 for steps in self.from_switches]
        self.levels = 0
        # Steps of each motor that move nothing, from the next one on.
        self.losing = [0 for _ in self.axes]
        self.edges = []
        self.start(0)

    def start(self, cycle):
        self.chip = Chip(self.segments, self.inputs, self.outputs, (self.scale(0), self.scale(1)), cycle)
        self.outputs("A", 0, cycle)

    def inputs(self, port):
        if port != "C":
            return 0
        return sum(1 << SWITCH_PINS[axis] for axis in self.axes if not self.is_closed(axis))

    def scale(self, axis):
        return lambda: sum(self.from_switches[axis : axis + 1]) * COUNTS_PER_STEP

    def is_reached(self, axis):
        steps = self.from_switches[axis]
        return steps >= 0 if self.above[axis] else steps <= 0

    def is_closed(self, axis):
        since = self.chip.cycle - self.changed[axis]
        bounces = since * BOUNCES // self.bounce if since < self.bounce else 0
        return self.is_reached(axis) != (bounces % 2 == 1)

    def outputs(self, port, driven, cycle):
        levels = sum(1 << bit for bit, pin in enumerate(DRIVER_PINS[: 2 * len(self.axes)]) if driven >> pin & 1)
        if port != "A" or levels == self.levels:
            return
        self.edges.append((cycle, levels))
        risen, self.levels = levels & ~self.levels, levels
        for axis in self.axes:
            if risen >> 2 * axis & 1:
                self.step(axis, 1 if levels >> (2 * axis + 1) & 1 else -1, cycle)

    def step(self, axis, sign, cycle):
        if self.losing[axis]:
            self.losing[axis] -= 1
            return
        was_reached = self.is_reached(axis)
        self.from_switches[axis] += sign
        if self.is_reached(axis) != was_reached:
            self.changed[axis] = cycle

    def receive(self, end, byte, error=None):
        self.chip.usart.coming.append((int(end), int(byte), ERRORS.get(error, 0)))

    def power(self):
        self.start(self.chip.cycle)

    def run(self, until):
        self.chip.run(int(until))
        lines = [f"edge {cycle} {levels}\n" for cycle, levels in self.edges]
        lines += [f"sent {cycle} {byte}\n" for cycle, byte in self.chip.sent]
        self.edges.clear()
        self.chip.sent.clear()
        sys.stdout.write("".join(lines))
        print("at", self.chip.cycle, *self.from_switches, flush=True)

    def lose(self, axis, steps):
        self.losing[int(axis)] = int(steps)

    def set_bounce(self, cycles):
        self.bounce = int(cycles)


def main():
    program, *numbers = sys.argv[1:]
    bounce, *from_switches = map(int, numbers)
    nucleo = Nucleo(program, from_switches, bounce)
    commands = {
        "receive": nucleo.receive,
        "bounce": nucleo.set_bounce,
        "lose": nucleo.lose,
        "power": nucleo.power,
        "run": nucleo.run,
    }
    print("hz", CYCLES_PER_SECOND, flush=True)
    for line in sys.stdin:
        name, *words = line.split()
        commands[name](*words)


main()
