"""Chunks of work on several threads."""

import threading
import time

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.geometry.budget import mapped, slices, threads, threads_of, workers

COUNTS = (1, 2, 5)


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("many", [0, 1, 2, 3, 40])
def test_results_come_in_the_order_of_the_chunks(count, many):
    def slow_at_first(chunk):
        time.sleep(0.002 * (chunk < 3))
        return chunk * chunk

    with threads(count):
        assert list(mapped(slow_at_first, range(many))) == [k * k for k in range(many)]


@pytest.mark.parametrize("count", COUNTS)
def test_chunks_are_asked_for_a_few_ahead_only(count):
    asked = []

    def chunks():
        for k in range(100):
            asked.append(k)
            yield k

    with threads(count):
        for result in mapped(lambda k: k, chunks()):
            assert len(asked) <= result + count + 2


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_what_a_chunk_raises_ends_the_work(count, error):
    done = []

    def work(k):
        if k == 3:
            raise error("three")
        done.append(k)
        return k

    found = []
    with threads(count), pytest.raises(error, match="three"):
        for result in mapped(work, range(100)):
            found.append(result)
    assert found == [0, 1, 2]
    assert len(done) <= 3 + 2 * count + 2


@pytest.mark.parametrize("count", COUNTS)
def test_an_interruption_between_results_leaves_the_rest_undone(count):
    done = []
    with threads(count), pytest.raises(KeyboardInterrupt):
        for result in mapped(done.append, range(1000)):
            assert result is None
            raise KeyboardInterrupt
    assert len(done) <= 2 * count + 2


@pytest.mark.slow
def test_several_threads_take_part_and_one_does_where_nothing_is_said():
    def where(_):
        time.sleep(0.005)
        return threading.get_ident()

    assert set(mapped(where, range(8))) == {threading.get_ident()}
    with threads(3):
        assert len(set(mapped(where, range(12)))) == 3
        with threads(None):
            assert len(set(mapped(where, range(12)))) == 3
    assert set(mapped(where, range(8))) == {threading.get_ident()}


def test_within_a_chunk_there_are_one_thread_and_idle_ones_and_what_was_said_of_errors():
    both = threading.Barrier(2)
    first_is_done = threading.Event()

    def inner(chunk):
        assert np.geterr()["over"] == "ignore"
        both.wait(60.0)
        alone = set(mapped(lambda _: threading.get_ident(), range(5)))
        both.wait(60.0)
        if chunk == 0:
            first_is_done.set()
            return alone, alone
        first_is_done.wait(60.0)
        deadline = time.monotonic() + 60.0
        while True:
            # As soon as the other chunk has been taken leave of, its thread helps.
            helped = set(mapped(lambda _: (time.sleep(0.002), threading.get_ident())[1], range(6)))
            if len(helped) > 1 or time.monotonic() > deadline:
                return alone, helped

    with threads(2), np.errstate(over="ignore"):
        (one, _), (other, helped) = mapped(inner, range(2))
    assert len(one) == len(other) == 1
    assert len(helped) == 2


def test_what_shares_its_work_itself_has_one_thread_for_few_things():
    assert workers(10**6) == 1
    with threads(3):
        assert (workers(10), workers(10**6)) == (1, 3)
        assert max(mapped(lambda _: workers(10**6), range(4))) <= 3


def test_slices_cover_everything_once():
    assert [list(range(10))[part] for part in slices(10, 4)] == [[0, 1, 2, 3], [4, 5, 6, 7], [8, 9]]
    assert slices(0, 4) == []


def test_jobs_are_threads_or_all_processors():
    assert threads_of(3) == 3
    assert threads_of(None) >= 1
    for jobs in (0, -1):
        with pytest.raises(InputError, match="expected 1 or more"):
            threads_of(jobs)
