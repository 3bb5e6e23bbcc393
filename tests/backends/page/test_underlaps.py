"""Polygons that reach under those painted after them, and nowhere else."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from support.fill_samples import fan, flat, page_of, shaded

from vectorplot.backends.cairo.surfaces import pdf_bytes, ps_bytes
from vectorplot.backends.page.areas import areas
from vectorplot.backends.page.underlaps import grown, underlaps

DARK = (16, 20, 24)


def shapes(microns, offsets) -> list[shapely.Polygon]:
    return [shapely.Polygon(microns[a:b]) for a, b in pairwise(offsets)]


@pytest.mark.parametrize("seed", range(4))
def test_polygons_grow_only_under_later_ones(seed):
    random = np.random.default_rng(seed)
    triangles = np.array(fan((30, 20), 15, 40))[random.permutation(40)]
    found = areas(flat(list(triangles), [DARK] * 40), 60.0, 40.0)
    laps = underlaps(found.microns, found.offsets, found.solid, found.group)
    microns, offsets, parts = grown(found.microns, found.offsets, laps)
    before, after = shapes(found.microns, found.offsets), shapes(microns, offsets)
    rounding = 3.0
    for number in range(40):
        later = shapely.union_all(before[number:]).buffer(rounding)
        own = shapely.union_all(after[parts[number] : parts[number + 1]])
        assert later.contains(own)
        assert own.buffer(rounding).contains(before[number])
    assert len(laps.side) > 20 and len(laps.square) == 1, "the middle of the fan is inside"


def test_under_transparent_blank_and_concave_polygons_nothing_goes():
    left, right = [(0, 0), (10, 0), (10, 10), (0, 10)], [(10, 0), (20, 0), (20, 10), (10, 10)]
    arrow = [(10, 0), (20, 0), (12, 5), (20, 10), (10, 10)]
    for other, opacity in ((right, 0.5), (arrow, 1.0)):
        found = areas(flat([left, other], [DARK, DARK], opacity=[1.0, opacity]), 60.0, 40.0)
        laps = underlaps(found.microns, found.offsets, found.solid, found.group)
        assert not len(laps.side) and laps.open[0]
    found = areas(flat([left, right], [DARK, DARK]), 60.0, 40.0)
    assert underlaps(found.microns, found.offsets, found.solid, found.group).side.tolist() == [1]


def test_a_mesh_is_one_shading_of_triangles():
    triangles = fan((30, 20), 15, 200)
    colours = [[(k, k, k), (k + 40, k + 40, k + 40), (k, k, k)] for k in range(200)]
    drawing = page_of(shaded(list(triangles), colours))
    pdf, ps = pdf_bytes(drawing), ps_bytes(drawing)
    for data in (pdf, ps):
        assert data.count(b"/ShadingType 4") == 1 and b"/ShadingType 7" not in data
    assert len(pdf) < 20_000 and len(ps) < 40_000
    # The table of contents names where objects begin.
    table = int(pdf[pdf.rindex(b"startxref") + 9 :].split()[0])
    assert pdf[table : table + 4] == b"xref"
    entries = pdf[table:].split(b"\n")[3:]
    for number, entry in enumerate(entries, start=1):
        if not entry.endswith(b"n "):
            break
        assert pdf[int(entry[:10]) :].startswith(b"%d 0 obj" % number)
