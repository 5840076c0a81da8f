#!/usr/bin/env python3
"""Writes the tables of docs/PERFORMANCE.md from the raw results of `make bench`.

  report.py --raw build/bench --out docs/PERFORMANCE.md [--before bench/before.json] [--keep COMMIT]

A table replaces what stands between `<!-- make bench: NAME -->` and `<!-- end of NAME -->`, so that the text around it
stays. A table whose raw results are missing is left as it is. --keep writes the figures of this run to the file of
--before, with the name of their commit; later runs show them beside their own.
"""
import argparse
import json
import math
import os
import pathlib
import platform
import re
import subprocess
import sys

STAGES = ("object", "supporter", "matching")
PROFILES = ("paper", "default")
# Sizes from which exponents are fitted.
UPPER = 10_000


def quantile(values, share):
    """The value of this rank among sorted ones, interpolated."""
    values = sorted(values)
    at = share * (len(values) - 1)
    low = math.floor(at)
    return values[low] + (at - low) * (values[min(low + 1, len(values) - 1)] - values[low])


def median(values):
    return quantile(values, 0.5)


def exponent(sizes, values):
    """The slope of a line through the logarithms: values grow as sizes to this power."""
    points = [(math.log(size), math.log(value)) for size, value in zip(sizes, values) if value > 0]
    if len(points) < 2:
        return None
    mean_x, mean_y = (sum(column) / len(points) for column in zip(*points))
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)


def number(value):
    """Three digits, or all before the point."""
    if value is None:
        return "–"
    if value == 0:
        return "0"
    value = float(f"{value:.3g}") if abs(value) < 1000 else value
    digits = max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:,.{digits}f}".replace(",", " ")


def spread(values):
    """The median with the 5th and the 95th percentile."""
    if not values:
        return "–"
    return f"{number(median(values))} ({number(quantile(values, 0.05))}–{number(quantile(values, 0.95))})"


def table(header, rows, text=(0,)):
    """A table in Markdown; the columns of these indices are text, the others numbers."""
    rule = ["---" if index in text else "--:" for index in range(len(header))]
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in [header, rule, *rows])


def replace_section(text, name, content):
    """The text with the content between the markers of this name."""
    start, end = f"<!-- make bench: {name} -->", f"<!-- end of {name} -->"
    if text.count(start) != 1 or text.count(end) != 1 or text.index(start) > text.index(end):
        sys.exit(f"report: there must be one line {start} and after it one {end}")
    before, rest = text.split(start)
    return f"{before}{start}\n\n{content.strip()}\n\n{end}{rest.split(end)[1]}"


def read(path):
    """The rows of a file of JSON lines, or the value of a JSON file; None if there is none."""
    if not path.exists():
        return None
    if path.suffix == ".jsonl":
        return [json.loads(line) for line in path.read_text().splitlines()]
    return json.loads(path.read_text())


