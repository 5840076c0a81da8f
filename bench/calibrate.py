"""Fits the constants of docs/PROBABILITY.md to the outcomes of poses in Bullet.

Reads the rows that `tables --all --json` writes, of generated pairs and, in a second file, of real meshes. `make
calibrate` runs both.
"""

import json
import sys

import numpy as np
from scipy.optimize import minimize_scalar
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import roc_auc_score

MOST_CLEARANCE_MM = 1.0
LEAST_PLAY_MM = 2.0
LITTLE_PLAY_MM = 3.0
LEAST_SINKING_MM = 8.0
MOST_SINKING_MM = 10.0
MOST_ESCAPE_RATIO = 2.0
# As in core/src/hanging/settling/probability.rs.
PER_CENTRE_ERROR = 0.6
MOST_CENTRE_ERROR = 0.5
# Edges of the bins of probability.
EDGES = [0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 1.0]


class Poses:
    """The poses of pairs that fit."""

    def __init__(self, path):
        rows = [row for row in map(json.loads, open(path)) if row["fits"]]
        told = [(row, outcome, outcome["said"]) for row in rows for outcome in row["outcomes"]]
        of_all = lambda value: np.array([value(row, outcome, said) for row, outcome, said in told])
        self.pair = of_all(lambda row, outcome, said: row["pair"])
        self.hangs = of_all(lambda row, outcome, said: outcome["clear"] and outcome["holds"] and outcome["honest"])
        self.holds = of_all(lambda row, outcome, said: outcome["clear"] and outcome["holds"])
        self.play = of_all(lambda row, outcome, said: 1000 * said["play"])
        self.robust = self.hangs & of_all(lambda row, outcome, said: outcome["robust"])
        self.said = of_all(lambda row, outcome, said: said["probability"])
        self.said_robust = of_all(lambda row, outcome, said: said["robustness"])
        self.features = of_all(
            lambda row, outcome, said: [
                said["jolt_time"],
                min(said["tilts"]),
                min(1000 * said["clearance"], MOST_CLEARANCE_MM),
                max(1000 * said["play"], LEAST_PLAY_MM),
                said["kind"] == "balanced",
                np.clip(1000 * said["tilted_sinking"] - LEAST_SINKING_MM, 0, MOST_SINKING_MM),
            ]
        ).astype(float)
        self.robust_features = of_all(
            lambda row, outcome, said: [
                said["jolt_time"],
                np.mean(said["tilts"]),
                min(said["escape_ratio"], MOST_ESCAPE_RATIO),
            ]
        )
        # In multiples of the error that is tolerated.
        self.centre_error = of_all(
            lambda row, outcome, said: row["centre_error"] / max(said["centre_of_mass_radius"], 1e-6)
        )


def print_quality(name, said, came):
    """Prints the share of the Brier score of the base rate that is saved, and the area under the ROC curve."""
    skill = 1 - np.mean((said - came) ** 2) / (came.mean() * (1 - came.mean()))
    print(f"{name}: Brier skill {skill:.3f}, area {roc_auc_score(came, said):.3f}")


def fit(name, features, outcomes):
    """Fits a logistic regression, with weak regularisation and unscaled features as in the documented formula."""
    model = LogisticRegression(C=10.0, max_iter=5000).fit(features, outcomes)
    constants = [model.intercept_[0], *model.coef_[0]]
    print(f"{name}, {100 * outcomes.mean():.1f} % of {len(outcomes)}: " + ", ".join(f"{c:.2f}" for c in constants))
    return model.predict_proba(features)[:, 1]


def print_reliability(said, came):
    for low, high in zip(EDGES, EDGES[1:]):
        of = (said >= low) & (said < high)
        if of.any():
            print(f"{low:.2f} to {high:.2f}: {of.sum():5} poses, said {said[of].mean():.3f}, hang {came[of].mean():.3f}")


def print_play(poses):
    """Prints how many of the poses that hold come free in the judge as well, so that they hang."""
    print("of the poses that hold, by play:")
    for name, of in [("less than 3 mm", poses.play < LITTLE_PLAY_MM), ("more", poses.play >= LITTLE_PLAY_MM)]:
        of &= poses.holds
        print(f"{name}: {of.sum()} poses, hang {100 * poses.hangs[of].mean():.1f} %")


def fit_margin(poses):
    print("constant, per second, per radian, per mm of clearance, per mm of play, balanced, per mm of sinking")
    fitted = fit("hangs", poses.features, poses.hangs)
    print("constant, per second, per radian of mean tilt, per unit of escape ratio")
    fitted_to_robust = fit("robust", poses.robust_features, poses.robust)
    for name, probability in [("as it is", poses.said), ("fitted", fitted)]:
        print_quality(f"hangs, {name}", probability, poses.hangs)
    for name, probability in [("as it is", poses.said_robust), ("fitted", fitted_to_robust)]:
        print_quality(f"robust, {name}", probability, poses.robust)
    for name, probability in [("as it is", poses.said), ("fitted", fitted), ("fitted to robust", fitted_to_robust)]:
        # Among equal probabilities the first pose, in the order of the predictor.
        pairs = np.unique(poses.pair)
        best = [max(np.flatnonzero(poses.pair == pair), key=lambda k: probability[k]) for pair in pairs]
        shares = 100 * poses.hangs[best].mean(), 100 * poses.robust[best].mean()
        print(f"best of {len(best)} pairs, {name}: hang {shares[0]:.1f} %, robust {shares[1]:.1f} %")
    print_reliability(poses.said, poses.hangs)
    print_play(poses)


def fit_centre(poses):
    """Fits the doubt for the centre of mass, with the other constants as they are."""
    error = np.minimum(poses.centre_error, MOST_CENTRE_ERROR)
    certain = poses.said * np.exp(PER_CENTRE_ERROR * error)

    def said(doubt):
        return np.clip(certain * np.exp(-doubt * error), 1e-6, 1 - 1e-6)

    def loss(doubt):
        return -np.mean(np.where(poses.hangs, np.log(said(doubt)), np.log(1 - said(doubt))))

    fitted = minimize_scalar(loss, bounds=(0, 5), method="bounded").x
    for name, doubt in [("none", 0.0), ("as it is", PER_CENTRE_ERROR), ("fitted", fitted)]:
        print_quality(f"doubt for the centre of mass, {name}, {doubt:.2f}", said(doubt), poses.hangs)
    bounds = [0.0, 1e-6, 0.1, 0.2, 0.3, 0.5, 1.0, np.inf]
    for low, high in zip(bounds, bounds[1:]):
        of = (poses.centre_error >= low) & (poses.centre_error < high)
        if of.any():
            name = "certain" if high <= 1e-6 else f"wrong by {low:.1f} to {high:.1f} of what is tolerated"
            print(f"{name}: {of.sum()} poses, hang {100 * poses.hangs[of].mean():.0f} %, said {100 * certain[of].mean():.0f} % without it")
    print_reliability(poses.said, poses.hangs)


def main():
    of_made, *of_real = sys.argv[1:]
    fit_margin(Poses(of_made))
    for path in of_real:
        print("\nReal meshes:")
        fit_centre(Poses(path))


if __name__ == "__main__":
    main()
