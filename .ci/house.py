#!/usr/bin/env python3
"""Three lists of what should not grow: public names without a user, public names in two crates, and
circles of files that need each other.

`.ci/house.py` fails where it finds what `.ci/house.accepted` has not; it also tells what is accepted and
gone, which `.ci/house.py tidy` takes out. `.ci/house.py accept` also writes what is new to it, which
then wants a reason; `.ci/house.py list` prints what it finds.

It reads the sources as text, in a second or two, and expands no macro. What is `pub` can be reached: the
workspace's lint `unreachable_pub` sees to that. A module may need those around it, as a part does.
"""

import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ACCEPTED = ROOT / '.ci/house.accepted'

# Where a public name of a crate has its users, beside the other crates and the crates' examples.
USERS = ('machines/', 'tools/', 'examples/', 'web/', 'firmware/')
NO_USERS = ('/tests/', '/benches/')

ITEM = re.compile(
    r'\bpub\s+(?:const\s+|async\s+|unsafe\s+)*(fn|struct|enum|trait|type|const|static)\s+(\w+)'
)
IMPL = re.compile(r'(?<![\w>&(])impl\b([^;{]*)\{')
WORD = re.compile(r'\b[A-Za-z_]\w*')


# -- Reading

NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/'
    r'|b?r(#*)".*?"\1|b?"(?:\\.|[^"\\])*"'
    r"|b?'(?:\\(?:u\{\w+\}|x\w\w|.)|[^\\'])'",
    re.DOTALL,
)


def code(text):
    """Without comments, and with empty strings and characters, in as many lines."""
    return NOT_CODE.sub(lambda it: ' ' if it[0].startswith('/') else '""', text)


def closing(text, start, pair='{}'):
    """The place behind the bracket that closes the one at `start`."""
    depth = 0
    for place in range(start, len(text)):
        if text[place] == pair[0]:
            depth += 1
        elif text[place] == pair[1]:
            depth -= 1
            if depth == 0:
                return place + 1
    return len(text)


FOR_TESTS = re.compile(
    r'#\[cfg\(test\)\]\s*(?:#\[[^\]]*\]\s*)*(?:pub(?:\([^)]*\))?\s+)?mod\s+(\w+)\s*([;{])'
)


def without_tests(text):
    """Without the modules for tests alone; and the names of those that are files."""
    files = []
    while found := FOR_TESTS.search(text):
        if found[2] == ';':
            files.append(found[1])
        end = found.end() if found[2] == ';' else closing(text, found.end() - 1)
        text = text[: found.start()] + text[end:]
    return text, files


def examples_of(markdown):
    """The Rust code of a README."""
    blocks = re.findall(r'^```(\w*)[^\n]*\n(.*?)^```', markdown, re.DOTALL | re.MULTILINE)
    return '\n'.join(body for language, body in blocks if language == 'rust')


def tracked():
    listed = subprocess.run(
        ['git', 'ls-files', '--cached', '--others', '--exclude-standard'],
        cwd=ROOT, capture_output=True, text=True, check=True,
    )
    return [path for path in listed.stdout.split('\n') if (ROOT / path).is_file()]


def is_below(path, stems):
    """Whether it is the file of one of the modules, or of a module in one."""
    whole = path.removesuffix('.rs')
    return any(whole == it or whole.startswith(f'{it}/') for it in stems)


class House:
    """The sources: of each crate, and of those who use it."""

    def __init__(self):
        # By package folder, by path: the code without tests.
        self.crates = defaultdict(dict)
        self.users = {}
        tests = set()
        for path in tracked():
            if path.endswith('README.md'):
                self.users[path] = code(examples_of((ROOT / path).read_text()))
            elif path.endswith('.rs') and not any(part in f'/{path}' for part in NO_USERS):
                text, files = without_tests(code((ROOT / path).read_text()))
                stem = Path(path).parent if Path(path).stem in ('lib', 'main') else Path(path).with_suffix('')
                tests |= {str(stem / file) for file in files}
                if room := re.match(r'((?:crates|machines|firmware)/[\w-]+|tools|web/wasm)/src/', path):
                    self.crates[room[1]][path] = text
                if path.startswith((*USERS, 'crates/')):
                    self.users[path] = text
        for sources in [*self.crates.values(), self.users]:
            for path in [it for it in sources if is_below(it, tests)]:
                del sources[path]

    def libraries(self):
        return sorted(room for room in self.crates if room.startswith('crates/'))


# -- Public names

