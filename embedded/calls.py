"""The call graph of a linked program, from binutils: who calls whom, who calls through a pointer, and bytes of the stack.

The program is linked statically with --emit-relocs, its library compiled with -Z emit-stack-sizes.
"""
import bisect
import re
import subprocess

# A branch or call with a known target, and one through a register or memory. In Thumb `bx lr` returns, and jump
# tables use tbb and tbh; on x86-64 a jump through a register may be a table as well, so that only calls count.
DIRECT = re.compile(r"\t(?:call|jmp|j[a-z]+|bl?x?|b[a-z]{2}|cbn?z)(?:\.[nw])?[ \t]+(?:r\d+, )?([0-9a-f]+) <")
INDIRECT = re.compile(r"\t(?:call +\*|blx\s+r|bx\s+(?!lr)|ldr(?:\.w)?\s+pc, \[)")
# Types of relocations that branch or call.
BRANCH = re.compile(r"R_ARM_THM_(CALL|JUMP)|R_X86_64_PLT32|R_X86_64_GOTPCRELX")


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Program:
    """Functions by name; `calls` their direct calls, `takes` the functions whose address they take, `indirect` how often they
    call through a pointer, `stack` the bytes of the stack; `tables` the functions in tables of pointers, as those of traits."""

    def __init__(self, path, objdump="objdump"):
        self.names, self.starts, self.ends = {}, [], {}
        for line in run("readelf", "--syms", "--wide", path).splitlines():
            words = line.split()
            if len(words) >= 8 and words[3] == "FUNC" and words[6] != "UND":
                start, size = int(words[1], 16) & ~1, int(words[2], 0)
                if size or start not in self.names:
                    self.names[start] = words[7]
                    self.ends[start] = start + size
        self.starts = sorted(self.names)
        self.calls = {name: set() for name in self.names.values()}
        self.takes = {name: set() for name in self.names.values()}
        self.indirect = dict.fromkeys(self.names.values(), 0)
        self.sites = {name: [] for name in self.names.values()}
        self.tables = set()
        self._read_code(path, objdump)
        self._read_relocations(path)
        self.stack = self._read_stack(path)

    def at(self, address):
        """The name of the function at an address, or None."""
        index = bisect.bisect(self.starts, address) - 1
        if index < 0:
            return None
        start = self.starts[index]
        end = self.ends[start] if self.ends[start] > start else (self.starts[index + 1 : index + 2] or [start])[0]
        return self.names[start] if start <= address < end else None

    def _read_code(self, path, objdump):
        for line in run(objdump, "--disassemble", "--no-show-raw-insn", path).splitlines():
            if not (place := re.match(r" *([0-9a-f]+):", line)):
                continue
            here = self.at(int(place[1], 16))
            if here is None:
                continue
            if direct := DIRECT.search(line):
                there = self.at(int(direct[1], 16))
                # A call of itself counts, a branch within does not.
                is_start = there is not None and self.names.get(int(direct[1], 16)) == there
                if there is not None and (there != here or (is_start and re.search(r"\t(call|bl)\s", line))):
                    self.calls[here].add(there)
                    self.sites[here].append(there)
            elif INDIRECT.search(line):
                self.indirect[here] += 1

    def _read_relocations(self, path):
        section = ""
        for line in run("readelf", "--relocs", "--wide", path).splitlines():
            if head := re.match(r"Relocation section '\.rela?(\S+)'", line):
                section = head[1]
            words = line.split()
            if len(words) < 5 or not words[2].startswith("R_") or section.startswith((".debug", ".stack_sizes", ".eh_", ".ARM")):
                continue
            if not re.fullmatch(r"[0-9a-f]+", words[3]):
                continue
            value = int(words[3], 16) & ~1
            if len(words) >= 7 and words[5] in "+-":
                # x86-64 counts from the end of the instruction's field.
                value += int(words[5] + words[6], 16) + (4 if "PC" in words[2] else 0)
            if value not in self.names:
                continue
            here = self.at(int(words[0], 16))
            if here is None:
                self.tables.add(self.names[value])
            elif not BRANCH.match(words[2]) or self.names[value] not in self.calls[here]:
                self.takes[here].add(self.names[value])

    def _read_stack(self, path):
        sizes = {}
        for line in run("llvm-readelf", "--stack-sizes", path).splitlines():
            if found := re.match(r"\s+(\d+)\s+(\S.*)", line):
                sizes[found[2]] = int(found[1])
        return sizes

    def plain(self, names):
        """Names as they stand in the source, by mangled name."""
        names = list(names)
        found = subprocess.run(["c++filt"], input="\n".join(names), check=True, capture_output=True, text=True).stdout
        return {name: re.sub(r"\[[0-9a-f]{16}\]|::h[0-9a-f]{16}\b", "", text) for name, text in zip(names, found.splitlines())}
