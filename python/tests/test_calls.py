"""Long calls: progress, interrupts, exceptions of callbacks, and threads."""

from __future__ import annotations

import os
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Callable

import hangpose
import pytest
from conftest import SAMPLES, same

PATIENT = hangpose.Params(settle_attempts=10_000, firm_enough=10_000, time_step=0.0005)
"""Constants with which a prediction takes minutes."""
SOON = 5.0
"""Within this time a call ends that was told to, seconds: far less than minutes. About 20 ms where nothing else runs."""


@pytest.fixture(scope="module")
def slow() -> tuple[hangpose.Object, hangpose.Supporter]:
    files = (SAMPLES / "mug.obj", SAMPLES / "mug_tree.ply")
    return hangpose.Object(files[0], params=PATIENT), hangpose.Supporter(files[1], params=PATIENT)


def after(seconds: float, action: Callable[[], Any]) -> threading.Timer:
    timer = threading.Timer(seconds, action)
    timer.start()
    return timer


def test_progress(mug: hangpose.Object, slow: Any) -> None:
    seen: list[float] = []
    found = hangpose.predict(*slow, work_limit=400_000, progress=seen.append)
    assert found.stopped == "work_limit" and found.rejection is None
    assert len(seen) > 2 and seen == sorted(seen) and 0 <= seen[0] and seen[-1] == 1.0
    assert all(type(share) is float for share in seen)
    for make in (
        lambda progress: hangpose.Object(SAMPLES / "mug.obj", progress=progress),
        lambda progress: hangpose.Supporter(SAMPLES / "hook.ply", progress=progress),
    ):
        seen.clear()
        make(seen.append)
        assert seen[-1] == 1.0


def test_an_interrupt_ends_a_call_soon(slow: Any, mug: hangpose.Object, hook: hangpose.Supporter) -> None:
    before = hangpose.predict(mug, hook)
    # A process in the background of a shell ignores interrupts from its start.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = after(0.1, lambda: os.kill(os.getpid(), signal.SIGINT))
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        hangpose.predict(*slow)
    assert 0.1 <= time.monotonic() - start < 0.1 + SOON
    timer.join()
    # Nothing is broken.
    assert same(hangpose.predict(mug, hook), before)
    assert hangpose.predict(*slow, work_limit=1000).stopped == "work_limit"


def test_an_exception_of_a_callback_ends_the_call_and_is_raised(slow: Any, prediction: hangpose.Prediction) -> None:
    class Enough(Exception):
        pass

    def stop(_: Any) -> bool:
        raise Enough("enough")

    start = time.monotonic()
    with pytest.raises(Enough, match="enough"):
        hangpose.predict(*slow, progress=stop)
    with pytest.raises(Enough, match="enough"):
        hangpose.plan(prediction.object, prediction.supporter, prediction.best, accepts=stop)
    assert time.monotonic() - start < SOON


def test_the_arm_decides_what_can_be_reached(prediction: hangpose.Prediction) -> None:
    asked = []

    def accepts(pose: Any) -> bool:
        asked.append(pose)
        return False

    with pytest.raises(hangpose.NoPath) as caught:
        hangpose.plan(prediction.object, prediction.supporter, prediction.best, accepts=accepts)
    assert caught.value.reason == "goal_outside_workspace"
    assert asked[0].shape == (4, 4)


def test_other_threads_run_during_a_call(slow: Any) -> None:
    count, is_done = 0, False

    def work() -> None:
        nonlocal count
        while not is_done:
            count += 1

    thread = threading.Thread(target=work)
    thread.start()
    before = count
    hangpose.predict(*slow, work_limit=400_000)
    during, is_done = count - before, True
    thread.join()
    # With the lock held for all of the call the other thread would have one turn or two, of 5 ms each.
    assert during > 200_000


def test_models_are_shared_between_threads(
    mug: hangpose.Object, hook: hangpose.Supporter, prediction: hangpose.Prediction
) -> None:
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(lambda _: hangpose.predict(mug, hook), range(8)))
    assert all(same(one, prediction) for one in found)
