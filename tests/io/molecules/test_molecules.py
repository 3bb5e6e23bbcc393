"""Molecules: their files, their bonds, and what is drawn for them."""

from __future__ import annotations

import builtins
import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree
from support.paths import ROOT

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.curves import CubicSpline, spline_curve
from vectorplot.errors import InputError
from vectorplot.features.mesh_lines import face_triangles
from vectorplot.geometry import rotation_about
from vectorplot.geometry.mesh_repair import is_closed_oriented
from vectorplot.io import Molecule, molecule_scene, read_molecule
from vectorplot.io.molecules import bond_orders, bonds_between, elements_of
from vectorplot.save import write
from vectorplot.words import LineKind

WATER = "3\nwater\nO 0 0 0\nH 0.757 0.586 0\nH -0.757 0.586 0\n"


def atom(
    serial: int, name: str, residue: str, place: tuple[float, float, float], element: str, other: str = " "
) -> str:
    x, y, z = place
    kind = "HETATM" if residue in ("HOH", "LIG") else "ATOM  "
    return (
        f"{kind}{serial:5d} {name:<4}{other}{residue:>3} A{1 if residue != 'HOH' else 2:4d}    "
        f"{x:8.3f}{y:8.3f}{z:8.3f}{1.0:6.2f}{0.0:6.2f}          {element:>2}\n"
    )


GLYCINE = "".join(
    [
        "MODEL        1\n",
        atom(1, " N", "GLY", (0.0, 0.0, 0.0), "N"),
        atom(2, " CA", "GLY", (1.46, 0.0, 0.0), "C"),
        atom(3, " C", "GLY", (2.0, 1.42, 0.0), "C", "A"),
        atom(4, " C", "GLY", (2.0, 1.2, 0.4), "C", "B"),
        atom(5, " O", "GLY", (1.25, 2.4, 0.0), "O"),
        atom(6, " O", "HOH", (9.0, 9.0, 9.0), "O"),
        "ENDMDL\nMODEL        2\n",
        atom(1, " N", "GLY", (5.0, 0.0, 0.0), "N"),
        "ENDMDL\nEND\n",
    ]
)


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_caffeine_has_its_atoms_and_bonds():
    caffeine = read_molecule(ROOT / "data" / "caffeine.xyz")
    assert caffeine.name == "caffeine"
    degree = np.bincount(caffeine.bonds.ravel(), minlength=24)
    by_symbol = {s: sorted(degree[np.array(caffeine.symbols) == s].tolist()) for s in "CHNO"}
    assert by_symbol == {"H": [1] * 10, "O": [1, 1], "N": [2, 3, 3, 3], "C": [3] * 5 + [4] * 3}


@pytest.mark.parametrize("text", [WATER, WATER.replace("H", "h"), WATER.replace("H", "1").replace("O", "8", 1)])
@pytest.mark.parametrize("more", ["", "\n\n", "3\nagain\nO 1 1 1\nH 1 1 2\nH 2 1 1\n"])
def test_atoms_are_called_by_symbol_or_number_and_the_first_frame_counts(tmp_path, text, more):
    water = read_molecule(written(tmp_path, "water.xyz", text + more))
    assert water.symbols == ("O", "H", "H")
    assert water.bonds.tolist() == [[0, 1], [0, 2]]
    assert water.places[1].tolist() == [0.757, 0.586, 0.0]


def test_of_a_file_of_the_data_bank_the_first_model_counts_and_water_does_not(tmp_path):
    glycine = read_molecule(written(tmp_path, "gly.pdb", GLYCINE))
    assert glycine.symbols == ("N", "C", "C", "O")
    assert glycine.places[2].tolist() == [2.0, 1.42, 0.0]
    assert glycine.bonds.tolist() == [[0, 1], [1, 2], [2, 3]]


def test_a_file_with_nothing_but_water_shows_it(tmp_path):
    assert read_molecule(written(tmp_path, "ice.pdb", atom(1, " O", "HOH", (1.0, 2.0, 3.0), "O"))).symbols == ("O",)


