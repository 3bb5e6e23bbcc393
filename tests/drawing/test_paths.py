"""Paths of polylines of one's own."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.errors import InputError
from vectorplot.save import write


def test_polylines_become_paths_and_come_back():
    lines = [np.array([(1.0, 2.0), (3.0, 4.0), (5.0, 1.0)]), np.array([(0.0, 0.0), (9.0, 0.0)])]
    paths = vp.Paths.of_polylines(lines, closed=[True, False], kind=[vp.LineKind.CONTOUR, vp.LineKind.CURVE], item=1)
    assert len(paths) == 2 and paths.closed.tolist() == [True, False] and paths.item.tolist() == [1, 1]
    assert paths.kind.tolist() == [vp.LineKind.CONTOUR, vp.LineKind.CURVE] and paths.hidden_by.tolist() == [0, 0]
    for k, line in enumerate(lines):
        assert np.array_equal(paths.points[paths.offsets[k] : paths.offsets[k + 1]], line)
    assert np.array_equal(paths.points3d[:, :2], paths.points) and not paths.points3d[:, 2].any()
    svg = write(vp.Drawing(10.0, 10.0, (vp.Layer("own", vp.Pen(), (paths,)),)), "svg")
    assert b"<path" in svg or b"polyline" in svg


def test_a_repeated_first_point_closes_a_polyline():
    (paths,) = [vp.Paths.of_polylines([[(0, 0), (1, 0), (0, 1), (0, 0)]])]
    assert paths.closed.tolist() == [True] and paths.offsets.tolist() == [0, 3]
    # There and back again is no ring that loses a point and becomes one segment twice.
    assert vp.Paths.of_polylines([[(0, 0), (0, 0)]]).closed.tolist() == [False]


def test_no_polylines_are_empty_paths():
    paths = vp.Paths.of_polylines([])
    assert len(paths) == 0 and paths.points.shape == (0, 2) and paths.points3d.shape == (0, 3)


@pytest.mark.parametrize("bad", [[[(0, 0)]], [[(0, 0, 0), (1, 1, 1)]], [[(0, 0), (np.nan, 1)]], [[0, 1]]])
def test_what_is_no_polyline_is_an_error_with_its_number(bad):
    with pytest.raises(InputError, match="polyline 1: expected two or more points"):
        vp.Paths.of_polylines([[(0, 0), (1, 1)], *bad])


def test_entries_for_other_numbers_of_polylines_are_errors():
    with pytest.raises(InputError, match="one entry, or 1"):
        vp.Paths.of_polylines([[(0, 0), (1, 1)]], closed=[True, False])
