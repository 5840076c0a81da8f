#!/usr/bin/env python3
"""Prints the licences of the crates that are linked into the command or the library: licences.py CRATE TARGET"""

import json
import pathlib
import re
import subprocess
import sys

crate, target = sys.argv[1:]
arguments = ["cargo", "metadata", "--locked", "--format-version", "1", "--filter-platform", target]
metadata = json.loads(subprocess.run(arguments, check=True, stdout=subprocess.PIPE).stdout)
packages = {package["id"]: package for package in metadata["packages"]}
nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}

# What is linked: dependencies that are neither for tests nor for build scripts, nor macros of the compiler.
linked, waiting = set(), [next(i for i in nodes if packages[i]["name"] == crate)]
while waiting:
    package = waiting.pop()
    if package in linked or any("proc-macro" in target["kind"] for target in packages[package]["targets"]):
        continue
    linked.add(package)
    waiting += [d["pkg"] for d in nodes[package]["deps"] if any(kind["kind"] is None for kind in d["dep_kinds"])]

texts = {}
for package in sorted((packages[i] for i in linked), key=lambda p: (p["name"], p["version"])):
    if package["source"] is None:
        continue
    name = f"{package['name']} {package['version']}: {package['license']}"
    files = [f for f in pathlib.Path(package["manifest_path"]).parent.iterdir()
             if f.is_file() and re.match(r"(licen[cs]e|copying|notice|unlicense)", f.name, re.I)]
    print(name + ("" if files else " (the crate has no text of its licence)"))
    for file in sorted(files):
        text = file.read_text(encoding="utf-8", errors="replace").strip()
        texts.setdefault(text, []).append(f"{package['name']} {package['version']}, {file.name}")
for text, names in sorted(texts.items(), key=lambda item: item[1]):
    print("\n" + "-" * 80 + "\n" + "\n".join(names) + "\n\n" + text)
