from __future__ import annotations

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.geometry import camera as lens


@pytest.mark.capability("G2.2-focal")
def test_table_of_focal_lengths():
    # Erratum G2-15: the book's own table is rounded down.
    height = {200: 6.867, 100: 13.686, 50: 26.991}
    diagonal = {400: 6.191, 200: 12.347, 100: 24.414, 50: 46.793, 35: 63.440, 28: 75.381, 24: 84.062}
    for mm, degrees in height.items():
        assert lens.field_of_vision_deg(mm) == pytest.approx(degrees, abs=5e-4)
        assert lens.field_of_vision_deg(mm) == pytest.approx(np.degrees(2 * np.arctan(12 / mm)), rel=1e-15)
    for mm, degrees in diagonal.items():
        assert lens.diagonal_field_of_vision_deg(mm) == pytest.approx(degrees, abs=1e-3)
        assert lens.focal_length_mm(lens.field_of_vision_deg(mm)) == pytest.approx(mm, rel=1e-14)


def test_impossible_lenses_are_refused():
    for mm in (0.0, -50.0, np.inf, np.nan):
        with pytest.raises(InputError):
            lens.field_of_vision_deg(mm)
    with pytest.raises(InputError):
        lens.focal_length_mm(180.0)


def test_advice_about_fields_of_vision():
    assert all(lens.lens_advice(fov) is None for fov in (10.0, 15.0, 27.0, 40.0, 60.0))
    assert "distorts" in lens.lens_advice(60.5) and "15 to 40" in lens.lens_advice(60.5)
    assert "telephoto" in lens.lens_advice(9.5)
