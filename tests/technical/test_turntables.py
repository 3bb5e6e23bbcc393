"""Drawings from all around."""

from concurrent.futures import ThreadPoolExecutor

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.save import write


def test_workers_make_the_same_drawings():
    part = vp.Item("part", box((1.0, 2.0, 3.0)))
    with ThreadPoolExecutor(2) as executor:
        views = vp.turntable(part, 4, executor=executor)
    assert [write(view, "svg") for view in views] == [write(view, "svg") for view in vp.turntable(part, 4)]
