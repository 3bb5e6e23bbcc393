"""Files that are made, kept and failed, whoever makes them."""

from __future__ import annotations

import os
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from functools import partial
from itertools import count, islice
from pathlib import Path

import pytest
from support.batches import bad, contents, frame, frames

import vectorplot as vp
from vectorplot.batch import Task, fingerprint, results, run
from vectorplot.batch.running import RECORD, Tally
from vectorplot.batch.tasks import ALONE, IN_COMPANY, Here, Lost, answers


class Losing(Here):
    """An executor that loses the worker of a call, and of those beside it, so many times."""

    def __init__(self, times: int, deadly: int) -> None:
        self.times, self.deadly, self.begun, self.waiting = times, deadly, [], []

    def submit(self, fn, /, *args, **kwargs):
        number = fn.args[0].args[0]
        self.begun.append(number)
        if number == self.deadly and self.times:
            self.times -= 1
            future: Future = Future()
            future.set_exception(BrokenProcessPool("terminated abruptly"))
            return future
        return super().submit(fn, *args, **kwargs)


def test_files_are_written_and_the_next_time_kept(tmp_path):
    told = []
    assert run(frames(tmp_path / "a", 4), tell=told.append) == Tally(written=4)
    assert [outcome.state for outcome in told] == ["written"] * 4
    first = contents(tmp_path / "a")
    assert first["0002.svg"] == frame(2)
    assert run(frames(tmp_path / "a", 6)) == Tally(written=2, kept=4)
    assert first.items() < contents(tmp_path / "a").items()


def test_what_has_changed_or_is_gone_is_made_again(tmp_path):
    tasks = frames(tmp_path, 5)
    run(tasks)
    tasks[0] = replace(tasks[0], fingerprint=fingerprint("another"))
    Path(tasks[1].path).unlink()
    Path(tasks[2].path).write_bytes(b"")
    told = []
    assert run(tasks, tell=told.append) == Tally(written=3, kept=2)
    assert [Path(outcome.path).name for outcome in told if outcome.state == "kept"] == ["0003.svg", "0004.svg"]


def test_without_a_fingerprint_a_file_is_always_made(tmp_path):
    task = Task(str(tmp_path / "a.bin"), partial(bytes, 3))
    assert run([task]) == run([task]) == Tally(written=1)
    assert not (tmp_path / RECORD).exists()


def test_a_record_that_was_broken_off_says_what_is_whole(tmp_path):
    tasks = frames(tmp_path, 3)
    run(tasks)
    record = tmp_path / RECORD
    record.write_bytes(record.read_bytes()[:-20])
    assert run(tasks) == Tally(written=1, kept=2)
    assert run(tasks) == Tally(kept=3)
    record.write_bytes(b"\xff{[\n[1]\n" + record.read_bytes())
    assert run(tasks) == Tally(kept=3)


def test_bad_input_fails_in_one_line_and_the_others_go_on(tmp_path):
    told = []
    assert run(frames(tmp_path, 6, bad), tell=told.append) == Tally(written=4, failed=2)
    assert [outcome.cause for outcome in told if outcome.state == "failed"] == [
        "parts.scene:1: no such colour",
        "parts.scene:4: no such colour",
    ]
    assert [outcome.warnings for outcome in told if outcome.warnings] == [("two faces dropped",)]
    assert sorted(contents(tmp_path)) == ["0000.svg", "0002.svg", "0003.svg", "0005.svg"]


def test_a_fault_of_the_program_stops_it_and_says_where(tmp_path):
    tasks = [*frames(tmp_path, 2), Task(str(tmp_path / "x.svg"), partial(divmod, 1, 0))]
    with pytest.raises(RuntimeError, match=r"x\.svg: Traceback[^$]*ZeroDivisionError"):
        run(tasks)
    assert len(contents(tmp_path)) == 2


@pytest.mark.parametrize("stop", [KeyboardInterrupt, SystemExit])
def test_a_stop_leaves_what_is_finished_and_no_half_file(stop, tmp_path):
    def stopping(outcome):
        if outcome.path.endswith("0002.svg"):
            raise stop

    with pytest.raises(stop):
        run(frames(tmp_path, 6), tell=stopping)
    assert sorted(os.listdir(tmp_path)) == [RECORD, "0000.svg", "0001.svg", "0002.svg"]
    assert run(frames(tmp_path, 6)) == Tally(written=3, kept=3)


