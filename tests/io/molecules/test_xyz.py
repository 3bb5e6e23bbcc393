"""Columns of xyz files."""

from __future__ import annotations

import pytest

from vectorplot.errors import InputError
from vectorplot.io.molecules import read_xyz


@pytest.mark.parametrize(
    ("properties", "row"),
    [
        ("", "{0} {1} {2} {3} 0.5 H"),
        ("Properties=species:S:1:pos:R:3", "{0} {1} {2} {3}"),
        ('Lattice="9 0 0 0 9 0 0 0 9" Properties=species:S:1:mass:R:1:pos:R:3 pbc="T T T"', "{0} 12.0 {1} {2} {3}"),
        ("Properties=pos:R:3:species:S:1", "{1} {2} {3} {0}"),
        ('properties="forces:R:3:Z:I:1:pos:R:3" energy=-1', "9 9 9 {0} {1} {2} {3}"),
    ],
)
def test_columns_stand_where_the_comment_says(tmp_path, properties, row):
    atoms = [("6", 0.0, 0.25, -1.5), ("8", 1.0, 2.0, 3.0)]
    lines = ["2", properties, *(row.format(*atom) for atom in atoms)]
    (tmp_path / "x.xyz").write_text("\n".join(lines), encoding="utf-8")
    symbols, places = read_xyz(tmp_path / "x.xyz")
    assert symbols == ("C", "O")
    assert places.tolist() == [list(atom[1:]) for atom in atoms]


@pytest.mark.parametrize("properties", ["species:S:1:pos:R", "species:S:1", "pos:R:3", "species:S:1:pos:R:2", "a:b:c"])
def test_properties_without_a_place_or_a_symbol_are_named(tmp_path, properties):
    (tmp_path / "x.xyz").write_text(f"1\nProperties={properties}\nC 0 0 0 0 0\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"x.xyz:2: .*Properties"):
        read_xyz(tmp_path / "x.xyz")