def test_mmcif_is_read_as_pdb_is(tmp_path):
    import gemmi

    path = written(tmp_path, "gly.pdb", GLYCINE)
    text = gemmi.read_structure(str(path)).make_mmcif_document().as_string()
    other = read_molecule(written(tmp_path, "gly.cif", text))
    assert other.symbols == read_molecule(path).symbols
    assert np.allclose(other.places, read_molecule(path).places)


@pytest.mark.parametrize(
    ("name", "text", "line"),
    [
        ("a.xyz", "three\n", "a.xyz:1: expected the number of atoms, alone"),
        ("a.xyz", "3 4\n", "a.xyz:1: expected the number of atoms, alone"),
        ("a.xyz", "0\nnothing\n", "a.xyz: no atoms in this file"),
        ("a.xyz", "99999999\nmany\nC 0 0 0\n", "a.xyz: announces 99999999 atoms, but has only"),
        ("a.xyz", "2\nx\nC 0 0 0           \n", "a.xyz:3: the file ends after 1 of 2 atoms"),
        ("a.xyz", "1\nx\nC 0 0             \n", "a.xyz:3: expected a symbol and three coordinates, got 'C 0 0'"),
        ("a.xyz", "1\nx\nC 0 0 zero\n", "a.xyz:3: expected three coordinates, got '0 0 zero'"),
        ("a.xyz", "1\nx\nC 0 0 nan\n", "a.xyz:3: expected three coordinates, got '0 0 nan'"),
        ("a.xyz", "2\nx\nC 0 0 0\nC 1e300 0 0\n", "a.xyz: coordinates up to 1e+300 and an extent of"),
        ("a.xyz", "1\nx\nQq 0 0 0\n", "a.xyz:3: 'Qq' is no element"),
        ("a.xyz", "1\nx\n999 0 0 0\n", "a.xyz:3: '999' is no element"),
        ("a.cif", "#\n", "a.cif: no atoms in this file"),
        ("a.pdb", "HEADER    NOTHING\nEND\n", "a.pdb: no atoms in this file"),
        (
            "a.pdb",
            GLYCINE.replace("  1.420   0.000", "  1.42   0.0").replace("  1.200   0.400", "  1.2   0.4"),
            "a.pdb:4: expected three coordinates in columns 31-38, 39-46 and 47-54, got '2.000 1.42 0.0 1'; so in 5",
        ),
        ("a.cif", "data_x\n_cell.length_a 1\n", "a.cif: no atoms in this file"),
        ("a.cif", "loop_\n", "a.cif: no molecule: "),
    ],
)
def test_what_is_wrong_is_said_in_one_line(tmp_path, monkeypatch, name, text, line):
    written(tmp_path, name, text)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(vp.InputError) as caught:
        vp.read(name)
    assert str(caught.value).startswith(line)
    assert "\n" not in str(caught.value)


def test_atoms_in_one_place_are_no_molecule(tmp_path):
    crowd = "4000\ncrowd\n" + "C 0 0 0.0\n" * 4000
    with pytest.raises(vp.InputError, match=r"crowd\.xyz: the atoms lie too close for a molecule"):
        read_molecule(written(tmp_path, "crowd.xyz", crowd))


def test_without_the_library_one_line_says_what_to_install(tmp_path, monkeypatch):
    real = builtins.__import__

    def without(name, *rest, **more):
        if name == "gemmi":
            raise ImportError(name)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(vp.InputError, match=r"pip install '\.\[molecules\]'"):
        vp.read(written(tmp_path, "water.xyz", WATER))


def test_bonds_turn_with_the_molecule_and_go_by_distance():
    random = np.random.default_rng(3)
    caffeine = read_molecule(ROOT / "data" / "caffeine.xyz")
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    from vectorplot.io.molecules import bonds_between

    elements = elements_of(caffeine.symbols)
    assert np.array_equal(bonds_between(elements, caffeine.places @ turn + 1e3), caffeine.bonds)
    assert not len(bonds_between(elements, 3.0 * caffeine.places))


