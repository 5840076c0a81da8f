#!/usr/bin/env python3
"""Compares the places of the source that can still panic, in programs that use every function of the C interface, with the list
embedded/panics.txt.

panics.py [--write] PROGRAM...

A row of the list has the file, the function, the number of places in it that can panic, and the causes that keep each of them
from it: embedded/panics.md. A panic is given its place in the source. The place stays in the program because the panic handler keeps
it, and a place at which nothing can panic is not linked. So the list has all places, whatever the compiler inlined or merged.
--write keeps the causes of the functions that are known and gives the others none.
"""
import collections
import pathlib
import re
import struct
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
LIST = ROOT / "embedded/panics.txt"
# Functions of Rust's core library that panic without a place.
PLACELESS = re.compile(r"9panicking\d+(?:panic_nounwind|panic_cannot_unwind|panic_in_cleanup)")
FUNCTION = re.compile(r"^\s*(?:pub(?:\([a-z ]+\))? )?(?:const )?(?:unsafe )?(?:extern \"C\" )?fn (\w+)")
# The function of a place outside of this repository: its source may not be here.
ELSEWHERE = "-"


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def places(program):
    """The file, the line and the column of each place: a `core::panic::Location`, which is a pointer to the name of a file, its
    length, the line and the column."""
    data = pathlib.Path(program).read_bytes()
    sections = []
    for line in run("readelf", "--sections", "--wide", program).splitlines():
        if found := re.match(r"\s*\[\s*\d+\]\s+\S+\s+PROGBITS\s+(\w+)\s+(\w+)\s+(\w+)\s+\w+\s+\w*A", line):
            start, offset, size = (int(number, 16) for number in found.groups())
            sections.append((start, data[offset : offset + size]))
    # The fifth byte of an ELF file tells 32 from 64 bits.
    layout, word = ("<QQII", 8) if data[4] == 2 else ("<IIII", 4)
    size = struct.calcsize(layout)

    def name(address, length):
        for start, content in sections:
            if start <= address and address + length <= start + len(content):
                return content[address - start : address - start + length]
        return b""

    for start, content in sections:
        for at in range(-start % word, len(content) - size + 1, word):
            address, length, line, column = struct.unpack_from(layout, content, at)
            if length < 500 and line and column and (path := name(address, length)).endswith(b".rs") and path.isascii():
                # A file of this repository, of Rust's library, or of a crate.
                yield re.sub(r"^.*?/(library/|[\w-]+-[\d.]+/src/)", r"\1", path.decode()), line, column


def function_of(path, line):
    """The function around a line of the source."""
    source = ROOT / path
    if source.exists():
        for text in reversed(source.read_text().splitlines()[:line]):
            if found := FUNCTION.match(text):
                return found[1]
    return ELSEWHERE


def read():
    rows = {}
    for line in LIST.read_text().splitlines():
        if line and not line.startswith("#"):
            path, function, count, causes = line.split()
            rows[path, function] = int(count), causes
    return rows


def main():
    is_written = sys.argv[1:2] == ["--write"]
    by_function = collections.defaultdict(set)
    for program in sys.argv[1 + is_written :]:
        if placeless := PLACELESS.search(run("readelf", "--syms", "--wide", program)):
            sys.exit(f"no_panic: {program}: {placeless[0]} panics without a place")
        if not (of_program := set(places(program))):
            sys.exit(f"no_panic: {program}: no place was found")
        for path, line, column in of_program:
            by_function[path, function_of(path, line)].add((line, column))
    found = {key: len(of) for key, of in by_function.items()}
    listed = read() if LIST.exists() else {}
    if is_written:
        cause = lambda key: listed[key][1] if key in listed else "-"
        head = "# File, function, places that can panic, and why they do not: panics.md. Written by no_panic.sh --write.\n"
        rows = [f"{path} {name} {count} {cause((path, name))}\n" for (path, name), count in sorted(found.items())]
        LIST.write_text(head + "".join(rows))
        return
    causes = set(re.findall(r"^### (\w+)", (ROOT / "embedded/panics.md").read_text(), re.M))
    wrong = [f"{path}: {name} can panic in {found[path, name]} places and is not listed" for path, name in found.keys() - listed.keys()]
    wrong += [f"{path}: {name} is listed and cannot panic any more" for path, name in listed.keys() - found.keys()]
    for (path, name), (count, of) in listed.items():
        wrong += [f"{path}: {name}: the cause {cause} is not in embedded/panics.md" for cause in of.split(",") if cause not in causes]
        if (now := found.get((path, name), 0)) > count:
            wrong.append(f"{path}: {name} can panic in {now} places; {count} are listed")
    used = {cause for _, of in listed.values() for cause in of.split(",")}
    wrong += [f"embedded/panics.md: nothing has the cause {cause}" for cause in causes - used]
    if wrong:
        print(*sorted(wrong), sep="\n", file=sys.stderr)
        sys.exit("no_panic: the list does not fit the programs: rewrite the code, or run embedded/no_panic.sh --write and give the cause")
    by_cause = collections.Counter()
    for key, count in found.items():
        by_cause.update(dict.fromkeys(listed[key][1].split(","), count))
    print(f"no_panic: {sum(found.values())} places in {len(found)} functions, all listed; by causes, of which one place may have several:")
    print(*(f"{cause} {count}" for cause, count in by_cause.most_common()), sep=", ")


if __name__ == "__main__":
    main()
