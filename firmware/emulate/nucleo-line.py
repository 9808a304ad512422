"""A Nucleo-F411RE that runs the arm's firmware, on standard input and output, as README.md says:
`nucleo-line.py PROGRAM A B BOUNCE`.
"""

import struct
import sys

from stm32f411 import CYCLES_PER_SECOND, Chip, Usart

# STEP and DIR of the shoulder, then of the elbow; home switches, closed to ground.
DRIVER_PINS = (0, 1, 4, 10)
SWITCH_PINS = (1, 0)
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
        self.changed = [-1 << 62] * 2
        self.levels = 0
        self.edges = []
        self.start(0)

    def start(self, cycle):
        self.chip = Chip(self.segments, self.inputs, self.outputs, cycle)
        self.outputs("A", 0, cycle)

    def inputs(self, port):
        if port != "C":
            return 0
        return sum(1 << pin for joint, pin in enumerate(SWITCH_PINS) if not self.is_closed(joint))

    def is_closed(self, joint):
        since = self.chip.cycle - self.changed[joint]
        bounces = since * BOUNCES // self.bounce if since < self.bounce else 0
        return (self.from_switches[joint] <= 0) != (bounces % 2 == 1)

    def outputs(self, port, driven, cycle):
        levels = sum(1 << bit for bit, pin in enumerate(DRIVER_PINS) if driven >> pin & 1)
        if port != "A" or levels == self.levels:
            return
        self.edges.append((cycle, levels))
        risen, self.levels = levels & ~self.levels, levels
        for joint in (0, 1):
            if risen >> 2 * joint & 1:
                was_closed = self.from_switches[joint] <= 0
                self.from_switches[joint] += 1 if levels >> (2 * joint + 1) & 1 else -1
                if (self.from_switches[joint] <= 0) != was_closed:
                    self.changed[joint] = cycle

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

    def set_bounce(self, cycles):
        self.bounce = int(cycles)


def main():
    program, *numbers = sys.argv[1:]
    shoulder, elbow, bounce = map(int, numbers)
    nucleo = Nucleo(program, (shoulder, elbow), bounce)
    commands = {"receive": nucleo.receive, "bounce": nucleo.set_bounce, "power": nucleo.power, "run": nucleo.run}
    print("hz", CYCLES_PER_SECOND, flush=True)
    for line in sys.stdin:
        name, *words = line.split()
        commands[name](*words)


main()