def test_balls_and_rods_are_named_after_their_atoms_and_touch():
    water = Molecule(
        "water", ("O", "H", "H"), np.array([(0, 0, 0), (0.9, 0, 0), (0, 0.9, 0)]), np.array([(0, 1), (0, 2)])
    )
    scene = molecule_scene(water)
    assert [item.name for item in scene.items] == ["O1", "H2", "H3", "O1_H2", "O1_H3"]
    assert [item.colour for item in scene.items] == ["red", "white", "white", "gray", "gray"]
    ball, stick = scene.items[0].shape, scene.items[3].shape
    u = np.linspace(0.0, 6.0, 7)
    rim = stick.points(u, np.full(7, stick.domain.v_start))
    assert (np.linalg.norm(rim, axis=1) < ball.radius).all()
    filled = molecule_scene(water, "space-filling")
    assert [item.shape.radius for item in filled.items] == [1.52, 1.2, 1.2]
    with pytest.raises(vp.InputError, match="expected ball-and-stick or space-filling"):
        molecule_scene(water, "ribbons")


@pytest.mark.slow
def test_every_verb_shows_a_molecule(tmp_path):
    path = written(tmp_path, "water.xyz", WATER)
    scene = vp.read(path)
    drawing = vp.draw(scene, vp.Camera((3, -4, 9)), page="60x60", tolerance_mm=0.5)
    assert {"contour", "intersection"} <= {layer.name for layer in drawing.layers}
    assert vp.paint(scene, vp.Camera((3, -4, 9)), page="40x40", tolerance_mm=0.5).layers
    assert vp.render(scene, vp.Camera((3, -4, 9)), size=(60, 40)).pixels.std() > 5.0


CRYSTAL = """data_x
_cell_length_a 5
_cell_length_b 6
_cell_length_c 7
_cell_angle_alpha 90
_cell_angle_beta 90
_cell_angle_gamma 90
loop_
_atom_site_label
_atom_site_type_symbol
_atom_site_fract_x
_atom_site_fract_y
_atom_site_fract_z
C1 C 0.1 0.2 0.3
O1 O 0.3 0.2 0.3
"""
LIGAND = """data_comp_XYZ
_chem_comp.id XYZ
loop_
_chem_comp_atom.comp_id
_chem_comp_atom.atom_id
_chem_comp_atom.type_symbol
_chem_comp_atom.model_Cartn_x
_chem_comp_atom.model_Cartn_y
_chem_comp_atom.model_Cartn_z
XYZ C1 C 0 0 0
XYZ O1 O 1.2 0 0
"""
NUMBERED = """ATOM      1  CA  THR     1      17.047  14.099   3.625  1.00 13.79      1CRN1070
HETATM    2 CA    CA     2      10.967  12.784   4.338  1.00 10.80      1CRN  71
"""


@pytest.mark.parametrize(
    ("name", "text", "symbols", "place"),
    [
        ("a.cif", CRYSTAL, ("C", "O"), (0.5, 1.2, 2.1)),
        ("a.cif", LIGAND, ("C", "O"), (0.0, 0.0, 0.0)),
        ("a.pdb", NUMBERED, ("C", "Ca"), (17.047, 14.099, 3.625)),
    ],
)
def test_crystals_ligands_and_files_with_numbered_lines_have_atoms(tmp_path, name, text, symbols, place):
    (tmp_path / name).write_text(text, encoding="utf-8")
    found = read_molecule(tmp_path / name)
    assert found.symbols == symbols
    assert np.allclose(found.places[0], place)