def items(text):
    """The public items of a file: kind, name, the type that a method belongs to, words of the signature."""
    impls = []
    for found in IMPL.finditer(text):
        head = re.sub(r'\bwhere\b.*', '', found[1], flags=re.DOTALL)
        # The last name in front of its own parameters: `Type` in `<T> Trait<T> for Type<T>`.
        whose = re.sub(r'<[^<>]*>', '', re.sub(r'<[^<>]*>', '', re.sub(r'<[^<>]*>', '', head)))
        name = WORD.findall(whose.split(' for ')[-1])
        if name:
            impls.append((found.end() - 1, closing(text, found.end() - 1), name[-1], found[1]))
    for found in ITEM.finditer(text):
        inside = [it for it in impls if it[0] < found.start() < it[1]]
        end = re.compile(r'[;{]' if found[1] == 'fn' else r'[;{=]').search(text, found.end())
        end = end.start() if end else len(text)
        if found[1] in ('struct', 'enum', 'trait') and text[end : end + 1] == '{':
            end = closing(text, end)
        elif found[1] in ('type', 'const', 'static'):
            end = text.find(';', end)
        yield found[1], found[2], inside[-1][2] if inside else None, set(WORD.findall(text[found.end() : end]))
    for start, end, name, head in impls:
        # What a type is by its traits: `type Item = Step`.
        kinds = ' '.join(re.findall(r'\btype\s+\w+\s*=([^;]*);', text[start:end]))
        yield 'impl', name, None, set(WORD.findall(head + kinds))


def names_without_user(house):
    """`crate name` of what no machine, tool, board, page, README, example or other crate names.

    A type also counts as used where a used item has it in its signature: it is handed out or taken.
    """
    unused = []
    for room in house.libraries():
        own = f'{room}/src/'
        told = '\n'.join(text for path, text in house.users.items() if not path.startswith(own))
        free, called = set(WORD.findall(told)), set(re.findall(r'(?:\.|::)\s*(\w+)', told))
        public = [item for text in house.crates[room].values() for item in items(text)]
        types = {name for kind, name, whose, _ in public if kind in ('struct', 'enum', 'trait', 'type')}
        used, grown = types & free, True
        while grown:
            before = len(used)
            for kind, name, whose, words in public:
                if kind == 'fn' and (name in called if whose else name in free):
                    used |= words & types
                elif kind not in ('fn', 'const', 'static') and name in used:
                    used |= words & types
            grown = len(used) > before
        crate = room.removeprefix('crates/')
        for kind, name, whose, _ in public:
            if kind == 'impl' or (whose or 'Type')[0].islower():
                continue
            if kind in ('fn', 'const', 'static'):
                known = name in called if whose else name in free
            else:
                known = name in used
            if not known:
                unused.append(f'{crate} {whose}::{name}' if whose else f'{crate} {name}')
    return sorted(set(unused))


def names_in_two_crates(house):
    """`name crate crate...` of what is defined and public in more than one library."""
    where = defaultdict(set)
    for room in house.libraries():
        for text in house.crates[room].values():
            for kind, name, whose, _ in items(text):
                if kind != 'impl' and whose is None:
                    where[name].add(room.removeprefix('crates/'))
    return sorted(' '.join([name, *sorted(crates)]) for name, crates in where.items() if len(crates) > 1)


# -- Circles

class Modules:
    """The modules of a package, and in which file a path of names is defined."""

    def __init__(self, room, sources):
        self.text, self.file = {}, {}
        for path, text in sources.items():
            parts = path.removeprefix(f'{room}/src/').removesuffix('.rs').split('/')
            name = () if parts[-1] in ('lib', 'main') and len(parts) == 1 else tuple(parts)
            if name not in self.text or parts[-1] == 'lib':
                self.text[name], self.file[name] = text, path.removeprefix(f'{room}/src/')
        # Names that a module takes from another: they are defined there.
        self.taken = {module: dict(uses(text)) for module, text in self.text.items()}

    def absolute(self, module, path):
        """From the root, or `None` where it leads out of the package."""
        head, rest = path[0], path[1:]
        if head == 'crate':
            return rest
        if head == 'self':
            return module + rest
        if head == 'super':
            module = module[:-1]
            while rest and rest[0] == 'super':
                module, rest = module[:-1], rest[1:]
            return module + rest
        # A module of its own, of 2018 on.
        return module + path if module + path[:1] in self.text else None

    def home(self, path, depth=0):
        """The module whose file defines what the path names."""
        for length in range(len(path), -1, -1):
            module = path[:length]
            if module not in self.text:
                continue
            name = path[length : length + 1]
            taken = self.taken[module].get(name[0]) if name else None
            if taken and depth < 16:
                onward = self.absolute(module, taken)
                if onward is not None and onward != path:
                    return self.home(onward + path[length + 1 :], depth + 1)
            return module
        return None

    def needs(self, module):
        """The modules that this one's code names, but itself, those around it, and what it only passes on."""
        text = self.text[module]
        exported = {path for _, path in uses(text, only_public=True)}
        named = [path for _, path in uses(text) if path not in exported]
        body = re.sub(r'\b(?:pub(?:\([^)]*\))?\s+)?use\s[^;]*;', '', text)
        named += [tuple(re.split(r'\s*::\s*', it)) for it in re.findall(r'\b[a-z_]\w*(?:\s*::\s*\w+)+', body)]
        found = set()
        for path in named:
            whole = self.absolute(module, path)
            if whole is not None and (home := self.home(whole)) is not None:
                found.add(home)
        # A module within this one knows it, as a part does.
        return {it for it in found if it != module[: len(it)]}


