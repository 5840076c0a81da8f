#!/usr/bin/env bash
# `make bench`: measures all that docs/PERFORMANCE.md shows, one thing after the other, and writes its tables. Raw results
# go to build/bench. A part whose tools or data are missing is left out with a word; its tables stay as they are.
#   run.sh [--only PART,...] [--peer PEER.py] [--meshes FOLDER]
# Parts: stages, peer, primitives, paths, growth, threads, instructions.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
only=stages,peer,primitives,paths,growth,threads,instructions
peer=
meshes=
while [ $# -gt 0 ]; do
    case $1 in
    --only) only=$2 ;;
    --peer) peer=$2 ;;
    --meshes) meshes=$2 ;;
    *) echo "usage: run.sh [--only PART,...] [--peer PEER.py] [--meshes FOLDER]" >&2; exit 2 ;;
    esac
    shift 2
done
raw=$root/build/bench
bin=${CARGO_TARGET_DIR:-$root/target}/release
python=$root/build/peer/bin/python
mkdir -p "$raw"
wants() { case ,$only, in *,"$1",*) ;; *) return 1 ;; esac; echo "bench: $1, $(date +%T)"; }
# Everything on the first core, so that two runs compare; the peer also takes the others.
core=$(python3 -c 'import os; print(min(os.sched_getaffinity(0)))')
pinned() { taskset -c "$core" "$@"; }
status=0
broken() { echo "bench: $1 failed; its tables stay as they are" >&2; rm -f "$raw/$2"; status=1; }
has() { "$python" -c "import $1" 2>/dev/null; }

python3 bench/report.py --raw "$raw" --machine

if wants stages; then
    pinned "$bin/speed" --pairs 44 --triangles 20000 --json "$raw/stages.jsonl" || broken stages stages.jsonl
fi
if wants peer; then
    if [ -z "$peer" ] || [ ! -e "$peer" ]; then
        echo "bench: no comparison with a peer: give PEER=peer.py"
    elif ! has open3d; then
        echo "bench: no comparison with a peer: Open3D is missing, see bench/requirements.txt"
    else
        folders=("$raw/pairs/made")
        rm -rf "$raw/pairs"
        "$bin/speed" export --pairs 22 --out "$raw/pairs/made"
        if [ -n "$meshes" ]; then
            "$bin/speed" export --pairs 22 --meshes "$meshes" --out "$raw/pairs/real"
            folders+=("$raw/pairs/real")
        else
            echo "bench: no real pairs: give MESHES=folder"
        fi
        "$python" bench/against_peer.py --peer "$peer" --command "$bin/hangpose" --out "$raw/peer.jsonl" "${folders[@]}" ||
            broken peer peer.jsonl
    fi
fi
if wants primitives; then
    "$bin/speed" primitives --out "$raw/primitives"
    # Without Open3D and MuJoCo the other libraries are still compared.
    interpreter=$python
    has numpy || interpreter=python3
    "$interpreter" bench/primitives.py --data "$raw/primitives" --bench "$bin/primitives" --criterion "$raw/criterion" \
        --out "$raw/primitives.json" || broken primitives primitives.json
fi
if wants paths; then
    pinned "$bin/reach" --pairs 22 --trees 0 --enclosed 0 --scene nothing,wall --peer --json "$raw/reach.jsonl" >/dev/null ||
        broken paths reach.jsonl
fi
if wants growth; then
    pinned "$bin/speed" growth --json "$raw/growth.jsonl" || broken growth growth.jsonl
fi
if wants threads; then
    if [ "$(nproc)" -lt 2 ]; then
        echo "bench: no comparison of threads: this machine has one core"
    else
        [ -e "$raw/pairs/made/pairs.json" ] || "$bin/speed" export --pairs 22 --out "$raw/pairs/made"
        python3 bench/threads.py --command "$bin/hangpose" --out "$raw/threads.json" "$raw/pairs/made" ||
            broken threads threads.json
    fi
fi
if wants instructions; then
    bench/instructions/run.sh "$raw/instructions.json" || broken instructions instructions.json
fi
python3 bench/report.py --raw "$raw" --out docs/PERFORMANCE.md
exit $status
