import math

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.scene.surface_lines import MAX_LINES, NO_LINES, Section, SurfaceLines, even_cosines


def test_nothing_is_drawn_unless_it_is_asked_for():
    assert not NO_LINES and not SurfaceLines(light=2)
    for lines in (SurfaceLines(columns=1), SurfaceLines(rows=1), SurfaceLines(isophotes=(0.0,))):
        assert lines
    assert SurfaceLines(sections=(Section((0, 0, 1), (0.0,)),))


def test_nine_isophotes_lie_evenly_between_minus_one_and_one():
    assert np.allclose(even_cosines(9), np.arange(-4, 5) / 5.0, atol=1e-15)
    assert even_cosines(1) == (0.0,)


@pytest.mark.parametrize("size", [1e-200, 1.0, 1e200])
def test_normals_of_any_length_become_unit_vectors(size):
    assert np.allclose(Section((3 * size, 0, -4 * size), (1.0,)).normal, (0.6, 0, -0.8), atol=1e-15)


def test_a_unit_vector_stays_what_it_is():
    normal = Section((1.0, 1.0, 1.0), ()).normal
    assert Section(normal, ()).normal == normal


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: SurfaceLines(columns=-1), "-1 columns"),
        (lambda: SurfaceLines(rows=MAX_LINES + 1), "rows, expected a whole number from 0 to 10000"),
        (lambda: SurfaceLines(rows=math.nan), "nan rows"),
        (lambda: SurfaceLines(columns=2.5), "2.5 columns"),
        (lambda: SurfaceLines(isophotes=(1.5,)), "1.5 is no cosine"),
        (lambda: SurfaceLines(isophotes=(math.nan,)), "finite"),
        (lambda: SurfaceLines(isophotes=("x",)), "expected numbers"),
        (lambda: SurfaceLines(isophotes=(0.0,) * (MAX_LINES + 1)), "at most 10000"),
        (lambda: SurfaceLines(light=-1), "no light -1"),
        (lambda: Section((0, 0, 0), (1.0,)), "normal"),
        (lambda: Section((0, math.inf, 0), (1.0,)), "normal"),
        (lambda: Section((0, 1), (1.0,)), "normal"),
        (lambda: Section((0, 0, 1), (math.inf,)), "finite"),
        (lambda: even_cosines(0), "expected 1 to 10000"),
        (lambda: even_cosines(10**9), "expected 1 to 10000"),
    ],
)
@pytest.mark.hard(68)
def test_wild_numbers_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_lines_asked_for_several_times_count_once() -> None:
    up, down = Section((0, 0, 1), (1, 2, 1)), Section((0, 0, -2), (-1, -3))
    assert up.offsets == (1.0, 2.0)
    lines = SurfaceLines(
        isophotes=(0.5, 0.0, 0.5), sections=(up, up, down, Section((0, 0, 1), (2,)), Section((1, 0, 0), (2,)))
    )
    assert lines.isophotes == (0.5, 0.0)
    assert lines.sections == (up, Section((0, 0, -1), (-3,)), Section((1, 0, 0), (2,)))
    # The planes between slices stay: they cut the shape too.
    sliced = Section((0, 0, 1), (2,), slices=True)
    assert SurfaceLines(sections=(up, sliced)).slices == sliced
    assert SurfaceLines(sections=tuple(Section((0, 1, 0), (0.1,)) for _ in range(500))).sections == (
        Section((0, 1, 0), (0.1,)),
    )
