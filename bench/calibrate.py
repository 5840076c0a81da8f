"""Fits the constants of docs/PROBABILITY.md to poses that were let go in Bullet.

Reads the rows of `tables --all --json`: make calibrate.
"""

import json
import sys

import numpy as np
from sklearn.linear_model import LogisticRegression

MOST_RATIO = 0.6
MOST_CLEARANCE_MM = 1.0


def poses(path):
    """What the predictor said of each pose, and whether it hangs."""
    with open(path) as file:
        rows = [json.loads(line) for line in file]
    for row in rows:
        for outcome in row["outcomes"] if row["fits"] else []:
            said = outcome["said"]
            hangs = outcome["clear"] and outcome["holds"] and outcome["honest"]
            features = [
                min(said["tilts"]),
                min(said["escape_ratio"], MOST_RATIO),
                min(said["clearance"] * 1000.0, MOST_CLEARANCE_MM),
            ]
            yield features, hangs, said["probability"]


def main():
    features, hangs, said = (np.array(column) for column in zip(*poses(sys.argv[1])))
    # Hardly regularised, without scaling: the constants are of the formula as it stands.
    model = LogisticRegression(C=10.0, max_iter=1000).fit(features, hangs)
    fitted = model.predict_proba(features)[:, 1]
    print(f"{len(hangs)} poses, {100 * hangs.mean():.1f} % hang")
    for name, constant in zip(["per radian", "per ratio", "per mm"], model.coef_[0]):
        print(f"{name:10}  {constant:6.2f}")
    print(f"constant    {model.intercept_[0]:6.2f}")
    for name, probability in [("as it is", said), ("fitted", fitted)]:
        print(f"Brier score, {name}: {np.mean((probability - hangs) ** 2):.4f}")
    for low, high in [(0.0, 0.5), (0.5, 0.8), (0.8, 0.9), (0.9, 0.95), (0.95, 0.975), (0.975, 1.0)]:
        of = (fitted >= low) & (fitted < high)
        if of.any():
            print(f"{low:.3f} to {high:.3f}: {of.sum():5} poses, said {fitted[of].mean():.3f}, hang {hangs[of].mean():.3f}")


if __name__ == "__main__":
    main()