class Report:
    """Tables by name, and the figures that are compared with those before."""

    def __init__(self, raw):
        self.raw = raw
        self.tables = {}
        # Figures by label: value, unit, whether more is better.
        self.figures = {}

    def figure(self, label, value, unit, more_is_better=False):
        if value is not None:
            self.figures[label] = (value, unit, more_is_better)

    def stages(self):
        rows = read(self.raw / "stages.jsonl")
        if rows is None:
            return
        lines = []
        for profile in PROFILES:
            ours = [row for row in rows if row["profile"] == profile]
            times = {stage: [row["milliseconds"][k] for row in ours] for k, stage in enumerate(STAGES)}
            times["supporter and matching"] = [sum(row["milliseconds"][1:]) for row in ours]
            times["all"] = [sum(row["milliseconds"]) for row in ours]
            for stage, values in times.items():
                lines.append([profile, stage, number(median(values)), number(quantile(values, 0.95)), number(max(values))])
            memory = [sum(row["bytes"]) / 2**20 for row in ours]
            lines.append([profile, "memory, MiB", number(median(memory)), number(quantile(memory, 0.95)), number(max(memory))])
            self.figure(f"`{profile}`, whole prediction, median", median(times["all"]), "ms")
            self.figure(f"`{profile}`, whole prediction, 95 %", quantile(times["all"], 0.95), "ms")
            self.figure(f"`{profile}`, supporter and matching, median", median(times["supporter and matching"]), "ms")
            self.figure(f"`{profile}`, memory, most", max(memory), "MiB")
        pairs = len({row["pair"] for row in rows})
        self.tables["stages"] = f"{pairs} pairs; milliseconds:\n\n" + table(["profile", "stage", "median", "95 %", "most"], lines, (0, 1))

    def peer(self):
        rows = read(self.raw / "peer.jsonl")
        if rows is None:
            return
        lines, ratios_of = [], {}
        for name in dict.fromkeys(row["set"] for row in rows):
            some = [row for row in rows if row["set"] == name]
            for k, stage in [*enumerate(STAGES), (None, "all")]:
                take = lambda run: 1000 * (sum(run["seconds"]) if k is None else run["seconds"][k])
                # The best of the runs that stand around those of the peer.
                ours = {p: [min(map(take, row[p])) for row in some] for p in PROFILES}
                peers = {cores: [row["peer"].get(cores) for row in some] for cores in ("one", "all")}
                cells = [name, stage]
                cells += [number(median([take(run) for run in runs if run] or [math.nan])) if any(runs) else "–" for runs in peers.values()]
                cells += [number(median(ours[p])) for p in PROFILES]
                for p in PROFILES:
                    for cores, runs in peers.items():
                        ratios = [take(run) / max(own, 1e-6) for run, own in zip(runs, ours[p]) if run]
                        cells.append(spread(ratios))
                        if stage == "all":
                            ratios_of.setdefault((p, cores), []).extend(ratios)
                lines.append(cells)
        header = ["pairs", "stage", "peer, 1 core", "peer, all cores", "`paper`", "`default`",
                  "peer 1 / `paper`", "peer all / `paper`", "peer 1 / `default`", "peer all / `default`"]
        said = []
        for name in dict.fromkeys(row["set"] for row in rows):
            some = [row for row in rows if row["set"] == name]
            over = {c: sum(c in row["peer"] and row["peer"][c] is None for row in some) for c in ("one", "all")}
            said.append(f"{len(some)} {name} pairs, the peer over {some[0]['limit']:.0f} s in {over['one']} (1 core) and {over['all']} "
                        f"(all {some[0]['cores']} cores)")
        self.tables["peer"] = "; ".join(said) + ". Milliseconds and ratios:\n\n" + table(header, lines, (0, 1))
        for (p, cores), ratios in ratios_of.items():
            if ratios:
                of = "one core" if cores == "one" else "all cores"
                self.figure(f"peer on {of} / `{p}`, median over all pairs", median(ratios), "", True)

    def primitives(self):
        found = read(self.raw / "primitives.json")
        if found is None:
            return
        groups, notes, about = found["groups"], found["notes"], found["about"]
        many = f"{about['queries']:,}".replace(",", " ")
        spreads = notes["poisson_disk"].get("spread_mm", {})
        gap = ", ".join(f"{name} {number(value[0])} mm" for name, value in spreads.items())
        sheet = notes["isosurface"]
        engines = notes["contact_step"]
        said = {
            "any_hit": f"Embree in batches of {many} with AVX; the others one by one"
                       + (f"; {notes['any_hit']['same_hits_percent']:.2f} % same answers" if "same_hits_percent" in notes["any_hit"] else ""),
            "closest_hit": "Embree also gives the triangle, its normal and coordinates; same distances",
            "closest_point": "Embree's tree with Open3D's closest point on a triangle; same distances",
            "signed_distance": "Sign: hangpose winding number, parry pseudo-normals, Open3D parity of one ray; same distances; same side "
                               f"parry {about['same_side_parry_percent']:.2f} %, Open3D {notes['signed_distance'].get('same_side_percent', math.nan):.2f} %. "
                               f"The field is a table with a mean error of {number(1000 * about['field_error_mean'])} mm near the surface",
            "nearest": "10 000 points; Open3D in one batch; same distances",
            "eight_nearest": "As above",
            "poisson_disk": f"10 000 samples; both eliminate samples, Yuksel's method: hangpose of 3 candidates for each, Open3D of 5. "
                            f"Median distance to the nearest: {gap}",
            "fuse": "One depth image of 640 × 480, voxels of 2 mm, a new volume each time",
            "isosurface": "Marching cubes of that volume" + (f"; Open3D {sheet['vertices']} vertices, median {number(sheet['median_off_mm'])} mm off the sphere" if sheet else ""),
            "contact_step": f"{found['pair']} at rest, steps of {1000 * found['time_step']:.0f} ms. hangpose collides a distance field with a cloud of "
                            "10 000 points, the others convex parts with convex parts"
                            + (f"; MuJoCo {engines['contacts']} contacts; drift after 0.5 s Bullet {number(1000 * found['drift_in_bullet'])} mm, MuJoCo {number(1000 * engines['drift'])} mm" if engines else ""),
        }
        units = {"poisson_disk": (1e3, "ms"), "fuse": (1e3, "ms"), "isosurface": (1e3, "ms"), "contact_step": (1e6, "µs")}
        lines = []
        for group, times in groups.items():
            factor, unit = units.get(group, (1e9, "ns"))
            mine = median(times["hangpose"])
            title = group.replace("_", " ")
            for name, values in times.items():
                ratio = "" if name == "hangpose" else number(mine / median(values))
                lines.append([f"{title}, {unit}", name, spread([factor * value for value in values]), ratio, said[group] if name == "hangpose" else ""])
            self.figure(f"{title}", factor * mine, unit)
            for name in ("embree", "parry", "mujoco", "bullet"):
                if name in times:
                    self.figure(f"{title}, hangpose / {name}", mine / median(times[name]), "")
        missing = f"\n\nMissing here: {', '.join(found['missing'])}." if found["missing"] else ""
        self.tables["primitives"] = table(["query", "library", "median (5–95 %)", "hangpose / it", "what differs"], lines, (0, 1, 4)) + missing
        self.groups = groups

    def paths(self):
        rows = read(self.raw / "reach.jsonl")
        if rows is None:
            return
        both = [(row["plan"], row["peer"]) for row in rows if row.get("plan") and row.get("peer")]
        ours, theirs = [1000 * plan["seconds"] for plan, _ in both], [1000 * peer["seconds"] for _, peer in both]
        found = sum(plan["answer"] == "path" for plan, _ in both), sum(peer["is_solved"] for _, peer in both)
        ratios = [b / a for (plan, peer), a, b in zip(both, ours, theirs) if plan["answer"] == "path" and peer["is_solved"]]
        lines = [[name, len(both), count, spread(times)] for name, count, times in (("hangpose", found[0], ours), ("OMPL", found[1], theirs))]
        self.tables["paths"] = table(["planner", "problems", "paths found", "ms, median (5–95 %)"], lines) + \
            f"\n\nOn the problems that both solve, OMPL takes {spread(ratios)} times as long."
        self.figure("path, OMPL / hangpose", median(ratios) if ratios else None, "", True)

    def growth(self):
        rows = read(self.raw / "growth.jsonl")
        if rows is None:
            return
        parts, fits = [], []
        for axis, title in (("triangles", "triangles of the object"), ("points", "points of the supporter"),
                            ("room", "points of a room of 2 m around the supporter of 10 000")):
            lines = []
            for row in rows:
                if row["axis"] != axis:
                    continue
                times = row["milliseconds"]
                lines.append([f"{row['size']:,}".replace(",", " "), row["profile"], *map(number, times), number(sum(times)),
                              number(sum(row["bytes"]) / 2**20)])
                if (axis, row["size"]) in {("triangles", 200_000), ("room", 300_000)}:
                    self.figure(f"`{row['profile']}`, {row['size']:,} {axis}".replace(",000", " 000"), sum(times), "ms")
            if lines:
                parts.append(f"By {title}; milliseconds:\n\n" + table([axis, "profile", *STAGES, "all", "memory, MiB"], lines, (1,)))
            for profile in PROFILES:
                upper = [row for row in rows if (row["axis"], row["profile"]) == (axis, profile) and row["size"] >= UPPER]
                if len(upper) < 2:
                    continue
                sizes = [row["size"] for row in upper]
                fit = lambda value: exponent(sizes, list(map(value, upper)))
                each = [fit(lambda row, k=k: row["milliseconds"][k]) for k in range(3)]
                fits.append([axis, profile, *map(number, each), number(fit(lambda row: sum(row["milliseconds"]))),
                             number(fit(lambda row: sum(row["bytes"])))])
        if fits:
            parts.append("Exponents, fitted from 10 000 on; that of all is low where a part that does not grow takes most of the time:\n\n"
                         + table(["by", "profile", *STAGES, "all", "memory"], fits, (0, 1)))
        self.tables["growth"] = "\n\n".join(parts)

    def bound(self):
        rows, found = read(self.raw / "stages.jsonl"), read(self.raw / "primitives.json")
        if rows is None or found is None:
            return
        # The fastest, as of the stages.
        best = {group: min((min(values), name) for name, values in times.items()) for group, times in found["groups"].items()}
        ray = min(best["any_hit"], best["closest_hit"])
        # What a distance query is: to the mesh, to the nearest point of the cloud, and to the mesh by the distance field.
        distance = {"object": best["closest_point"], "supporter": best["nearest"], "matching": best["signed_distance"]}
        lines = []
        for profile in PROFILES:
            ours = [row for row in rows if row["profile"] == profile]
            least_of, time_of = [0.0] * len(ours), [0.0] * len(ours)
            for k, stage in enumerate(STAGES):
                least = [1000 * (row["rays"][k] * ray[0] + row["distance_queries"][k] * distance[stage][0]
                                 + (best["poisson_disk"][0] if stage == "object" else 0)
                                 + (row["points"] * best["eight_nearest"][0] if stage == "supporter" else 0)) for row in ours]
                times = [row["milliseconds"][k] for row in ours]
                least_of = [a + b for a, b in zip(least_of, least)]
                time_of = [a + b for a, b in zip(time_of, times)]
                lines.append([profile, stage, number(median([row["rays"][k] for row in ours])),
                              number(median([row["distance_queries"][k] for row in ours])), number(median(least)), number(median(times)),
                              number(median([t / l for t, l in zip(times, least) if l > 0])) if any(least) else "–"])
            ratio = median([t / l for t, l in zip(time_of, least_of)])
            lines.append([profile, "all", "", "", number(median(least_of)), number(median(time_of)), number(ratio)])
            self.figure(f"`{profile}`, time / lower bound, median", ratio, "")
        costs = [f"a ray {number(1e9 * ray[0])} ns ({ray[1]})"]
        costs += [f"a distance query of {stage} {number(1e9 * cost)} ns ({name})" for stage, (cost, name) in distance.items()]
        costs += [f"the eight neighbours of a point {number(1e9 * best['eight_nearest'][0])} ns ({best['eight_nearest'][1]})"]
        costs += [f"the samples of the object {number(1e3 * best['poisson_disk'][0])} ms ({best['poisson_disk'][1]})"]
        self.tables["bound"] = "Best costs: " + "; ".join(costs) + ". Medians over the pairs:\n\n" + table(
            ["profile", "stage", "rays", "distance queries", "bound, ms", "time, ms", "time / bound"], lines, (0, 1))

    def instructions(self):
        found = read(self.raw / "instructions.json")
        if found is None:
            return
        lines = []
        for name, processor in found["processors"].items():
            for profile in PROFILES:
                counts = [processor["counts"][profile][stage] / 1e6 for stage in STAGES]
                lines.append([name, profile, *map(number, counts), number(sum(counts))])
                self.figure(f"`{profile}`, millions of instructions, {name}", sum(counts), "")
        missing = "\n\nMissing here: " + "; ".join(found["missing"]) + "." if found["missing"] else ""
        self.tables["instructions"] = "Millions of instructions:\n\n" + table(["processor", "profile", *STAGES, "all"], lines, (0, 1)) + missing

    def threads(self):
        found = read(self.raw / "threads.json")
        if found is None:
            return
        ratios = [one / two for one, two in zip(found["single"]["1"], found["single"]["2"])]
        batch = {jobs: min(times) for jobs, times in found["batch"].items()}
        gain = batch["1"] / batch["2"]
        lines = [["one prediction, ms", number(1000 * median(found["single"]["1"])), number(1000 * median(found["single"]["2"])), spread(ratios)],
                 [f"a table of {found['pairs']} pairs, s", number(batch["1"]), number(batch["2"]), number(gain)]]
        self.tables["threads"] = table(["", "one thread", "two threads", "times as fast"], lines)
        self.figure("one prediction, two threads", median(ratios), "times as fast", True)
        self.figure("a table of pairs, two threads", gain, "times as fast", True)

    def machine(self):
        found = read(self.raw / "machine.json")
        if found:
            self.tables["machine"] = "; ".join(f"{name} {value}" for name, value in found.items()) + "."

    def targets(self):
        """The targets of the project beside the figures."""
        rows = read(self.raw / "growth.jsonl") or []
        value = lambda label: self.figures.get(label, (None,))[0]
        slopes = []
        for axis in ("triangles", "points", "room"):
            upper = [row for row in rows if (row["axis"], row["profile"]) == (axis, "default") and row["size"] >= UPPER]
            if len(upper) > 1:
                slopes.append(exponent([row["size"] for row in upper], [sum(row["milliseconds"]) for row in upper]))
        # n log n between 10,000 and 1,000,000 has this slope.
        most = 1 + math.log(math.log(1e6) / math.log(1e4)) / math.log(100)
        asked = [
            ("peer on all cores / `paper`, median over all pairs", ">=", 60),
            ("peer on all cores / `default`, median over all pairs", ">=", 40),
            ("`default`, whole prediction, median", "<=", 33),
            ("`default`, whole prediction, 95 %", "<=", 100),
            ("`default`, supporter and matching, median", "<=", 20),
            ("`default`, 200 000 triangles", "<=", 60),
            ("`default`, 300 000 room", "<=", 50),
            ("`default`, time / lower bound, median", "<=", 3),
            ("closest point, hangpose / parry", "<=", 1),
            ("closest hit, hangpose / parry", "<=", 1),
            ("any hit, hangpose / parry", "<=", 1),
            ("closest point, hangpose / embree", "<=", 2.5),
            ("closest hit, hangpose / embree", "<=", 2.5),
            ("any hit, hangpose / embree", "<=", 2.5),
            ("`default`, memory, most", "<=", 8),
            ("one prediction, two threads", ">=", 1.6),
            ("a table of pairs, two threads", ">=", 1.9),
        ]
        lines = []
        for label, sign, limit in asked:
            now = value(label)
            if now is not None:
                met = now >= limit if sign == ">=" else now <= limit
                lines.append([label, f"{'≥' if sign == '>=' else '≤'} {limit}", f"{number(now)} {self.figures[label][1]}".strip(), "yes" if met else "no"])
        if slopes:
            lines.append(["`default`, largest exponent of growth", f"≤ {most:.2f} (n log n)", number(max(slopes)), "yes" if max(slopes) <= most else "no"])
        if lines:
            self.tables["targets"] = table(["figure", "target", "now", "met"], lines, (0, 3))

    def change(self, before):
        if not before:
            return
        lines = []
        for label, (now, unit, more) in self.figures.items():
            if label in before["figures"]:
                old = before["figures"][label]
                gain = (now / old if more else old / now) if old and now else None
                lines.append([label, f"{number(old)} {unit}".strip(), f"{number(now)} {unit}".strip(), number(gain)])
        if lines:
            self.tables["change"] = f"Before is commit {before['commit']}.\n\n" + table(["figure", "before", "now", "times better"], lines)


