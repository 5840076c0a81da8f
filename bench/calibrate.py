"""Fits the constants of docs/PROBABILITY.md to the outcomes of poses in Bullet.

Reads the rows that `tables --all --json` writes. `make calibrate` runs both.
"""

import json
import sys

import numpy as np
from sklearn.linear_model import LogisticRegression

MOST_CLEARANCE_MM = 1.0
LEAST_SINKING_MM = 8.0
MOST_SINKING_MM = 10.0
MOST_ESCAPE_RATIO = 2.0


def poses(path):
    """Yields for each pose: features of hanging and of robustness, whether it hangs, whether it is robust, predicted
    probability, and pair."""
    with open(path) as file:
        rows = [json.loads(line) for line in file]
    for row in rows:
        for outcome in row["outcomes"] if row["fits"] else []:
            said = outcome["said"]
            hangs = outcome["clear"] and outcome["holds"] and outcome["honest"]
            features = [
                said["jolt_time"],
                min(said["tilts"]),
                min(said["clearance"] * 1000.0, MOST_CLEARANCE_MM),
                min(max(said["tilted_sinking"] * 1000.0 - LEAST_SINKING_MM, 0.0), MOST_SINKING_MM),
            ]
            robust_features = [
                said["jolt_time"],
                sum(said["tilts"]) / len(said["tilts"]),
                min(said["escape_ratio"], MOST_ESCAPE_RATIO),
            ]
            robust = hangs and outcome["robust"]
            yield features, robust_features, hangs, robust, said["probability"], row["pair"]


def fit(name, features, outcomes):
    """Fits a logistic regression, with weak regularisation and unscaled features as in the documented formula."""
    model = LogisticRegression(C=10.0, max_iter=1000).fit(features, outcomes)
    constants = [model.intercept_[0], *model.coef_[0]]
    print(f"{name}, {100 * outcomes.mean():.1f} % of {len(outcomes)}: " + ", ".join(f"{c:.2f}" for c in constants))
    return model.predict_proba(features)[:, 1]


def main():
    features, robust_features, hangs, robust, said, pairs = (np.array(column) for column in zip(*poses(sys.argv[1])))
    print("constant, per second, per radian, per mm of clearance, per mm of sinking")
    fitted = fit("hangs", features, hangs)
    print("constant, per second, per radian of mean tilt, per unit of escape ratio")
    fitted_to_robust = fit("robust", robust_features, robust)
    for name, probability in [("as it is", said), ("fitted", fitted)]:
        print(f"Brier score, {name}: {np.mean((probability - hangs) ** 2):.4f}")
    for name, probability in [("as it is", said), ("fitted", fitted), ("fitted to robust", fitted_to_robust)]:
        # Among equal probabilities the first pose, in the order of the predictor.
        best = [max(np.flatnonzero(pairs == pair), key=lambda k: probability[k]) for pair in np.unique(pairs)]
        shares = 100 * hangs[best].mean(), 100 * robust[best].mean()
        print(f"best of {len(best)} pairs, {name}: hang {shares[0]:.1f} %, robust {shares[1]:.1f} %")
    jolt, tilt, clearance, sinking = features.T
    is_firm = (jolt >= 1.0) & (tilt > 1.0) & (clearance >= MOST_CLEARANCE_MM)
    for name, of in [("up to", is_firm & (sinking == 0.0)), ("more than", is_firm & (sinking > 0.0))]:
        print(
            f"that stay when jolted and tilted, sank by {name} {LEAST_SINKING_MM:g} mm: {of.sum()} poses, "
            f"hang {100 * hangs[of].mean():.1f} %, robust {100 * robust[of].mean():.1f} %"
        )
    for low, high in [(0.0, 0.5), (0.5, 0.8), (0.8, 0.9), (0.9, 0.95), (0.95, 0.975), (0.975, 1.0)]:
        of = (fitted >= low) & (fitted < high)
        if of.any():
            print(f"{low:.3f} to {high:.3f}: {of.sum():5} poses, said {fitted[of].mean():.3f}, hang {hangs[of].mean():.3f}")


if __name__ == "__main__":
    main()
