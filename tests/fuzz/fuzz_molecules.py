"""Files of molecules that are nearly right: xyz, pdb and cif, each written after its own grammar, then damaged."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

from fuzz.fuzz_words import HOSTILE, changed_bytes, number, one, repeated, whole

_SYMBOLS = ("C", "H", "N", "O", "Fe", "cl", "6", "X", "D", "Qq", "1", "999", "", "\x1b[31m", "é")
_RESIDUES = ("GLY", "HOH", "ALA", "LIG", "   ", "DOD")


def xyz_file(rng: Random) -> bytes:
    """A count, a comment, atoms; rarely a second frame."""
    count = rng.randrange(6)
    atoms = [" ".join([one(rng, _SYMBOLS), *(number(rng) for _ in range(3))]) for _ in range(count)]
    announced = str(count) if rng.random() < 0.9 else whole(rng, 0, 99, 0.5)
    return "\n".join([announced, "comment", *atoms, one(rng, ("", "\n", announced))]).encode("utf-8", "replace")


def pdb_file(rng: Random) -> bytes:
    """Models of atoms in columns, some of them with several places."""
    lines = ["HEADER    SOMETHING"]
    for model in range(rng.randrange(1, 3)):
        atoms = [_pdb_atom(rng, serial) for serial in range(rng.randrange(5))]
        lines += [f"MODEL     {model + 1:4d}", *atoms, "ENDMDL"]
    return "\n".join([*lines, "END"]).encode("utf-8", "replace")


def _pdb_atom(rng: Random, serial: int) -> str:
    record, symbol = one(rng, ("ATOM  ", "HETATM")), one(rng, _SYMBOLS)
    name = f"{symbol:<4.4}{one(rng, ' AB')}{one(rng, _RESIDUES)} A{serial:4d}"
    place = "".join(f"{rng.uniform(-50, 50):8.3f}" if rng.random() < 0.95 else f"{number(rng):>8.8}" for _ in "xyz")
    return f"{record}{serial:5d} {name}    {place}{1.0:6.2f}{0.0:6.2f}          {symbol:>2.2}"


def cif_file(rng: Random) -> bytes:
    """A table of atoms."""
    columns = ["group_PDB", "id", "type_symbol", "label_atom_id", "label_comp_id", "label_asym_id", "label_seq_id"]
    columns += ["Cartn_x", "Cartn_y", "Cartn_z", "auth_asym_id", "auth_seq_id", "pdbx_PDB_model_num"]
    names = [f"_atom_site.{name}" for name in columns if rng.random() < 0.98]
    rows = []
    for serial in range(rng.randrange(5)):
        symbol, residue = one(rng, ("C", "N", "O", "X")), one(rng, _RESIDUES).strip() or "."
        place = [number(rng) for _ in range(3)]
        rows.append(" ".join(["ATOM", str(serial), symbol, symbol, residue, "A", "1", *place, "A", "1", "1"]))
    return "\n".join(["data_x", "loop_", *names, *rows, ""]).encode("utf-8", "replace")


MOLECULES: dict[str, Callable[[Random], bytes]] = {"xyz": xyz_file, "pdb": pdb_file, "cif": cif_file}
"""Writers of nearly right files, by suffix."""

_PARTS = {
    "xyz": (b"1\n", b"C 0 0 0\n", b"\n", b" "),
    "pdb": (b"MODEL\n", b"ENDMDL\n", b"ATOM\n", b"\n"),
    "cif": (b"data_a\n", b"loop_\n", b"_a.b\n", b";\n", b"'", b"save_\n"),
}


def molecule_bytes(rng: Random, suffix: str) -> bytes:
    """A file of a format: nearly right, damaged, or one part of it again and again."""
    way = rng.random()
    if way < 0.02:
        return repeated(rng, [lambda _, part=part: part for part in _PARTS[suffix]], 20_000)
    data = MOLECULES[suffix](rng)
    if way < 0.05:
        return data.replace(b" ", one(rng, HOSTILE).encode() + b" ", 1)
    return changed_bytes(rng, data) if way < 0.4 else data
