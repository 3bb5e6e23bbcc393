"""Processes of this machine: they are replaced when they die, and end with who started them."""

from __future__ import annotations

import os
import time

import pytest
from support.batches import contents, deadly, frames, slow_frame

import vectorplot as vp
from vectorplot.batch import Processes, run
from vectorplot.batch.running import Tally


def gone(pid: int) -> bool:
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii") as file:
            return file.read().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@pytest.mark.slow
def test_two_processes_of_which_one_dies_give_the_same_bytes_and_end_at_once(tmp_path):
    run(frames(tmp_path / "here", 8))
    marker = str(tmp_path / "marker")
    with pytest.raises(KeyboardInterrupt), Processes(2) as executor:
        tasks = frames(tmp_path / "there", 8, deadly, marker, 1)
        assert run(tasks, executor, window=4) == Tally(written=8)
        assert (tmp_path / "marker").read_bytes() == b".."
        pids = {executor.submit(os.getpid).result() for _ in range(4)}
        endless = frames(tmp_path / "never", 4, slow_frame, 600.0)

        def stop(outcome):
            raise KeyboardInterrupt

        run([*frames(tmp_path / "last", 1), *endless], executor, window=2, tell=stop)
    assert contents(tmp_path / "here") == contents(tmp_path / "there")
    assert not (tmp_path / "never").exists()
    until = time.monotonic() + 120.0
    while not all(map(gone, pids)) and time.monotonic() < until:
        time.sleep(0.01)
    assert all(map(gone, pids))


@pytest.mark.parametrize("workers", [0, 1025])
def test_so_many_processes_are_none(workers):
    with pytest.raises(vp.InputError, match=f"{workers} workers: expected 1 to 1024"):
        Processes(workers)
