#!/usr/bin/env python3
"""Compares what was counted with what is committed, and writes docs/book/src/metal.md.

    table.py check m4 m3 m0 boards    no count, stack or size is more than 5 % above the committed
                                      one, and docs/book/src/metal.md says what is committed
    table.py accept m4 m3 m0 boards   what was counted is what will be committed
"""

import sys
from pathlib import Path

HERE = Path(__file__).parent
COUNTED, COMMITTED = HERE / "target", HERE / "measured"
PAGE = HERE.parent.parent / "docs" / "book" / "src" / "metal.md"
# The tables that are kept; lines are played on an M3 and an M0+ as well.
KEPT = {
    "m4": ("count", "play", "sizes"),
    "m3": ("count",),
    "m0": ("count", "sizes"),
    "boards": ("sizes",),
}
# Counts are of one compiler; another one may place a few instructions otherwise.
MOST = 1.05
# Below, one instruction is more than 5 %.
SLACK = 3

# On an M4F the goal, and what it was with libm's sines; on an M0+ what it was. There the goal is half.
GOALS = {
    ("arm: forward", "f32"): (160, 4470, 13954),
    ("arm: inverse, both elbows", "f32"): (330, 501, 11692),
    ("arm: joint_rates", "f32"): (350, 5749, 19079),
    ("arm: waypoint of follow", "f32"): ("", 48958, 176473),
    ("Delta: inverse", "f32"): (420, 599, 16688),
    ("Delta: forward", "f32"): (700, 7065, 32845),
    ("body: pose vector to nine axes", "f32"): (500, 6278, 25661),
    ("body: isometry to nine axes", "f32"): ("", 158, 10043),
    ("arm: forward", "f64"): ("", 10543, 28013),
    ("arm: inverse, both elbows", "f64"): ("", 14096, 38267),
    ("arm: joint_rates", "f64"): ("", 14227, 39235),
    ("arm: waypoint of follow", "f64"): ("", 156423, 301976),
    ("Delta: inverse", "f64"): ("", 17922, 51688),
    ("Delta: forward", "f64"): ("", 26296, 73946),
    ("body: pose vector to nine axes", "f64"): ("", 18704, 49405),
    ("body: isometry to nine axes", "f64"): ("", 9239, 23340),
}


def read(path):
    """Rows of a file: name and kind, and the numbers."""
    rows = {}
    for line in path.read_text().split("\n"):
        if line:
            name, kind, *numbers = line.split(";")
            rows[name, kind] = [int(number) for number in numbers]
    return rows


def compare(core, kind):
    """What is worse than committed, in words."""
    counted, committed = (read(folder / f"{core}-{kind}") for folder in (COUNTED, COMMITTED))
    for key in counted.keys() ^ committed.keys():
        yield f"{core}: {', '.join(key)}: counted or committed, not both"
    for key in counted.keys() & committed.keys():
        for now, before in zip(counted[key], committed[key], strict=True):
            if now > max(before * MOST, before + SLACK):
                yield f"{core}: {', '.join(key)}: {now}, committed {before}"


def number(value):
    return f"{value:,}" if isinstance(value, int) else value


