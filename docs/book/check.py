#!/usr/bin/env python3
"""Checks the built book and all pages of the repository.

    check.py BOOK    BOOK is the folder with the built pages

Each link leads somewhere: between pages of the book with their anchors, from any *.md to a file of the
repository, and from anywhere to the book's address or the repository's. Each include was found, each
proof is a theorem, and each Rust program is compiled: by the facade's tests, or because it is included.
Addresses of others are not asked for.
"""

import re
import subprocess
import sys
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag

ROOT = Path(__file__).resolve().parents[2]
CHAPTERS = ROOT / "docs" / "book" / "src"
REPOSITORY = re.compile(r"https://github\.com/pose2pulse/pose2pulse/(?:blob|tree|edit)/main/(.*)")
DOCUMENTATION = re.compile(r"https://docs\.rs/([\w-]+)/?")
PUBLISHED = "https://pose2pulse.github.io/pose2pulse/book/"
FENCE = re.compile(r"^\s*```(.*)$")
MARKDOWN_LINK = re.compile(r"\]\(([^()\s]+)(?:\s\"[^\"]*\")?\)|^\[[^\]]+\]:\s+(\S+)")


class Page(HTMLParser):
    """Anchors and links of a page."""

    def __init__(self):
        super().__init__()
        self.anchors, self.links = set(), []

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if "id" in attrs:
            self.anchors.add(attrs["id"])
        for name in ("href", "src"):
            if attrs.get(name):
                self.links.append(attrs[name])


@cache
def page(path):
    parser = Page()
    parser.feed(path.read_text())
    return parser


def text_and_code(path):
    """Lines outside of code, and blocks of code with their language."""
    text, blocks, block = [], [], None
    for number, line in enumerate(path.read_text().splitlines(), 1):
        fence = FENCE.match(line)
        if fence and block is None:
            block = (number, fence[1].strip(), [])
        elif fence:
            blocks.append(block)
            block = None
        elif block is None:
            text.append((number, line))
        else:
            block[2].append(line)
    return text, blocks


@cache
def slugs(path):
    """Anchors of headings, as GitHub and docs.rs make them."""
    text, _ = text_and_code(path)
    names = [line.lstrip("#").strip() for _, line in text if line.startswith("#")]
    return {re.sub(r"[^\w\- ]", "", re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", name)).lower().replace(" ", "-") for name in names}


def leads(link, book, folder):
    """Why a link leads nowhere, or None."""
    target, anchor = urldefrag(link)
    if target.startswith(PUBLISHED):
        return in_book(book / target.removeprefix(PUBLISHED), anchor)
    documented = DOCUMENTATION.fullmatch(target)
    if documented and (ROOT / "crates" / documented[1]).exists():
        # A crate's page begins with its README.
        target = f"{ROOT}/crates/{documented[1]}/README.md"
        return None if not anchor or anchor in slugs(Path(target)) else "its README has no such heading"
    ours = REPOSITORY.fullmatch(target)
    if ours:
        path = ROOT / ours[1]
    elif re.match(r"[a-z]+:", target):
        return None
    elif not target:
        return None
    else:
        path = folder / unquote(target)
    if not path.exists():
        return "there is no such file"
    if anchor and path.suffix == ".md" and unquote(anchor) not in slugs(path):
        return "there is no such heading"
    return None


def in_book(path, anchor):
    path = path / "index.html" if path.is_dir() else path
    if not path.exists():
        return "there is no such page"
    if anchor and path.suffix == ".html" and unquote(anchor) not in page(path).anchors:
        return "there is no such anchor"
    return None


def built(book):
    """What is wrong in the pages of the book."""
    for path in sorted(book.rglob("*.html")):
        if path.name in ("print.html", "toc.html", "404.html"):
            continue
        if "{{#" in re.sub(r"<code.*?</code>", "", path.read_text(), flags=re.S) or "{{#include" in path.read_text():
            yield f"{path.name}: an include was not found"
        for link in page(path).links:
            if re.match(r"[a-z]+:", link):
                wrong = leads(link, book, path.parent)
            else:
                target, anchor = urldefrag(link)
                wrong = in_book(path.parent / unquote(target) if target else path, anchor)
            if wrong:
                yield f"{path.name}: {link}: {wrong}"


def tracked():
    names = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / name for name in names.stdout.split() if (ROOT / name).exists()]


def pages(book):
    """What is wrong in the repository's pages, those of the book but for links among them."""
    for path in tracked():
        text, _ = text_and_code(path)
        for number, line in text:
            for match in MARKDOWN_LINK.finditer(re.sub(r"`[^`]*`", "", line)):
                link = match[1] or match[2]
                is_chapter = CHAPTERS in path.parents and not re.match(r"[a-z]+:", link)
                wrong = None if is_chapter else leads(link, book, path.parent)
                if wrong:
                    yield f"{path.relative_to(ROOT)}:{number}: {link}: {wrong}"


def programs():
    """What no compiler has seen."""
    facade = (ROOT / "src" / "lib.rs").read_text()
    for path in sorted(CHAPTERS.glob("*.md")):
        for number, language, lines in text_and_code(path)[1]:
            at = f"{path.relative_to(ROOT)}:{number}"
            if not language:
                yield f"{at}: a block of code without its language"
            elif language == "rust" and f"docs/book/src/{path.name}" not in facade:
                yield f"{at}: src/lib.rs does not have this page tested"
            elif language.startswith("rust,") and not all("{{#include" in line for line in lines):
                yield f"{at}: neither tested nor included"


def proofs():
    text = (CHAPTERS / "theorems.md").read_text()
    for path in sorted((CHAPTERS / "made").glob("*-*.md")):
        if f"made/{path.name}" not in text:
            yield f"theorems.md has no {path.name}"


def main(book):
    book = Path(book).resolve()
    wrong = [*built(book), *pages(book), *programs(), *proofs()]
    print("\n".join(wrong) if wrong else f"ok: {len(list(book.glob('*.html')))} pages, {len(tracked())} sources")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
