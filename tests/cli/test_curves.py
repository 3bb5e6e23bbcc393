"""What the command does with smooth curves."""

import json

import numpy as np
import pytest

from vectorplot.cli.main import run

RING = "page A5 landscape camera eye 8 -16 11 target 0 0 0 field_of_vision 26\n"
RING += "RING surface torus 3 1 parameter_lines 6 4\n"


def drawn(tmp_path, name, *options):
    (tmp_path / "ring.scene").write_text(RING, encoding="utf-8")
    assert run(["draw", str(tmp_path / "ring.scene"), "-o", str(tmp_path / name), "--quiet", *options]) == 0
    return (tmp_path / name).read_text(encoding="utf-8")


@pytest.mark.slow
def test_smooth_curves_leave_as_paths_or_as_polylines(tmp_path):
    curves = drawn(tmp_path, "a.svg")
    lines = drawn(tmp_path, "b.svg", "--curves", "polyline")
    assert "<path" in curves and "C" in curves and "A" in curves
    assert "<path" not in lines and "<polyline" in lines
    assert len(curves) < len(lines) / 3
    assert curves.count("<path") + curves.count("<poly") == lines.count("<poly")


@pytest.mark.slow
def test_json_holds_polylines_on_the_true_curve_either_way(tmp_path):
    curves = drawn(tmp_path, "a.json")
    assert curves == drawn(tmp_path, "b.json", "--curves", "polyline")
    points = np.concatenate([stroke["points3d"] for stroke in json.loads(curves)["strokes"]])
    assert np.abs((np.hypot(points[:, 0], points[:, 1]) - 3.0) ** 2 + points[:, 2] ** 2 - 1.0).max() < 1e-9


@pytest.mark.slow
def test_a_coarser_tolerance_makes_a_smaller_file(tmp_path):
    assert len(drawn(tmp_path, "a.svg", "--tolerance", "0.2")) < len(drawn(tmp_path, "b.svg", "--tolerance", "0.002"))


def test_an_unknown_kind_of_curves_is_bad_usage(tmp_path, capsys):
    assert run(["draw", "ring.scene", "-o", str(tmp_path / "a.svg"), "--curves", "wavy"]) == 2
    assert "wavy" in capsys.readouterr().err
