"""Terrains in bands of colours, and the light of maps."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.scene.terrains import hill_light, terrain_mesh, tinted
from vectorplot.surfaces.terrains import terrain


def hills(count=25):
    x, y = np.meshgrid(np.linspace(0, 6, count), np.linspace(0, 4, count), indexing="ij")
    return terrain_mesh(terrain(np.round(2 * np.sin(x) * np.cos(y), 1), (0, 6), (0, 4)))


def area(mesh):
    fans, of = ragged.fans(mesh.offsets)
    a, b, c = np.moveaxis(mesh.vertices[mesh.corners[fans]], 1, 0)
    return np.bincount(of, 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1))


@pytest.mark.parametrize("heights", [[0.0], [-1.5, 0.1, 0.5, 1.9], [-0.05, 0.0, 0.05], [9.0], [-9.0], []])
def test_bands_are_the_terrain_and_nothing_else(heights):
    mesh = hills()
    bands = tinted("HILLS", mesh, heights)
    assert np.isclose(sum(area(band.shape).sum() for band in bands), area(mesh).sum(), rtol=1e-12)
    ends = np.concatenate([[-np.inf], heights, [np.inf]])
    for band in bands:
        number = int(band.name.removeprefix("HILLS"))
        z = band.shape.vertices[:, 2]
        assert (z >= ends[number - 1]).all()
        assert (z <= ends[number]).all()
        assert (band.shape.face_normals[:, 2] > 0).all()
        assert area(band.shape).min() > 0


@pytest.mark.slow
def test_every_verb_shows_them_in_their_colours():
    scene = vp.Scene(tinted("HILLS", hills(13), [0.0], ["#204080", "#f0f0f0"]), (hill_light(),))
    camera = vp.Camera((3, 2, 20), (3, 2, 0), up=(0, 1, 0), parallel=True)
    assert sum(len(layer.marks) for layer in vp.draw(scene, camera).layers) > 0
    assert len(vp.paint(scene, camera).layers) > 0
    pixels = np.asarray(vp.render(scene, camera, size=(60, 40)).pixels, dtype=float)
    blue = pixels[..., 2] - pixels[..., 0]
    assert blue.max() > 0.1 * pixels.max()
    assert (np.abs(blue) < 0.02 * pixels.max()).mean() > 0.2


def test_the_light_of_maps_comes_from_the_north_west():
    assert np.allclose(hill_light().position, (-0.5, 0.5, np.sqrt(0.5)))
    assert np.allclose(hill_light(90, 0.5).position, (1, 0, 0), atol=1e-2)
    for altitude in (0, 91, np.nan):
        with pytest.raises(InputError):
            hill_light(0, altitude)
    for heights, colours in (([np.nan], ["#ffffff"]), (range(100), ["#ffffff"]), ([1], []), ([1], ["white"])):
        with pytest.raises(InputError):
            tinted("HILLS", hills(4), heights, colours)