@pytest.mark.parametrize("off", [0.0, 1e-7, 1e-4])
def test_atoms_that_a_file_has_twice_are_drawn_once(off: float) -> None:
    """The cells of a lattice that overlap: every bond between two of them would lie on another one."""
    cube = np.array(list(np.ndindex(2, 2, 2))) @ rotation_about((1, 2, 3), 0.7) * 1.5
    again = cube[:4] + off * np.random.default_rng(5).normal(size=(4, 3))
    one, two = (carbons(places) for places in (cube, np.concatenate([cube, again])))
    assert [item.name for item in molecule_scene(two).items] == [item.name for item in molecule_scene(one).items]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert write(vp.draw(molecule_scene(two)), "svg") == write(vp.draw(molecule_scene(one)), "svg")


def test_of_bonds_on_one_line_the_shortest_are_drawn() -> None:
    row = np.array([(0.0, 0, 0), (1.5, 0, 0), (0.8, 0, 0), (3.0, 0, 0)]) @ rotation_about((3, 1, 2), 0.4)
    assert [item.name for item in molecule_scene(carbons(row)).items[4:]] == ["C1_C3", "C2_C3", "C2_C4"]


def test_of_atoms_in_one_place_the_largest_is_shown() -> None:
    places = np.array([(0.0, 0, 0), (1.4, 0, 0), (1.4, 0, 0), (1.4, 0, 0)])
    molecule = Molecule("mixed", ("C", "O", "S", "S"), places, np.array([(0, 1), (0, 2), (0, 3)]))
    assert [item.name for item in molecule_scene(molecule).items] == ["C1", "S3", "C1_S3"]


def carbons(places: np.ndarray) -> Molecule:
    symbols = ("C",) * len(places)
    return Molecule("carbons", symbols, places, bonds_between(elements_of(symbols), places))


# Double bonds, tubes and ribbons.


@pytest.mark.parametrize(
    ("symbols", "length", "order"),
    [
        *(("CC", 1.54, 1), ("CC", 1.39, 1), ("CC", 1.34, 2), ("CC", 1.20, 3), ("CO", 1.43, 1), ("CO", 1.22, 2)),
        *(("CN", 1.33, 1), ("CN", 1.28, 2), ("CN", 1.16, 3), ("SO", 1.43, 2), ("PO", 1.48, 2), ("CH", 1.0, 1)),
    ],
)
def test_orders_of_bonds_are_told_by_their_lengths(symbols, length, order):
    places = np.array([(0.0, 0.0, 0.0), (length, 0.0, 0.0)])
    elements = elements_of(tuple(symbols))
    assert bond_orders(elements, places, np.array([(0, 1)])).tolist() == [order]


def test_rods_of_a_double_bond_lie_side_by_side_in_the_plane_of_the_molecule():
    places = np.array([(0.0, 0.0, 0.0), (1.34, 0.0, 0.0), (-0.55, 0.93, 0.0), (1.9, 0.93, 0.0), (-0.55, -0.93, 0.0)])
    bonds = np.array([(0, 1), (0, 2), (0, 4), (1, 3)])
    ethene = Molecule("e", ("C", "C", "H", "H", "H"), places, bonds, np.array([2, 1, 1, 1]))
    rods = {item.name: item.shape for item in molecule_scene(ethene).items if "_" in item.name}
    assert set(rods) == {"C1_C2", "C1_C2_2", "C1_H3", "C1_H5", "C2_H4"}
    middle = [vp.Scene((vp.Item("rod", rods[name]),)).bounds.mean(axis=0) for name in ("C1_C2", "C1_C2_2")]
    np.testing.assert_allclose(np.mean(middle, axis=0), (0.67, 0.0, 0.0), atol=1e-9)
    np.testing.assert_allclose(np.abs(middle[1] - middle[0]), (0.0, 0.2, 0.0), atol=1e-9)


HELIX = np.stack(
    [
        2.3 * np.cos(np.radians(100.0 * np.arange(12))),
        2.3 * np.sin(np.radians(100.0 * np.arange(12))),
        1.5 * np.arange(12),
    ],
    axis=1,
)


