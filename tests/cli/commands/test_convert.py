"""``vectorplot convert`` writes shapes for other programs."""

import pytest
from click.testing import CliRunner

import vectorplot as vp
from vectorplot.cli.verbs import vectorplot


@pytest.fixture
def two(tmp_path):
    path = tmp_path / "two.scene"
    path.write_text("A red box 2 2 2\nB red box 2 2 2 translation 1 0 0\n")
    return path


def run(*words):
    return CliRunner().invoke(vectorplot, ["convert", *map(str, words)], catch_exceptions=False)


def test_bodies_are_written_apart_or_as_one(two, tmp_path):
    out = tmp_path / "two.obj"
    assert run(two, "-o", out).exit_code == 0
    assert [item.name for item in vp.read(out).items] == ["A", "B"]
    assert run(two, "-o", out, "--union").exit_code == 0
    (item,) = vp.read(out).items
    assert item.mesh.is_closed and item.mesh.bounds.tolist() == [[0.0, 0.0, 0.0], [3.0, 2.0, 2.0]]


def test_a_scene_is_written_to_standard_output(two):
    result = run(two, "-o", "-", "--format", "scene")
    assert result.exit_code == 0 and result.stdout.count(" red ") == 2


def test_pictures_are_left_to_the_other_commands(two):
    result = CliRunner().invoke(vectorplot, ["convert", str(two), "-o", "two.svg"])
    assert result.exit_code == 2 and "must end in one of .stl, .obj, .ply, .off, .scene" in result.output


def test_a_picture_as_a_mesh_leads_to_convert(two):
    result = CliRunner().invoke(vectorplot, ["draw", str(two), "-o", "two.stl"])
    assert result.exit_code == 2 and "vectorplot convert writes shapes as meshes" in result.output
