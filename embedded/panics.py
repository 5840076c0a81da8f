#!/usr/bin/env python3
"""Compares the functions of the source that can still panic, in programs that use every function of the C interface, with the
list embedded/panics.txt.

panics.py [--write] PROGRAM [OBJDUMP ADDR2LINE] ...

A row of the list has the file, the function, the number of places in it that can panic, and the cause that keeps each of them
from it: embedded/panics.md. The program is built with line tables, so that a place counts where the source has it, whatever the
compiler inlined. --write keeps the causes of the functions that are known and gives the others none.
"""
import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
LIST = ROOT / "embedded/panics.txt"
# Functions of Rust's core library that panic, as mangled.
PANIC = re.compile(
    r"<([^<>+]*(?:9panicking|slice_index_fail|slice_error_fail|expect_failed|unwrap_failed|len_mismatch_fail)[^<>+]*)>"
)
BRANCH = re.compile(r"^ *([0-9a-f]+):\t(?:call|jmp|j[a-z]+|bl?|b[a-z]{2}|cbn?z)(?:\.[nw])?[ \t]")
HEAD = re.compile(r"^[0-9a-f]+ <(.*)>:$")
FUNCTION = re.compile(r"^\s*(?:pub(?:\([a-z]+\))? )?(?:const )?(?:unsafe )?(?:extern \"C\" )?fn (\w+)")


def run(command, text=None):
    return subprocess.run(command, input=text, check=True, capture_output=True, text=True).stdout


def places(program, objdump, addr2line):
    """The file, the line or 0, and the function of each call of a function that panics."""
    addresses, function = [], ""
    for line in run([objdump, "--disassemble", "--no-show-raw-insn", program]).splitlines():
        if head := HEAD.match(line):
            function = head[1]
        elif (call := BRANCH.match(line)) and PANIC.search(line) and not PANIC.search(f"<{function}>"):
            addresses.append(call[1])
    found = run([addr2line, "--exe", program, "--functions", "--inlines", "--demangle", "--addresses"], "\n".join(addresses))
    for chain in re.split(r"^0x[0-9a-f]+\n", found, flags=re.M)[1:]:
        lines = chain.splitlines()
        frames = list(zip(lines[::2], lines[1::2]))
        ours = [frame for frame in frames if re.search(r"^(?!.*/library/).*/(core|ffi)/src/", frame[1])]
        name, place = (ours or frames)[0]
        path, line = re.sub(r" \(discriminator.*", "", place).rsplit(":", 1)
        path = re.sub(r"^.*?/((?:core|ffi|library)/|(?:[\w-]+-[\d.]+/src/))", r"\1", path)
        yield path, int(line) if line.isdigit() else 0, name


def function_of(path, line, name):
    """The function around a line of the source, or that of the line tables without generics."""
    source = ROOT / path
    if line and source.exists():
        above = source.read_text().splitlines()[:line]
        for text in reversed(above):
            if found := FUNCTION.match(text):
                return found[1]
    plain = name
    while "<" in plain and (shorter := re.sub(r"<[^<>]*>", "", plain)) != plain:
        plain = shorter
    words = [word for word in re.findall(r"\w+", plain.replace("closure_env", "closure")) if not re.fullmatch(r"closure|\d+", word)]
    return words[-1] if words else "?"


def read():
    rows = {}
    for line in LIST.read_text().splitlines():
        if line and not line.startswith("#"):
            path, function, count, cause = line.split()
            rows[path, function] = int(count), cause
    return rows


def main():
    arguments = sys.argv[1:]
    is_written = arguments[:1] == ["--write"]
    arguments = arguments[is_written:]
    lines = collections.defaultdict(set)
    for program, objdump, addr2line in zip(*[iter(arguments)] * 3):
        for path, line, name in places(program, objdump, addr2line):
            lines[path, function_of(path, line, name)].add(line)
    # Line 0 is that of code which the compiler has merged; it stands for one place if there is no other.
    found = {key: len(numbers - {0}) or 1 for key, numbers in lines.items()}
    causes = set(re.findall(r"^## (\w+)", (ROOT / "embedded/panics.md").read_text(), re.M))
    listed = read() if LIST.exists() else {}
    if is_written:
        cause = lambda path, name: listed[path, name][1] if (path, name) in listed else "-"
        head = "# File, function, places that can panic, and why they do not: panics.md. Written by no_panic.sh --write.\n"
        rows = [f"{path} {name} {count} {cause(path, name)}\n" for (path, name), count in sorted(found.items())]
        LIST.write_text(head + "".join(rows))
        return
    wrong = [f"{path}: {name} can panic in {found[path, name]} places and is not listed" for path, name in found.keys() - listed.keys()]
    wrong += [f"{path}: {name} is listed and cannot panic any more" for path, name in listed.keys() - found.keys()]
    for (path, name), (count, cause) in listed.items():
        if cause not in causes:
            wrong.append(f"{path}: {name}: the cause {cause} is not in embedded/panics.md")
        if (now := found.get((path, name), 0)) > count:
            wrong.append(f"{path}: {name} can panic in {now} places; {count} are listed")
    if wrong or not found:
        print(*sorted(wrong or ["nothing was found"]), sep="\n", file=sys.stderr)
        sys.exit("no_panic: the list does not fit the programs: rewrite the code, or run embedded/no_panic.sh --write and give the cause")
    by_cause = collections.Counter()
    for key, count in found.items():
        by_cause[listed[key][1]] += count
    print(f"no_panic: {sum(found.values())} places in {len(found)} functions, all listed:", dict(by_cause.most_common()))


if __name__ == "__main__":
    main()
