"""Several lights together: a factor to all of them, or one that is fitted to the brightest face."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.drawing.fills import FillKind
from vectorplot.geometry import box
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene import look
from vectorplot.shading import face_shades, palette, view_lights
from vectorplot.shading.illumination import DIRECT_SHARE
from vectorplot.shading.shaded_faces import exposed_scene

LIGHTS = (vp.Light((1, -2, 3), parallel=True, intensity=1.0), vp.Light((2, -2, 1), parallel=True, intensity=1.0))
CAMERA = vp.Camera((4.0, -6.0, 5.0))
CUBE = vp.Scene((vp.Item("CUBE", box((2, 2, 2)), "gray"),), LIGHTS)


def seen_shades(scene):
    """The shades of the cube's faces that the eye sees, without what comes of being near."""
    view = look(scene, CAMERA)
    lit, here = exposed_scene(view, scene)
    found = face_shades(view, lit.items, here)
    assert here == view_lights(view, lit.lights)
    normals = np.array([(-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1)])
    outward = scene.items[0].mesh.face_normals
    front = ((outward @ np.array(CAMERA.eye)) > 1.0) & (np.abs(outward @ normals.T).max(axis=1) > 0.0)
    assert front.sum() == 3
    return (found.total - found.cue)[front]


@pytest.mark.capability("G4.5-multilight")
def test_a_fitted_exposure_makes_the_brightest_seen_face_as_bright_as_lights_can():
    weak = replace(CUBE, lights=tuple(replace(one, intensity=0.1) for one in LIGHTS))
    bright, dark = seen_shades(CUBE), seen_shades(weak)
    assert (bright == DIRECT_SHARE).sum() == 2, "two faces are too bright, and look the same"
    assert dark.max() < 0.2
    for intensity in (1.0, 0.1, None):
        lights = tuple(replace(one, intensity=intensity) for one in LIGHTS)
        fitted = seen_shades(replace(CUBE, lights=lights, exposure="fitted"))
        assert fitted.max() == pytest.approx(DIRECT_SHARE) and len(set(fitted.round(6))) == 3
        assert fitted / fitted.max() == pytest.approx(dark / dark.max())


@pytest.mark.capability("G4.5-multilight")
def test_faces_that_are_not_seen_do_not_count():
    behind = replace(CUBE, lights=(vp.Light((0, 9, 1), parallel=True, intensity=1.0),), exposure="fitted")
    assert seen_shades(behind).max() == pytest.approx(DIRECT_SHARE)


def test_a_factor_is_taken_as_it_is_and_lights_without_intensities_keep_their_share():
    view = look(CUBE, CAMERA)
    shared = replace(CUBE, lights=tuple(replace(one, intensity=None) for one in LIGHTS), exposure=3.0)
    lit, here = exposed_scene(view, shared)
    assert [light.intensity for light in (*lit.lights, *here)] == pytest.approx([3.0 / np.sqrt(2.0)] * 4)
    assert exposed_scene(view, replace(shared, exposure=1.0))[0].lights == shared.lights
    dark = replace(CUBE, lights=(replace(LIGHTS[0], intensity=0.0),), exposure="fitted")
    assert exposed_scene(view, dark)[0].lights[0].intensity == 0.0
    without = exposed_scene(view, replace(CUBE, lights=(), exposure=0.5))
    assert without[0].lights == () and without[1][0].intensity == 0.5


@pytest.mark.capability("G4.5-multilight")
def test_paint_and_render_and_scene_files_understand_it_alike():
    written = write_scene(replace(CUBE, exposure="fitted"))
    assert "exposure fitted" in written and parse_scene(written).exposure == "fitted"
    assert parse_scene(write_scene(replace(CUBE, exposure=0.25))).exposure == 0.25
    said = {"lights": LIGHTS, "exposure": "fitted"}
    painted = vp.paint(replace(CUBE, lights=()), CAMERA, smooth=False, **said)
    other = vp.paint(parse_scene(written), CAMERA, smooth=False)
    (one,), (two,) = ([mark for mark in drawing.layers[0].marks] for drawing in (painted, other))
    assert (one.kind == int(FillKind.FACE)).sum() == 3 and len(np.unique(one.colours, axis=0)) == 3
    assert np.array_equal(one.colours, two.colours)
    plain = vp.paint(CUBE, CAMERA, smooth=False).layers[0].marks[0]
    assert not np.array_equal(plain.colours, one.colours)
    pixels = vp.render(CUBE, CAMERA, size=(60, 45), samples=1, exposure="fitted").pixels
    assert np.array_equal(pixels, vp.render(parse_scene(written), CAMERA, size=(60, 45), samples=1).pixels)
    top = palette("gray", 256)[:, 0].astype(int)
    brightest = pixels[(pixels != 255).any(axis=2)].max()
    assert DIRECT_SHARE <= np.searchsorted(top, brightest) / 255.0 <= 1.0


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.nan, np.inf, "bright"])
def test_what_is_no_exposure_is_told(wrong):
    with pytest.raises(vp.InputError, match="expected fitted, or a positive factor"):
        vp.paint(CUBE, exposure=wrong)


def test_the_command_and_files_tell_what_is_wrong(tmp_path, capsys):
    file = tmp_path / "a.scene"
    file.write_text(write_scene(replace(CUBE, camera=CAMERA)), encoding="utf-8")
    for verb, small in (("paint", ["--page", "40x30"]), ("render", ["--size", "40x30"])):
        out = tmp_path / "a.png"
        assert run([verb, str(file), "-o", str(out), "--exposure", "fitted", *small]) == 0
        assert run([verb, str(file), "-o", str(out), "--exposure", "0"]) == 2
        assert "exposure 0: expected fitted" in capsys.readouterr().err
    for text, told in (("exposure bright", "expected 'fitted' or a factor"), ("exposure -1", "positive factor")):
        with pytest.raises(vp.InputError, match=told):
            parse_scene(text)
