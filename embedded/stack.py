#!/usr/bin/env python3
"""Tests that nothing recurses but what is known to end, and that no function of the C interface takes more of the stack than
the library promises.

stack.py MOST PROGRAM OBJDUMP PUSHED

PUSHED are the bytes that a call itself takes, beside the frame: the return address on x86-64. The bytes of a function are those of the
deepest chain of calls below it. A call through a pointer may go to every function
whose address its own function takes; from core::fmt to every function of core::fmt and every Display or Debug; and from
elsewhere to every function of a table of a trait. The core has no other function pointers.
"""
import re
import sys

import calls

# What recurses, how often one may stand in the stack, and why it ends.
KNOWN = [
    (r"core::slice::sort::unstable::quicksort::quicksort::<", 48,
     "core's sort halves a range at most 2 log2(n) times, then changes to heapsort; n is less than 2^24"),
    (r"core::slice::sort::shared::pivot::median3_rec::<", 8, "core's sort looks at an eighth of a range each time: log8(n)"),
    (r"core::slice::sort::select::median_of_medians::<", 8, "core's selection goes on in at most a twelfth of a range: log12(n)"),
    (r"Threads>::join", 1, "a part of a call that runs on a second thread has no parts of its own"),
    (r"core::str::slice_error_fail", 1, "core's panic; the two differ in const only"),
    (r"core::fmt|<dyn core::fmt", 2,
     "a message prints an error, which prints numbers: no type prints itself, so that each function stands there once, and"
     " core::fmt::write once for each of up to four types"),
]
# Bytes for a function of another compiler, which does not report them: memcpy, and the arithmetic that the processor
# lacks.
UNKNOWN = 128
# Calls of the caller's function, whose stack is the caller's.
CALLERS = re.compile(r"hangpose_plan_path::\{closure#0\}::\{closure#0\}")


def components(graph):
    """Groups of functions that call each other, callees first: Tarjan's algorithm, without recursion."""
    index, low, on, stack, found = {}, {}, set(), [], []
    for root in graph:
        if root in index:
            continue
        work = [(root, iter(graph[root]))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on.add(root)
        while work:
            node, edges = work[-1]
            for other in edges:
                if other not in index:
                    index[other] = low[other] = len(index)
                    stack.append(other)
                    on.add(other)
                    work.append((other, iter(graph[other])))
                    break
                if other in on:
                    low[node] = min(low[node], index[other])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == index[node]:
                    group = stack[stack.index(node):]
                    del stack[stack.index(node):]
                    on.difference_update(group)
                    found.append(group)
    return found


def main():
    most, path, objdump, pushed = int(sys.argv[1]), *sys.argv[2:4], int(sys.argv[4])
    program = calls.Program(path, objdump)
    plain = program.plain(program.calls)
    is_format = lambda name: "core::fmt" in plain[name]
    of_rust = {name for name in program.tables.union(*program.takes.values()) if name.startswith(("_R", "_ZN"))}
    formats = set(filter(is_format, of_rust))
    traits = {name for name in program.tables & of_rust if not is_format(name)}
    graph, waiting = {}, [name for name in program.calls if name.startswith("hangpose_")]
    while waiting:
        name = waiting.pop()
        if name in graph:
            continue
        others = program.calls[name] | program.takes[name]
        if program.indirect[name] and not CALLERS.search(plain[name]):
            others = others | (formats if is_format(name) else traits)
        graph[name] = others
        waiting += others
    wrong, deepest, below = [], {}, {}
    for group in components(graph):
        frames = sum(program.stack.get(name, UNKNOWN) + pushed for name in group)
        if len(group) > 1 or group[0] in graph[group[0]]:
            # A group is known if one of its functions is, and all others are called through it.
            known = next((times for pattern, times, _ in KNOWN if any(re.search(pattern, plain[name]) for name in group)), None)
            if known is None:
                wrong.append("recursion: " + " -> ".join(plain[name] for name in group))
            frames *= known or 1
        depth, callee = max(((deepest[other], other) for name in group for other in graph[name] - set(group)), default=(0, None))
        for name in group:
            deepest[name], below[name] = frames + depth, callee
    frameless = [name for name in graph if name.startswith("hangpose_") and name not in program.stack]
    wrong += [f"{name}: its stack is not known" for name in frameless]
    interface = sorted((name for name in graph if name.startswith("hangpose_")), key=deepest.get, reverse=True)
    for name in interface:
        if deepest[name] > most:
            wrong.append(f"{name} may take {deepest[name]} bytes of the stack; {most} are promised")
    chain = interface[0]
    print(f"stack: of {path.rpartition('/')[2]}, {chain} may take most, {deepest[chain]} bytes:")
    while chain is not None:
        print(f"    {deepest[chain]:6} {program.stack.get(chain, UNKNOWN):6}  {plain[chain][:120]}")
        chain = below[chain]
    for name in interface[:5]:
        print(f"stack: {name} {deepest[name]}")
    if wrong:
        print(*wrong, sep="\n", file=sys.stderr)
        sys.exit("stack: see above")


if __name__ == "__main__":
    main()
