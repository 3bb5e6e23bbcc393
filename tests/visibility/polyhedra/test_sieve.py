"""Early rejection in the image, and the cells that things are entered in: nothing that hides may fall through."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.speed.measure import bars, boxes, weave
from vectorplot.visibility.polyhedra import grid as grids
from vectorplot.visibility.polyhedra import hidden_lines
from vectorplot.visibility.polyhedra.hidden_lines import Segments, clip_pairs, early_rejection, entered
from vectorplot.visibility.polyhedra.lines import edge_lines
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import project_faces

KINDS = frozenset({vp.LineKind.CONTOUR, vp.LineKind.CREASE})
TUBE = box((0.7, 5.0, 0.5), caps=())


def _moved(scene, scale, shift):
    shapes = [vp.Mesh(i.mesh.vertices * scale + shift, i.mesh.corners, i.mesh.offsets) for i in scene.items]
    return vp.Scene(tuple(vp.Item(i.name, shape) for i, shape in zip(scene.items, shapes, strict=True)))


def _tubes():
    shapes = [vp.Mesh(TUBE.vertices + np.array([k, 0.0, 0.3 * k]), TUBE.corners, TUBE.offsets) for k in range(8)]
    return vp.Scene(tuple(vp.Item(f"tube {k}", shape) for k, shape in enumerate(shapes)))


def _prepared(scene, camera):
    view = vp.scene.look(scene, camera)
    faces = project_faces(view)
    solid = solid_items(view, faces)
    lines = edge_lines(scene, view, faces, KINDS, 25.0, ~solid)
    segments = Segments(lines.start, lines.end)
    grid, pieces = hidden_lines._pieces(view, faces, segments)
    occluders = hidden_lines._occluders(view, faces, solid, grid, grids.deepest(grid, pieces))
    return view, segments, grid, pieces, occluders


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("scene", [bars(60), boxes(60), weave(100), _tubes(), _moved(bars(40), 1e-6, 1e3)])
def test_every_pair_that_clipping_keeps_is_found_in_a_cell_and_passes_the_sieve(scene, parallel):
    low, high = scene.bounds
    centre, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    camera = vp.Camera(tuple(centre + size * np.array([0.4, -0.5, 0.3])), target=tuple(centre), parallel=parallel)
    view, segments, grid, pieces, occluders = _prepared(scene, camera)
    piece, occluder = (part.ravel() for part in np.indices((len(pieces), len(occluders))))
    beyond = pieces.nearest[piece] > occluders.farthest[occluder]
    of, begin, end = pieces.segment[piece], pieces.low[piece], pieces.high[piece]
    hits = clip_pairs(view, segments, occluders, of, occluder, begin, end, beyond)
    tolerance = 1e-9 / np.linalg.norm(segments.end - segments.start, axis=0)[of[hits.pair]]
    real = hits.pair[(hits.high - hits.low > 100.0 * tolerance) & (pieces.farthest > 0.0)[piece[hits.pair]]]
    assert len(real) > 50
    assert np.isin(real, early_rejection(view, grid, pieces, occluders).passing(piece, occluder)).all()
    cells = int(grid.first[-1])
    for held in (np.zeros(cells, dtype=int), grids.held(grid, pieces), np.full(cells, 1 << 30)):
        entries = entered(view, grid, occluders, np.arange(len(occluders)), held)
        met = set()
        for level in range(grid.levels):
            at = grid.numbers(pieces.column >> level, pieces.row >> level, level)
            first, count = entries.of(at)
            entry = np.concatenate([np.arange(a, a + n) for a, n in zip(first, count, strict=True)])
            owner = np.repeat(np.arange(len(pieces)), count)
            met |= set((owner * len(occluders) + entries.thing[entry.astype(int)]).tolist())
        assert set((piece * len(occluders) + occluder)[real].tolist()) <= met


def test_a_long_thin_thing_is_entered_in_few_cells():
    """Across the picture, from corner to corner: in about as many cells as it is long, not in those of its box."""
    view, _, grid, _, occluders = _prepared(bars(300), vp.Camera((30.0, -20.0, 18.0), target=(5.0, 5.0, 5.0)))
    right, top = grid.left + grid.cell * int(grid.columns[0]), grid.bottom + grid.cell * int(grid.rows[0])
    fine = grids.Grid.over((grid.left, right, grid.bottom, top), grid.cell / 16.0)
    crowded = np.full(int(fine.first[-1]), 1 << 30)
    entries = entered(view, fine, occluders, np.arange(len(occluders)), crowded)
    _, column, _ = grids.touched(fine, occluders.box, np.zeros(len(occluders), dtype=int))
    assert len(entries.thing) < 0.06 * len(column)


def test_cells_hold_as_many_pieces_as_lie_in_them_on_every_level():
    _, _, grid, pieces, _ = _prepared(bars(60), vp.Camera((30.0, -20.0, 18.0), target=(5.0, 5.0, 5.0)))
    held = grids.held(grid, pieces)
    for level in range(grid.levels):
        cell = grid.numbers(pieces.column >> level, pieces.row >> level, level)
        inside = held[grid.first[level] : grid.first[level + 1]]
        assert (np.bincount(cell - grid.first[level], minlength=len(inside)) == inside).all()
        assert inside.sum() == len(pieces)
