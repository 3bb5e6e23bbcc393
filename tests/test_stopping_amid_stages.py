"""A verb stops amid its stages: what its progress raises ends the work, at the next place where it may stop."""

import time
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from support.rough import rough_sphere

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.geometry.budget import in_pieces, in_turn, mapped, may_stop, slices, stopping, threads
from vectorplot.pictures import pipeline
from vectorplot.surfaces import Sphere, Torus, implicit_of_function

LAMP = vp.Light((6.0, -9.0, 12.0))


class StopError(Exception):
    """The work is to stop."""


# Where work may stop.


def test_nobody_is_asked_where_nobody_said_so():
    may_stop()
    assert list(in_turn(range(3))) == [0, 1, 2]


def test_who_is_asked_is_the_innermost_and_only_within():
    asked = []
    with stopping(partial(asked.append, "outer")):
        may_stop()
        with stopping(partial(asked.append, "inner")):
            may_stop()
        may_stop()
    may_stop()
    assert asked == ["outer", "inner", "outer"]


def ask_after(times):
    """What raises when it is asked the next time after so many."""
    left = [times]

    def ask():
        left[0] -= 1
        if left[0] < 0:
            raise StopError

    return ask


@pytest.mark.parametrize("count", [1, 2, 5])
def test_mapped_work_stops_between_its_chunks(count):
    done = []
    with threads(count), stopping(ask_after(8)), pytest.raises(StopError):
        for _ in mapped(done.append, range(1000)):
            pass
    assert len(done) < 30


def test_a_chunk_on_another_thread_ends_where_it_may_stop_once_nobody_takes_it():
    began = time.monotonic()

    def long(chunk):
        for _ in in_turn(range(20_000)):
            time.sleep(0.01)

    with threads(2), stopping(ask_after(5)), pytest.raises(StopError):
        list(mapped(long, range(2)))
    assert time.monotonic() - began < 100.0


def test_pieces_are_put_together_and_the_work_may_stop_between_them():
    x, y = np.arange(10.0), np.arange(10.0)[::-1].copy()
    asked = []
    with stopping(partial(asked.append, 1)):
        assert in_pieces(np.multiply, 4, x, y).tolist() == (x * y).tolist()
    assert len(asked) == len(slices(10, 4))
    assert in_pieces(np.multiply, 100, x, y).tolist() == (x * y).tolist()
    assert in_pieces(np.multiply, 4, x[:0], y[:0]).tolist() == []


# Verbs.


def rough():
    return vp.Scene((vp.Item("rough", rough_sphere(4)), vp.Item("floor", box((8, 8, 0.2)).moved(0, 0, -2))), (LAMP,))


def balls():
    places = np.random.default_rng(0).uniform(-3.0, 3.0, (40, 3))
    return vp.Scene(tuple(vp.Item(f"b{k}", Sphere(0.7)).moved(*place) for k, place in enumerate(places)), (LAMP,))


def tori():
    return vp.Scene(tuple(vp.Item(f"t{k}", Torus(1, 0.4)).turned("x", 70 * k).moved(k / 2, 0, 0) for k in range(2)))


def implicit():
    return implicit_of_function(lambda x, y, z: x**4 + y**4 + z**4 - 1.0, [(-1.2,) * 3, (1.2,) * 3])


def glass():
    pane = vp.Item("pane", box((1, 0.2, 1.5)).moved(0, -2, 0), material=vp.Material("transparent", refraction=1.5))
    return vp.Scene((pane, vp.Item("box", box((2, 2, 2)).moved(0, 1, 0), "blue")), (LAMP,))


KINDS = {
    "hidden lines": (vp.draw, rough, {"hidden": "dashed"}, "counted lines"),
    "hatching": (vp.draw, rough, {"hatch": vp.Hatching("tone")}, "hatching"),
    "hatching along curvature": (vp.draw, rough, {"hatch": vp.Hatching("tone", along="curvature")}, "hatching"),
    "stippling": (vp.draw, rough, {"hatch": vp.Stippling(300)}, "hatching"),
    "intersections": (vp.draw, rough, {"lines": ("contour", "intersection")}, "intersections"),
    "smooth curves": (vp.draw, tori, {}, "curves"),
    "smooth surfaces": (vp.draw, tori, {}, "smooth surfaces"),
    "implicit": (vp.draw, implicit, {}, "curves"),
    "shadows": (vp.paint, rough, {}, "shadows"),
    "painter": (vp.paint, rough, {}, "order"),
    "fills": (vp.paint, rough, {}, "fills"),
    "visible fills": (vp.paint, rough, {"fills": "visible"}, "visible fills"),
    "facets": (vp.paint, tori, {}, "facets"),
    "bands": (vp.paint, balls, {}, "bands"),
    "glass": (vp.paint, glass, {}, "refraction"),
    "triangles": (vp.render, rough, {"size": (120, 90)}, "triangles"),
    "pixels": (vp.render, rough, {"size": (120, 90)}, "depth"),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_stages_ask_amid_their_work(kind, monkeypatch):
    """A stage tells once more how far it is before it ends, and what is raised there ends the work."""
    verb, scene, options, stage = KINDS[kind]
    monkeypatch.setattr(pipeline, "ASKED_S", 0.0)
    told = []

    def stop(name, fraction):
        told.append((name, fraction))
        if name == stage and told[-3:] == 3 * [(name, fraction)]:
            raise StopError

    with pytest.raises(StopError):
        verb(scene(), progress=stop, jobs=1, **options)
    fractions = [fraction for _, fraction in told]
    assert fractions == sorted(fractions) and fractions[-1] < 1.0


def test_a_listener_is_not_asked_all_the_time():
    told = []
    vp.draw(replace(rough(), lights=()), progress=lambda name, fraction: told.append((name, fraction)))
    assert len(told) < 200


def test_a_stop_leaves_nobody_asked_behind():
    def stop(name, fraction):
        raise StopError

    with pytest.raises(StopError):
        vp.draw(box((1, 1, 1)), progress=stop)
    may_stop()
    assert len(vp.draw(box((1, 1, 1))).layers) > 0


def test_what_is_no_listener_is_told_as_before():
    with pytest.raises(vp.InputError, match="progress"):
        vp.draw(box((1, 1, 1)), progress=7)


def test_a_film_is_stopped_amid_a_frame(tmp_path, monkeypatch):
    monkeypatch.setattr(pipeline, "ASKED_S", 0.0)
    heard = []

    def stop(name, fraction):
        heard.append((name, fraction))
        if heard[-3:] == 3 * [("frames", 0.5)]:
            raise StopError

    ball = vp.Item("ball", rough_sphere(3))
    film = vp.animate(vp.Animation(lambda time: ball.turned("z", 90 * time), frames=2), page="60x40")
    with pytest.raises(StopError):
        film.save(tmp_path / "film.svg", progress=stop)
    assert not list(tmp_path.iterdir())
