"""A real cluster of two workers on this machine, of which one is killed at work."""

from __future__ import annotations

import os
import signal

import pytest
from support.batches import contents, frame, frames, slow_frame

import vectorplot as vp
from vectorplot.batch import run
from vectorplot.batch.running import Tally
from vectorplot.batch.tasks import cluster


@pytest.fixture(scope="module")
def distributed():
    """Imported by who runs these tests, not by all who collect them."""
    return pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def scheduler(distributed):
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None, silence_logs=50
    ) as local:
        yield local.scheduler_address


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::DeprecationWarning")
def test_a_worker_that_is_killed_costs_no_frame_and_a_stopped_run_goes_on(scheduler, distributed, tmp_path):
    tasks = frames(tmp_path / "there", 24, slow_frame, 0.05)
    killed, told = [], []
    with distributed.Client(scheduler, set_as_default=False) as client:
        pids = list(client.run(os.getpid).values())

    def after(outcome):
        told.append(outcome.state)
        if len(told) == 6:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), cluster(scheduler) as executor:
        run(tasks, executor, window=6, tell=after)
    assert told == ["written"] * 6 and len(contents(tmp_path / "there")) == 6

    def murder(outcome):
        told.append(outcome.state)
        if told.count("written") == 10 and not killed:
            killed.append(pids[0])
            os.kill(pids[0], signal.SIGKILL)

    with cluster(scheduler) as executor:
        assert run(tasks, executor, window=6, tell=murder) == Tally(written=18, kept=6)
    assert killed
    assert contents(tmp_path / "there") == {f"{number:04d}.svg": frame(number) for number in range(24)}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("address", "said"), [("nonsense://x", "no cluster answers"), ("tcp://127.0.0.1:1", "no cluster answers")]
)
@pytest.mark.usefixtures("distributed")
def test_where_nobody_answers_one_line_says_so(address, said, monkeypatch):
    monkeypatch.setattr("vectorplot.batch.tasks.ANSWERS_S", 0.2)
    with pytest.raises(vp.InputError, match=said) as error, cluster(address):
        pass
    assert "\n" not in str(error.value)
