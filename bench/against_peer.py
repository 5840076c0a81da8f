#!/usr/bin/env python3
"""Times hangpose and another implementation of the paper on the same files, pair by pair, in alternation.

  against_peer.py --peer PEER.py --command HANGPOSE --out FILE [--limit 30] FOLDER [FOLDER ...]

PEER.py must define `load(object, supporter, scale, supporter_mesh)` and `predict(mesh, points, normals)`, which returns
poses and a dict of seconds. A folder holds `pairs.json`, as `speed export` writes it. hangpose runs on one core; the peer
first on the same core and then on all. Each run of the peer ends after the limit, in seconds. Needs open3d, scikit-learn
and scipy.
"""
import argparse
import importlib.util
import json
import os
import pathlib
import select
import subprocess
import sys

STAGES = ("object", "supporter", "matching")
PROFILES = ("paper", "default")


def serve(path):
    """Answers each line, a JSON list of two files, with the peer's seconds."""
    spec = importlib.util.spec_from_file_location("peer", path)
    peer = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(peer)
    for line in sys.stdin:
        mesh, points, normals = peer.load(*json.loads(line), 1.0, False)
        poses, timing = peer.predict(mesh, points, normals)
        print(json.dumps([timing[f"{stage}_s"] for stage in STAGES] + [len(poses)]), flush=True)


class Peer:
    """The peer in a process of its own, on the given cores. It starts anew after a run that was stopped."""

    def __init__(self, path, cores):
        self.command = ["taskset", "-c", cores, sys.executable, __file__, "--serve", path]
        threads = "1" if cores.isdigit() else str(os.cpu_count())
        names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
        self.environment = os.environ | {name: threads for name in names}
        self.process = None

    def predict(self, files, limit):
        """Seconds by stage and the number of poses, or None if the limit is over or the peer fails."""
        if self.process is None:
            pipe = subprocess.PIPE
            self.process = subprocess.Popen(self.command, stdin=pipe, stdout=pipe, text=True, env=self.environment)
        self.process.stdin.write(json.dumps(files) + "\n")
        self.process.stdin.flush()
        ready, _, _ = select.select([self.process.stdout], [], [], limit)
        line = self.process.stdout.readline() if ready else ""
        if not line:
            self.stop()
            return None
        *seconds, poses = json.loads(line)
        return {"seconds": seconds, "poses": poses}

    def stop(self):
        if self.process:
            self.process.kill()
            self.process.wait()
            self.process = None


def hangpose(command, core, files, profile, seed):
    """Seconds by stage of one prediction, and the number of poses."""
    run = ["taskset", "-c", core, command, "predict", "--object", files[0], "--supporter", files[1], "--profile", profile,
           "--seed", str(seed), "--threads", "1", "--json", "-"]
    result = subprocess.run(run, capture_output=True, text=True, check=False)
    if result.returncode not in (0, 3):
        sys.exit(result.stderr)
    document = json.loads(result.stdout)
    return {"seconds": [document["stats"]["seconds"][stage] for stage in STAGES], "poses": len(document["poses"])}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peer", required=True)
    parser.add_argument("--command", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--limit", type=float, default=30)
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    args = parser.parse_args()
    cores = sorted(os.sched_getaffinity(0))
    core, every = str(cores[0]), ",".join(map(str, cores))
    peers = {"one": Peer(args.peer, core)}
    if len(cores) > 1:
        peers["all"] = Peer(args.peer, every)
    warm = json.loads((args.folders[0] / "pairs.json").read_text())[0]
    for peer in peers.values():
        peer.predict([str(args.folders[0] / warm[kind]) for kind in ("object", "supporter")], args.limit)
    with args.out.open("w") as out:
        for folder in args.folders:
            for pair in json.loads((folder / "pairs.json").read_text()):
                files = [str(folder / pair[kind]) for kind in ("object", "supporter")]
                row = pair | {"set": folder.name, "limit": args.limit, "cores": len(cores), "peer": {}}
                row |= {profile: [] for profile in PROFILES}
                ours = lambda: [row[profile].append(hangpose(args.command, core, files, profile, pair["seed"]))
                                for profile in PROFILES]
                ours()
                for name, peer in peers.items():
                    row["peer"][name] = peer.predict(files, args.limit)
                    ours()
                out.write(json.dumps(row) + "\n")
                out.flush()
                total = lambda run: f"{sum(run['seconds']):.2f} s" if run else "over the limit"
                theirs = ", ".join(f"{name} {total(run)}" for name, run in row["peer"].items())
                print(f"{pair['name']}: peer on cores {theirs}; paper {total(row['paper'][0])}, "
                      f"default {total(row['default'][0])}", flush=True)
    for peer in peers.values():
        peer.stop()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--serve"]:
        serve(sys.argv[2])
    else:
        main()
