"""Many lamps: what each costs does not grow with the others, nor with the maps that do not show a place."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.errors import InputWarning
from vectorplot.geometry.solids import box
from vectorplot.scene.light import Light
from vectorplot.shading import scene_pixels
from vectorplot.shading import shadow_maps as shadow_buffer
from vectorplot.shading import shadow_maps as shadow_map
from vectorplot.shading.map_settings import MapSettings

FLOOR = vp.Item("FLOOR", box((8, 8, 0.5)))


def scattered(count):
    """So many weak lamps around the floor, near enough to need six maps each."""
    places = np.random.default_rng(1).uniform(0.0, 8.0, (count, 2))
    return tuple(Light(position=(x, y, 1.0), intensity=1.0 / count) for x, y in places.tolist())


def test_of_six_maps_around_a_lamp_one_looks_up_each_place(monkeypatch):
    asked = []
    real = shadow_map.slopes

    def counted(system, points, normals):
        asked.append(len(points))
        return real(system, points, normals)

    monkeypatch.setattr(shadow_map, "slopes", counted)
    (lamp,) = scattered(1)
    corners = FLOOR.shape.vertices
    places = np.random.default_rng(2).uniform(0.0, 8.0, (5000, 3)) * (1.0, 1.0, 1.0 / 16.0)
    buffer = shadow_buffer.shadow_buffer(lamp, corners, np.array([[0, 1, 2]]), size=64)
    assert len(buffer.maps) == 6
    buffer.blocks(places, np.tile([0.0, 0.0, 1.0], (len(places), 1)))
    assert len(places) <= sum(asked) < 1.2 * len(places)


def test_only_what_turns_to_a_lamp_is_looked_for_in_its_shadow(monkeypatch):
    """The sides of a box that turn away from the sun are dark without a map."""
    asked = []
    real = shadow_map.blocked

    def counted(found, points, normals):
        asked.append(len(points))
        return real(found, points, normals)

    monkeypatch.setattr(shadow_buffer, "blocked", counted)
    sun = (Light(position=(0.0, 1.0, 0.0), parallel=True),)
    camera = vp.Camera(eye=(0.0, -40.0, 0.0), target=(4.0, 4.0, 0.0))
    vp.render(vp.Scene((FLOOR,), sun), camera, size=(40, 30), shadows="buffer")
    assert sum(asked) == 0


def test_the_maps_of_many_lights_have_room(monkeypatch):
    """What they hold together is bounded; that they are coarser is said."""
    monkeypatch.setattr(shadow_buffer, "MOST_TEXELS", 1 << 16)
    points, corners = FLOOR.shape.vertices, np.array([[0, 1, 2]])
    made = []
    real = shadow_buffer.shadow_buffer

    def kept(*arguments, **options):
        made.append(real(*arguments, **options))
        return made[-1]

    monkeypatch.setattr(shadow_buffer, "shadow_buffer", kept)
    with pytest.warns(InputWarning, match="the shadow maps of 8 lights are 73 texels wide, not 128"):
        shadow_buffer.shadow_buffers(scattered(8), points, corners, MapSettings(size=128), None)
    texels = sum(one.code.size for buffer in made for one in buffer.maps)
    assert 0.9 * (1 << 16) < texels <= 1 << 16
    assert not any("depth" in vars(one) for buffer in made for one in buffer.maps)


def test_points_that_are_shaded_together_are_fewer_with_more_lights(monkeypatch):
    together = []
    real = scene_pixels.shaded_points

    def counted(triangles, found, lighting):
        together.append(len(found) * len(lighting.lights))
        return real(triangles, found, lighting)

    monkeypatch.setattr(scene_pixels, "shaded_points", counted)
    monkeypatch.setattr(scene_pixels, "SHARES_AT_ONCE", 2000)
    vp.render(vp.Scene((FLOOR,), scattered(16)), size=(40, 30), shadows="none", samples=1)
    assert len(together) > 5 and 0 < max(together) <= 2000
