"""Documentation and types agree with the module."""

from __future__ import annotations

import doctest
import importlib
import inspect
import re
import subprocess
import sys
from pathlib import Path

import hangpose
import pytest
from conftest import ROOT

MODULES = [path.stem for path in Path(hangpose.__file__).parent.glob("*.py")]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    module = hangpose if name == "__init__" else importlib.import_module(f"hangpose.{name}")
    assert doctest.testmod(module).failed == 0


def test_the_readme_runs(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(ROOT)
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "python/README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert blocks
    for block in blocks:
        exec(block, {})  # Code of this repository.
    assert capsys.readouterr().out


def test_the_version_is_that_of_the_workspace() -> None:
    manifest = (ROOT / "Cargo.toml").read_text(encoding="utf-8")
    assert f'version = "{hangpose.__version__}"' in manifest


def test_everything_public_is_documented() -> None:
    for name in hangpose.__all__:
        value = getattr(hangpose, name)
        if callable(value):
            assert inspect.getdoc(value), name


def test_the_stubs_agree_with_the_native_part() -> None:
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-m", "mypy.stubtest", "hangpose._hangpose"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_types() -> None:
    pytest.importorskip("mypy")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "-p", "hangpose"],
        capture_output=True,
        text=True,
        cwd=ROOT / "python",
    )
    assert done.returncode == 0, done.stdout
