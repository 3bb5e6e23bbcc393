"""The pools of scenes: every point, edge and face once, found by index, whatever is added behind them."""

import numpy as np
import pytest
from support.hard_shapes import HARD_SHAPES
from support.paths import DATA

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.geometry.winding import mesh_edges
from vectorplot.io.read_file import read
from vectorplot.scene.view import pools
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.shapes import box
from vectorplot.textbook.polyhedra import body_record

FILES = sorted(DATA.glob("*.scene"))


@pytest.mark.capability("G3.1-pools")
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_total_counts_are_the_sums_over_the_items(path, capsys):
    scene = read(path)
    pool = pools(scene)
    whole = [item.mesh for item in scene.items if item.mesh.present is None]
    records = [body_record(mesh) for mesh in whole]
    at = [k for k, item in enumerate(scene.items) if item.mesh.present is None]
    for offsets, counted in (
        (pool.item_vertices, [record.vertex_count for record in records]),
        (pool.item_edges, [record.edge_count for record in records]),
        (pool.item_faces, [record.face_count for record in records]),
    ):
        assert np.diff(offsets)[at].tolist() == counted
    assert pool.item_vertices[-1] == len(pool.points)
    assert pool.item_edges[-1] == len(pool.edges)
    assert pool.item_faces[-1] == len(pool.offsets) - 1 == len(pool.face_item)
    assert run(["info", str(path)]) == 0
    *_, total = capsys.readouterr().out.splitlines()
    reports = [body_record(item.mesh) for item in scene.items]
    for count, word in ((len(reports), "item"), (len(scene.lights), "light")):
        assert f"{count} {word}" in total
    assert f"{sum(r.vertex_count for r in reports)} vertices" in total
    assert f"{sum(r.edge_count for r in reports)} edges" in total
    assert f"{sum(r.face_count for r in reports)} faces" in total


@pytest.mark.capability("G3.1-pools")
@pytest.mark.parametrize("name", sorted(HARD_SHAPES))
def test_edges_of_the_pool_are_pairs_of_points_of_their_items(name):
    scene = HARD_SHAPES[name]
    pool = pools(scene)
    for k, item in enumerate(scene.items):
        own = pool.edges[pool.item_edges[k] : pool.item_edges[k + 1]]
        present = item.mesh if item.mesh.present is None else None
        assert ((own >= pool.item_vertices[k]) & (own < pool.item_vertices[k + 1])).all()
        if present is not None:
            assert np.array_equal(own - pool.item_vertices[k], mesh_edges(present))


@pytest.mark.capability("G3.1-pools")
def test_pools_that_grow_or_shrink_leave_what_was_there_where_it_was():
    items = [vp.Item(f"BOX{k}", box((k, 0, 0), (k + 0.5, 1, 1))) for k in range(5)]
    items.insert(2, vp.Item("RING", Torus(3, 1)))
    whole = pools(vp.Scene(tuple(items)))
    for count in range(len(items) + 1):
        some = pools(vp.Scene(tuple(items[:count])))
        for name in ("points", "corners", "offsets", "face_item", "item_vertices", "edges", "item_edges", "item_faces"):
            column = getattr(some, name)
            assert np.array_equal(getattr(whole, name)[: len(column)], column), name


@pytest.mark.capability("G3.1-pools")
@pytest.mark.parametrize(
    ("text", "limit"),
    [
        ("A revolution meridian 1 0 0, 1 0 1 order 100001", "100000"),
        ("A revolution meridian 1 0 0, 1 0 1 order 1000000000000", "100000"),
    ],
)
def test_limits_of_pools_are_reported(text, limit, tmp_path, capsys):
    path = tmp_path / "large.scene"
    path.write_text(text, encoding="utf-8")
    assert run(["info", str(path)]) == 1
    told = capsys.readouterr().err
    assert told.count("\n") == 1 and limit in told.replace(",", "") and "A" in told


@pytest.mark.hard(55)
def test_pools_of_nothing_are_empty():
    pool = pools(vp.Scene(()))
    assert not len(pool.points) and not len(pool.edges) and pool.offsets.tolist() == [0]
