"""The examples run, and what they predict hangs in the simulators."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import pytest
from conftest import ROOT

EXAMPLES = ROOT / "python/examples"


@pytest.mark.parametrize("simulator", ["mujoco", "pybullet"])
def test_the_mug_hangs_in_the_simulator(simulator: str) -> None:
    for module in (simulator, "coacd", "trimesh"):
        pytest.importorskip(module)
    example = EXAMPLES / f"drop_in_{simulator}.py"
    done = subprocess.run([sys.executable, str(example)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "it hangs" in done.stdout


def test_the_simulator_lets_fall_what_does_not_hang() -> None:
    for module in ("mujoco", "coacd", "trimesh"):
        pytest.importorskip(module)
    # Half a metre beside the hook.
    beside = [sys.executable, str(EXAMPLES / "drop_in_mujoco.py"), "0", "0.5", "0"]
    done = subprocess.run(beside, capture_output=True, text=True)
    assert done.returncode == 1 and "has fallen" in done.stdout, done.stdout + done.stderr


def test_the_notebook_runs_and_shows_pages() -> None:
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(EXAMPLES / "hang.ipynb", as_version=4)
    client = nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(EXAMPLES)}})
    client.execute()
    shown: list[Any] = [
        cell["outputs"][-1]["data"] for cell in notebook.cells if cell.get("outputs") and "data" in cell["outputs"][-1]
    ]
    pages = [data["text/html"] for data in shown if "text/html" in data]
    assert len(pages) == 2 and all(page.startswith("<iframe srcdoc=") for page in pages)
    # The second has the path.
    assert len(pages[1]) > len(pages[0])