def uses(text, only_public=False):
    """Name and path of each name that `use` takes."""
    public = r'pub(?:\([^)]*\))?\s+' if only_public else r'(?:pub(?:\([^)]*\))?\s+)?'
    for tree in re.findall(rf'\b{public}use\s+([^;]*);', text):
        yield from branches((), re.sub(r'\s+', ' ', tree).strip())


def branches(stem, tree):
    while found := re.match(r'(\w+)\s*::\s*', tree):
        stem, tree = (*stem, found[1]), tree[found.end() :]
    if tree.startswith('{'):
        depth, part = 0, ''
        for sign in tree[1:-1] + ',':
            depth += (sign == '{') - (sign == '}')
            if sign == ',' and depth == 0:
                if part.strip():
                    yield from branches(stem, part.strip())
                part = ''
            else:
                part += sign
        return
    name, _, other = tree.partition(' as ')
    path = stem if name == 'self' else (*stem, name)
    if path:
        yield (other or path[-1]).strip(), path


def circles(room, sources):
    """Groups of files of which each needs each other."""
    modules = Modules(room, sources)
    needs = {module: modules.needs(module) for module in modules.text}
    reach = {}
    for module in needs:
        seen, todo = set(), list(needs[module])
        while todo:
            if (next_one := todo.pop()) not in seen:
                seen.add(next_one)
                todo += needs[next_one]
        reach[module] = seen
    groups = {frozenset(it for it in reach[one] if one in reach[it]) | {one} for one in needs if one in reach[one]}
    return [sorted(modules.file[it] for it in group) for group in groups if len(group) > 1]


def import_circles(house):
    found = []
    for room, sources in house.crates.items():
        found += [' '.join([room, *files]) for files in circles(room, sources)]
    return sorted(found)


# -- What is accepted

HEADS = {
    'without a user': names_without_user,
    'in two crates': names_in_two_crates,
    'in a circle': import_circles,
}


def accepted():
    """The lists of `.ci/house.accepted`: by its heads `== HEAD`, a line each, `# REASON` behind or above."""
    lists, head = defaultdict(list), None
    for line in ACCEPTED.read_text().splitlines():
        if line.startswith('== '):
            head = line[3:]
        elif entry := line.partition('#')[0].strip():
            lists[head].append(entry)
    return lists


def is_new(head, entry, known):
    """Whether nothing accepted covers it: fewer crates or files do no harm, nor the crate it moves to."""
    first, *rest = entry.split()
    if head == 'in two crates':
        return not any(it.split()[0] == first and set(rest) <= set(it.split()[1:]) for it in known)
    return not any(set(rest) <= set(it.split()[1:]) for it in known)


def rewrite(house, takes_new):
    """Writes the accepted lists without what is gone, and with what is new where it is asked for."""
    sections = []
    for section in re.split(r'^(?=== )', ACCEPTED.read_text(), flags=re.MULTILINE):
        lines = section.rstrip().split('\n')
        if head := lines[0].removeprefix('== ') if lines[0].startswith('== ') else None:
            found = HEADS[head](house)
            serves = lambda entry: any(not is_new(head, it, [entry]) for it in found)
            kept = [it for it in lines[1:] if not (entry := it.partition('#')[0].strip()) or serves(entry)]
            new = [entry for entry in found if takes_new and is_new(head, entry, kept_entries(kept))]
            lines = [lines[0], *kept, *(['# New: each wants a reason, or goes.'] if new else []), *new]
        sections.append('\n'.join(lines) + '\n')
    ACCEPTED.write_text('\n'.join(sections))


def kept_entries(lines):
    return [entry for line in lines if (entry := line.partition('#')[0].strip())]


def main():
    house, known, grown = House(), accepted(), False
    if sys.argv[1:] in (['tidy'], ['accept']):
        return rewrite(house, takes_new=sys.argv[1] == 'accept')
    for head, find in HEADS.items():
        found = find(house)
        if sys.argv[1:] == ['list']:
            print(f'== {head}', *found, sep='\n')
            continue
        new = [entry for entry in found if is_new(head, entry, known[head])]
        for entry in new:
            print(f'{head}, and not in .ci/house.accepted: {entry}')
        gone = [entry for entry in known[head] if entry not in found]
        if gone:
            print(f'{head} no longer, and still in .ci/house.accepted: {", ".join(gone)}')
        grown |= bool(new)
        print(f'{head}: {len(found)}, accepted {len(known[head])}')
    sys.exit(1 if grown else 0)


if __name__ == '__main__':
    main()
