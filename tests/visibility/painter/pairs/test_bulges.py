"""Bodies that touch along curves do not come through one another, whatever the triangles in their place do."""

import numpy as np
import pytest
import shapely
from support.top_fills import fills_of, top_at

import vectorplot as vp
from vectorplot.io.scene_language import parse_scene

FROM_ABOVE = vp.Camera((7.0, 5.0, 3.5), (0.0, 0.0, 0.0))
PARALLEL = vp.Camera((5.0, -7.0, 2.0), (0.0, 0.0, 0.0), parallel=True)

INSIDE = {
    "ball in a pipe": ("cylinder 1 -2 2", ["sphere 1"]),
    "balls in a capped pipe": ("cylinder 1 -2 2 capped", ["sphere 1", "sphere 1 centre 0 0 0.9"]),
    "ball in a cone": ("cone slope 0.5 bottom -4 top 0 centre 0 0 2", ["sphere 0.894427190999916"]),
    "ball in a frustum": ("cone slope 0.5 bottom -4 top -1 centre 0 0 2 capped", ["sphere 0.894427190999916"]),
    "ellipsoid in a ball": ("sphere 1.5", ["ellipsoid 1.5 1.5 0.8"]),
    "balls in a torus": ("torus 3 1", ["sphere 1 centre 3 0 0", "sphere 1 centre 0 -3 0"]),
}


@pytest.mark.parametrize("name", list(INSIDE))
def test_what_touches_from_inside_is_not_seen(name):
    camera = PARALLEL if list(INSIDE).index(name) % 2 else FROM_ABOVE
    outer, inner = INSIDE[name]
    lines = [f"OUTER gray surface {outer}", *(f"IN{k} red surface {one}" for k, one in enumerate(inner))]
    drawing = vp.paint(parse_scene("\n".join(lines)), camera, page="80x80")
    fills = fills_of(drawing)
    places = np.random.default_rng(1).random((40000, 2)) * 80.0
    top = top_at(fills, places)
    seen = places[(top >= 0) & (fills.item[top] > 0)]
    # Outlines of both may be off by the tolerance.
    parts = [shapely.Polygon(part) for part in np.split(fills.points, fills.offsets[1:-1])]
    outline = shapely.union_all(shapely.make_valid(parts))
    assert shapely.contains_xy(outline.buffer(-0.1), seen).sum() <= 1