@pytest.mark.parametrize(("style", "wide", "thick"), [("tube", 0.5, 0.5), ("ribbon", 1.2, 0.3)])
def test_a_band_has_its_section_about_the_spline_through_the_atoms(style, wide, thick):
    chain = Molecule("h", ("C",) * 12, HELIX, np.zeros((0, 2), dtype=int), chains=(np.arange(12),))
    (band,) = molecule_scene(chain, style).items
    mesh = band.mesh
    assert band.name == "chain_1" and is_closed_oriented(mesh)
    # The volume of what is swept by a section that is square to its way: area times length.
    spline = spline_curve(HELIX, CubicSpline())
    course = spline.points(np.linspace(spline.start, spline.end, 4001))
    length = np.linalg.norm(np.diff(course, axis=0), axis=1).sum()
    fans = mesh.vertices[face_triangles(mesh).triangles]
    volume = np.einsum("ij,ij->i", fans[:, 0], np.cross(fans[:, 1], fans[:, 2])).sum() / 6.0
    # Its corners are on an ellipse.
    assert 0.88 < volume / (np.pi * wide * thick * length) < 1.0
    far = cKDTree(course).query(mesh.vertices)[0]
    assert far.max() <= wide + 1e-3 and far.min() >= thick - 0.02


def test_chains_of_files_run_through_their_backbones_and_ligands_stay_atoms(tmp_path):
    rows = [
        f"ATOM  {2 * k + 1:5d}  CA  ALA A{k + 1:4d}    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00           C  \n"
        f"ATOM  {2 * k + 2:5d}  CB  ALA A{k + 1:4d}    {1.5 * x:8.3f}{1.5 * y:8.3f}{z:8.3f}  1.00  0.00           C  \n"
        for k, (x, y, z) in enumerate(HELIX.tolist())
    ]
    gap = rows[:6] + rows[8:]
    ligand = "HETATM   99 CA    CA A 200      20.000  20.000   5.000  1.00  0.00          CA  \n"
    (tmp_path / "h.pdb").write_text("".join(gap) + ligand)
    found = read_molecule(tmp_path / "h.pdb")
    assert [len(chain) for chain in found.chains] == [6, 4]
    assert found.of_chains.sum() == 20 and not found.of_chains[-1]
    names = [item.name for item in vp.read(tmp_path / "h.pdb", molecules="tube").items]
    assert names == ["Ca21", "chain_1", "chain_2"]
    out = tmp_path / "h.svg"
    assert run(["draw", str(tmp_path / "h.pdb"), "--molecules", "ribbon", "-o", str(out)]) == 0 and out.stat().st_size


def test_bands_have_the_lines_that_are_asked_for():
    chain = Molecule("h", ("C",) * 4, HELIX[:4], np.zeros((0, 2), dtype=int), chains=(np.arange(4),))
    scene = molecule_scene(chain, "ribbon")
    for asked, drawn in ((None, {"CONTOUR"}), (("crease",), {"CREASE"})):
        layers = vp.draw(scene, "iso", lines=asked, page="40x40").layers
        kinds = np.concatenate([paths.kind for layer in layers for paths in layer.strokes])
        assert {LineKind(kind).name for kind in kinds.tolist()} == drawn


def test_a_chain_of_two_atoms_and_a_straight_one_have_bands_and_none_is_an_error(tmp_path):
    for points in (HELIX[:2], np.outer(np.arange(5.0), (1.0, 2.0, 2.0))):
        chain = Molecule(
            "c", ("C",) * len(points), points, np.zeros((0, 2), dtype=int), chains=(np.arange(len(points)),)
        )
        assert is_closed_oriented(molecule_scene(chain, "ribbon").items[0].mesh)
    with pytest.raises(InputError, match="there is no chain for a tube"):
        vp.read("data/caffeine.xyz", molecules="tube")
    with pytest.raises(InputError, match="for molecules only"):
        vp.read("data/pencil.scene", molecules="tube")
