"""Predicts the pairs of a CSV file on the workers of Dask.

    pip install hangpose "dask[distributed]"
    python dask_batch.py samples/pairs.csv poses.csv --workers 2
    python dask_batch.py samples/pairs.csv poses.csv --scheduler tcp://cluster:8786

The table has the columns object and supporter, paths relative to it, and may have id, object_scale and supporter_scale.
The result has a row for each pose, best first, or one row without a pose, in the order of the table, whatever the number
of workers. Workers of a cluster read the files from paths that all computers share. For more options, resuming and
Parquet see `hangpose batch`.
"""

import argparse
import csv
import functools
from pathlib import Path

import hangpose

# Pairs of one task: many enough that a worker uses what it has analysed again, few enough that all workers end
# together.
CHUNK = 10
# Poses that are written of each pair.
TOP = 3
KNOWN = ["id", "object", "supporter", "object_scale", "supporter_scale"]
MATRIX = [f"m{row}{column}" for row in range(3) for column in range(4)]
COLUMNS = ["id", "object", "supporter", "rank", *MATRIX, "kind", "probability", "rejection", "error"]


# Each worker keeps what it has read and analysed. The sizes bound its memory.
@functools.lru_cache(maxsize=64)
def read_object(path, scale):
    return hangpose.Object(path, scale=scale)


@functools.lru_cache(maxsize=64)
def read_supporter(path, scale):
    return hangpose.Supporter(path, scale=scale)


def predict_pair(folder, pair):
    """The rows of a pair."""
    row = {name: pair[name] for name in ("id", "object", "supporter")}
    try:
        thing = read_object(str(folder / pair["object"]), float(pair.get("object_scale") or 1))
        supporter = read_supporter(str(folder / pair["supporter"]), float(pair.get("supporter_scale") or 1))
        found = hangpose.predict(thing, supporter, top=TOP)
    # A bad file or scale is an error of its row and does not stop the rest.
    except (hangpose.HangposeError, ValueError) as error:
        return [{**row, "error": str(error)}]
    if not found.poses:
        return [{**row, "rejection": found.rejection.stage}]
    rows = []
    for pose in found.poses:
        matrix = dict(zip(MATRIX, pose.release[:3].ravel().tolist()))
        rows.append({**row, "rank": pose.rank, **matrix, "kind": pose.kind, "probability": pose.probability})
    return rows


def predict_chunk(folder, pairs):
    """The rows of some pairs: what a worker does in one task."""
    return [row for pair in pairs for row in predict_pair(Path(folder), pair)]


def read_pairs(path):
    with open(path, newline="", encoding="utf-8-sig") as file:
        reader = csv.DictReader(file)
        columns = set(reader.fieldnames or ())
        missing, unknown = {"object", "supporter"} - columns, columns - set(KNOWN)
        if missing:
            raise SystemExit(f"{path}: the column {', '.join(sorted(missing))} is missing")
        if unknown:
            raise SystemExit(f"{path}: the column {', '.join(sorted(unknown))} is unknown; known are {', '.join(KNOWN)}")
        return [{**pair, "id": pair.get("id") or str(number)} for number, pair in enumerate(reader, start=1)]


def write_rows(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def predict_all(pairs, folder, workers=2, scheduler=None):
    """The rows of all pairs in order: on a cluster, on local workers, or in this process if there are none."""
    chunks = [pairs[start : start + CHUNK] for start in range(0, len(pairs), CHUNK)]
    if not workers and not scheduler:
        results = [predict_chunk(folder, chunk) for chunk in chunks]
    else:
        from dask.distributed import Client, LocalCluster

        # One thread a worker, so that each keeps what it has analysed.
        local = scheduler or LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None)
        with Client(local) as client:
            # gather keeps the order of the chunks, in whatever order they end.
            results = client.gather(client.map(functools.partial(predict_chunk, folder), chunks, pure=False))
        if not scheduler:
            local.close()
    return [row for rows in results for row in rows]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pairs", help="CSV file with the columns object and supporter")
    parser.add_argument("output", help="CSV file for the poses")
    parser.add_argument("--workers", type=int, default=2, help="local workers, 0 for only this process [default: 2]")
    parser.add_argument("--scheduler", help="address of the scheduler of a cluster, in place of local workers")
    arguments = parser.parse_args()
    pairs = read_pairs(arguments.pairs)
    folder = str(Path(arguments.pairs).resolve().parent)
    write_rows(arguments.output, predict_all(pairs, folder, arguments.workers, arguments.scheduler))


# Dask starts its workers by importing this file again.
if __name__ == "__main__":
    main()