def test_threads_give_the_same_bytes(tmp_path):
    run(frames(tmp_path / "a", 8))
    with ThreadPoolExecutor(2) as executor:
        assert run(frames(tmp_path / "b", 8), executor) == Tally(written=8)
    assert contents(tmp_path / "a") == contents(tmp_path / "b")


def test_tasks_are_taken_as_workers_become_free():
    taken, most = count(), []

    def endless():
        for number in taken:
            most.append(number)
            yield number, partial(int, number)

    with ThreadPoolExecutor(2) as executor:
        got = [key for key, _ in islice(answers(endless(), executor, 4), 50)]
    assert sorted(got)[:46] == list(range(46)) and len(most) <= 54


def test_a_lost_worker_is_made_good(tmp_path):
    executor = Losing(IN_COMPANY, 3)
    assert run(frames(tmp_path, 8), executor, window=4) == Tally(written=8)
    assert executor.begun.count(3) == IN_COMPANY + 1 and contents(tmp_path)["0003.svg"] == frame(3)


def test_what_kills_every_worker_fails_and_the_others_go_on(tmp_path):
    told = []
    executor = Losing(99, 3)
    assert run(frames(tmp_path, 8), executor, window=4, tell=told.append) == Tally(written=7, failed=1)
    assert [outcome.cause for outcome in told if outcome.cause] == [
        "its workers were lost: BrokenProcessPool: terminated abruptly"
    ]
    assert executor.begun.count(3) == IN_COMPANY + ALONE + 1


def test_who_was_there_at_many_losses_runs_alone():
    """Of calls that die together, each is tried by itself before it is given up."""
    begun, last = [], []

    class Together:
        def submit(self, fn):
            future: Future = Future()
            begun.append((fn.args[0], future))
            # Once three are under way, all are lost; one alone gets through.
            waiting = [one for one in begun if not one[1].done()]
            if len(waiting) == 3:
                for _, one in waiting:
                    one.set_exception(BrokenProcessPool())
            elif len(begun) > 3 * IN_COMPANY:
                last.append(len(waiting))
                future.set_result(fn())
            return future

    got = dict(answers(((number, partial(int, number)) for number in range(3)), Together(), 3))
    assert got == {0: 0, 1: 1, 2: 2} and last == [1, 1, 1]


def test_where_no_worker_survives_anything_it_ends():
    class Dead:
        def submit(self, fn):
            future: Future = Future()
            future.set_exception(BrokenProcessPool("no memory"))
            return future

    got = answers(((number, partial(int, number)) for number in count()), Dead(), 2)
    assert isinstance(next(got)[1], Lost)
    with pytest.raises(vp.InputError, match="no worker survives anything: BrokenProcessPool: no memory"):
        list(got)


def test_a_place_that_cannot_be_written_is_an_error_that_names_it(tmp_path):
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(OSError, match="file"):
        run(frames(tmp_path / "file", 1))


def test_results_come_in_their_order():
    assert results([partial(divmod, 9, number) for number in (4, 2, 5)]) == [(2, 1), (4, 1), (1, 4)]
    with pytest.warns(vp.InputWarning, match="two faces"), pytest.raises(vp.InputError, match="no such colour"):
        results([partial(bad, 2)]) and results([partial(bad, 1)])


def test_a_window_has_room():
    for call in (run, results):
        with pytest.raises(vp.InputError, match="a window of 0 tasks"):
            call([], window=0)


def test_fingerprints_tell_contents_apart(tmp_path):
    first, second = tmp_path / "a", tmp_path / "b"
    first.write_bytes(b"1")
    second.write_bytes(b"1")
    assert fingerprint("x", files=[first]) == fingerprint("x", files=[second]) != fingerprint("x")
    second.write_bytes(b"2")
    assert fingerprint("x", files=[first]) != fingerprint("x", files=[second])
