import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.geometry.budget import USUAL, Block, budget_of, in_blocks, in_one_line, line_each, unresolved


def test_a_budget_is_so_many_times_the_usual_one() -> None:
    assert budget_of(1.0) == USUAL
    assert budget_of(4.0).pairs == 4 * USUAL.pairs and budget_of(4.0).cells == 4 * USUAL.cells
    assert budget_of(1e-30).points == 1 and budget_of(1e300).points == 2**62
    for wrong in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(InputError, match="a budget of"):
            budget_of(wrong)


def test_all_that_is_in_doubt_about_one_thing_is_one_line() -> None:
    line = in_one_line([unresolved("b"), "a", unresolved("c"), "a", unresolved("b")])
    assert line == f"a; {unresolved('b; c')}" and "--budget" in line
    assert in_one_line([]) == "" and in_one_line(["a"]) == "a"


def test_things_in_doubt_have_a_line_each() -> None:
    doubts = [("one: S", "a"), ("two", unresolved("b")), ("one: S", unresolved("c")), ("one: S", "a")]
    assert line_each(doubts) == (f"one: S: a; {unresolved('c')}", f"two: {unresolved('b')}")
    assert line_each([]) == ()


def test_blocks_hold_few_partners_and_end_with_the_budget() -> None:
    rows = np.arange(10_000)
    sizes: list[int] = []

    def look(some: np.ndarray) -> Block[np.ndarray]:
        sizes.append(len(some))
        return Block(some, 1000 * len(some), len(some))

    found, done = in_blocks(rows, 1 << 20, 1000, look)
    assert done == len(rows) and (np.concatenate(found) == rows).all()
    assert max(sizes) <= 262
    assert 300 < in_blocks(rows, 300, 1000, look)[1] < 600
    assert in_blocks(rows[:0], 300, 1000, look) == ([], 0)