def table(head, rows):
    """Markdown; all columns but the first are numbers."""
    lines = [head, ["---"] + ["---:"] * (len(head) - 1), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def counts():
    by_core = {core: read(COMMITTED / f"{core}-count") for core in ("m4", "m3", "m0")}
    calls = [key for key in by_core["m4"] if key[1] != "bytes"]
    rows = []
    for name, kind in calls:
        _, mean, most, stack = by_core["m4"][name, kind]
        # What was counted on the M4F alone stays blank.
        none = ["", "", "", ""]
        means = [by_core[core].get((name, kind), none)[1] for core in ("m3", "m0")]
        goal, before, before_m0 = GOALS.get((name, kind), ("", "", ""))
        title = f"{name}, `{kind}`" if kind.startswith("f") else name
        rows.append([title, *map(number, [mean, goal, before, most, stack, *means, before_m0])])
    head = ["", "M4F", "goal", "before", "M4F, most", "M4F, stack", "M3", "M0+", "before"]
    kept = [
        [f"`{name}`", number(numbers[0])]
        for (name, kind), numbers in by_core["m4"].items()
        if kind == "bytes"
    ]
    return table(head, rows), table(["", "bytes"], kept)


def sizes():
    by_core = {core: read(COMMITTED / f"{core}-sizes") for core in ("m4", "m0")}
    (nothing,) = {flash for (name, _), (flash, _) in by_core["m4"].items() if name == "nothing"}
    rows = []
    for source in sorted((HERE / "src/bin").glob("size_*.rs")):
        name = source.stem.removeprefix("size_")
        what = source.read_text().split("\n")[0].removeprefix("//! ").rstrip(".")
        flash = [
            number(by_core[core][name, profile][0])
            for core in by_core
            for profile in ("release", "small")
        ]
        rows.append([what, *flash])
    return nothing, table(["", "M4F, 3", "M4F, s", "M0+, 3", "M0+, s"], rows)


def millions(instructions):
    return f"{instructions / 1e6:.1f}"


def lines():
    played = read(COMMITTED / "m4-play")
    title = {"pc": "planned on a PC", "board": "planned on the M4F itself"}
    rows = [
        [title[who], *map(number, [steps, length, least, middle, most, most - least])]
        for (who, kind), (steps, length, least, middle, most) in (
            (key, numbers) for key, numbers in played.items() if key[1] == "line"
        )
    ]
    head = ["", "steps", "bytes", "latency, least", "median", "most", "jitter"]
    return table(head, rows), millions(played["planning", "board"][0])


def line_tables():
    """Path and table of the line, in `f32` and in `f64`."""
    counted = read(COMMITTED / "m4-count")
    path, in_f32, in_f64 = (
        counted[name, "f64"][1]
        for name in (
            "Arm::path, 244 mm",
            "Table::plan_in_f32, the line, 100 rows",
            "Table::plan, the line, 100 rows",
        )
    )
    return millions(path + in_f32), millions(in_f64)


def boards():
    title = {"rp2040": "Raspberry Pi Pico, RP2040", "stm32": "Nucleo-F411RE, STM32F411"}
    rows = [
        [f"{title[board]}, {machine}", *map(number, sizes)]
        for (board, machine), sizes in read(COMMITTED / "boards-sizes").items()
    ]
    return table(["", "flash", "static memory"], rows)


def page():
    calls, kept = counts()
    nothing, flash = sizes()
    played, planning = lines()
    in_f32, in_f64 = line_tables()
    text = (HERE / "metal.md.in").read_text()
    for mark, value in {
        "COUNTS": calls,
        "KEPT": kept,
        "LINES": played,
        "PLANNING": planning,
        "PLANNING_F32": in_f32,
        "PLANNING_F64": in_f64,
        "FLASH": flash,
        "NOTHING": number(nothing),
        "BOARDS": boards(),
        "MOST": f"{MOST - 1:.0%}".replace("%", " %"),
    }.items():
        assert f"@{mark}@" in text, mark
        text = text.replace(f"@{mark}@", value)
    return text


def main(verb, *cores):
    found = [
        (core, kind) for core in cores for kind in KEPT[core] if (COUNTED / f"{core}-{kind}").exists()
    ]
    if verb == "accept":
        COMMITTED.mkdir(exist_ok=True)
        for core, kind in found:
            (COMMITTED / f"{core}-{kind}").write_text((COUNTED / f"{core}-{kind}").read_text())
        PAGE.write_text(page())
        return 0
    assert verb == "check" and found, __doc__
    worse = [line for core, kind in found for line in compare(core, kind)]
    if PAGE.read_text() != page():
        worse.append("docs/book/src/metal.md is not what table.py writes: table.py accept")
    print("\n".join(worse) if worse else f"ok: {len(found)} tables, nothing above {MOST:.0%}")
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
