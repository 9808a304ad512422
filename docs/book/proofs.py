#!/usr/bin/env python3
"""The theorems of the book, from where their proofs are kept: the documentation of the functions that
rely on them.

    proofs.py FOLDER    writes FOLDER/CRATE-FUNCTION.md for each documentation with "Proof." in it
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LINK_WITH_TARGET = re.compile(r"\[(`[^`]+`)\]\((?!http)[^)]*\)")
LINK = re.compile(r"\[(`[^`]+`)\](?!\()")
# Which a link of the documentation is explained by.
REFERENCE = re.compile(r"^\[`[^`]+`\]: ")


def proofs():
    """Crate, function, file and documentation of each proof."""
    for path in sorted(ROOT.glob("crates/*/src/**/*.rs")):
        doc = []
        for line in path.read_text().splitlines():
            text = line.strip()
            if text.startswith("///"):
                doc.append(text[3:].removeprefix(" "))
            elif doc and not text.startswith("#["):
                if any(part.startswith("Proof.") for part in doc):
                    name = re.search(r"(?:fn|struct) (\w+)", text)
                    assert name, f"{path}: a proof of nothing with a name: {text}"
                    crate = path.relative_to(ROOT / "crates").parts[0]
                    yield crate, name[1], path.relative_to(ROOT), doc
                doc = []


def page(path, doc):
    """As a page has it: links to items of the crate become their names."""
    ends = [doc.index(section) for section in ("# Examples", "# Errors", "# Panics") if section in doc]
    doc = doc[: min(ends, default=None)]
    lines = [line for line in doc if not REFERENCE.match(line)]
    lines = [f"###{line}" if line.startswith("# ") else line for line in lines]
    text = LINK.sub(r"\1", LINK_WITH_TARGET.sub(r"\1", "\n".join(lines)))
    text = text.replace("Proof.", "*Proof.*", 1)
    return f"{text.strip()} ∎\n" if not text.rstrip().endswith("```") else f"{text.strip()}\n\n∎\n"


def main(folder):
    for crate, name, path, doc in proofs():
        (Path(folder) / f"{crate}-{name}.md").write_text(page(path, doc))


if __name__ == "__main__":
    main(*sys.argv[1:])