def machine(raw):
    """Writes what the figures are measured on."""
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.machine())
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False).stdout.strip()
    load = os.getloadavg()[0]
    found = {"processor": f"{model}, {os.cpu_count()} cores", "commit": commit, "load before the run": f"{load:.1f}"}
    (raw / "machine.json").write_text(json.dumps(found))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--raw", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--before", type=pathlib.Path, default=pathlib.Path(__file__).with_name("before.json"))
    parser.add_argument("--keep", metavar="COMMIT")
    parser.add_argument("--machine", action="store_true", help="write what the figures are measured on, and no tables")
    args = parser.parse_args()
    if args.machine:
        return machine(args.raw)
    report = Report(args.raw)
    for part in (report.machine, report.stages, report.peer, report.primitives, report.paths, report.growth, report.bound,
                 report.threads, report.instructions, report.targets):
        part()
    if args.keep:
        figures = {label: float(f"{value:.4g}") for label, (value, _, _) in report.figures.items()}
        args.before.write_text(json.dumps({"commit": args.keep, "figures": figures}, indent=1, ensure_ascii=False) + "\n")
    report.change(read(args.before))
    if args.out:
        text = args.out.read_text()
        for name, content in report.tables.items():
            text = replace_section(text, name, content)
        args.out.write_text(text)
        print(f"report: {args.out} has new tables: {', '.join(report.tables)}")


if __name__ == "__main__":
    main()
