"""Fits the doubt of docs/PROBABILITY.md, for what no camera has seen, to the outcomes of poses on scans in Bullet.

Reads the rows that `tables --scan ... --profile improbable --all --json` writes. `make calibrate` runs both.
"""

import json
import sys

import numpy as np
from scipy.optimize import minimize

# As in core/src/hanging/settling/probability.rs: for the object, the shadow and the supporter.
DOUBT = np.array([0.8, 1.8, 0.8])
# Escape ratio from which a pose is deep.
DEEP = 1.0
BINS = [0.0, 0.3, 0.5, 0.8, 0.9, 0.95, 1.0]


def main():
    sure, unseen, hangs, scans, weights = [], [], [], [], []
    with open(sys.argv[1]) as file:
        for row in map(json.loads, file):
            for outcome in row["outcomes"]:
                said = outcome["said"]
                object_, shadow, supporter = said["unseen"]
                shallowness = 1 - min(said["escape_ratio"], DEEP) / DEEP
                unseen.append([object_ * shallowness, shadow, supporter * shallowness])
                sure.append(said["probability"] * np.exp(DOUBT @ unseen[-1]))
                hangs.append(outcome["clear"] and outcome["holds"] and outcome["honest"])
                scans.append(row["scan"])
                # The poses of a pair are alike.
                weights.append(len(row["outcomes"]) ** -0.5)
    sure, unseen, hangs, scans, weights = map(np.array, (sure, unseen, hangs, scans, weights))

    def loss(doubt):
        p = np.clip(sure * np.exp(-unseen @ doubt), 1e-4, 1 - 1e-4)
        return -np.average(np.where(hangs, np.log(p), np.log(1 - p)), weights=weights)

    fitted = minimize(loss, DOUBT, bounds=[(0, 10)] * 3).x
    print("doubt for the object, the shadow, the supporter")
    for name, doubt in [("as it is", DOUBT), ("fitted", fitted)]:
        p = sure * np.exp(-unseen @ doubt)
        numbers = ", ".join(f"{x:.2f}" for x in doubt)
        print(f"{name}: {numbers}; Brier score {np.mean((p - hangs) ** 2):.4f} on {len(p)} poses")
    said = sure * np.exp(-unseen @ DOUBT)
    names = ["below 30 %", "30 to 50 %", "50 to 80 %", "80 to 90 %", "90 to 95 %", "95 % or more"]
    print("      " + " | ".join(f"{name:12}" for name in names))
    for scan in np.unique(scans):
        cells = []
        for low, high in zip(BINS, BINS[1:]):
            of = (scans == scan) & (said >= low) & (said < high + (high == 1.0))
            cells.append(f"{100 * hangs[of].mean():.0f} % of {of.sum()}" if of.any() else "")
        print((f"{scan:5} " + " | ".join(f"{cell:12}" for cell in cells)).rstrip())


main()
