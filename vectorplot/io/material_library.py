"""Colours of the faces of mesh files: the materials of MTL libraries, and red, green and blue."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError, InputWarning, printable
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.mesh_file import TextFile, shown, text_file
from vectorplot.scene.face_looks import FaceLook, FaceLooks
from vectorplot.scene.material import Material

if TYPE_CHECKING:
    from collections.abc import Sequence


MANY_COLOURS = 1 << 12
"""Files with more colours of faces than this have them rounded to FEW_STEPS of red, green and blue."""

FEW_STEPS = 15.0
"""So few steps of each are 4,096 colours in all."""


def looks_of_materials(
    path: Path, text: TextFile, mesh: Mesh, used: Sequence[tuple[str, int]], libraries: Sequence[tuple[str, int]]
) -> FaceLooks | None:
    """The looks of the faces of an OBJ file. used: names of materials, and the first face of each; libraries: names of
    files, and where the text names them.

    Warns: InputWarning, one, with file and line, for what gives no colours: libraries that are missing, cannot be read
    or lie elsewhere; materials that are in none.
    """
    if not used or not libraries:
        return None
    known: dict[str, FaceLook] = {}
    wrong: list[str] = []
    for name, position in libraries:
        try:
            known |= _library(path, name)
        except InputError as error:
            where = f"{text.name}:{text.line(position)}" if error.line is None else f"{error.file}:{error.line}"
            wrong.append(f"{where}: mtllib {printable(name)}: {error.cause}")
    if not wrong and (missing := [name for name, _ in used if name not in known]):
        wrong.append(f"{text.name}: material {printable(missing[0])} is in no library")
    if wrong:
        warnings.warn(f"{wrong[0]}; its faces have no colours of their own", InputWarning, stacklevel=3)
    names = list(known)
    number = {name: k for k, name in enumerate(names)}
    of_face = np.full(mesh.face_count, -1, dtype=np.intp)
    ends = [first for _, first in used[1:]] + [mesh.face_count]
    for (name, first), end in zip(used, ends, strict=True):
        of_face[first:end] = number.get(name, -1)
    return _only_used(mesh, [known[name] for name in names], of_face)


def _only_used(mesh: Mesh, looks: list[FaceLook], of_face: np.ndarray) -> FaceLooks | None:
    kept, of = np.unique(of_face, return_inverse=True)
    has = int(kept[0] >= 0) - 1 if len(kept) else 0
    own = tuple(looks[k] for k in kept.tolist() if k >= 0)
    return FaceLooks(mesh, own, of.ravel() + has) if own else None


def _library(path: Path, name: str) -> dict[str, FaceLook]:
    """The materials of a library. Errors: InputError for one outside of the folder of the file that names it."""
    folder = path.parent.resolve()
    try:
        place = (folder / name).resolve()
    except (OSError, ValueError):
        raise InputError("is not a file name") from None
    if not place.is_relative_to(folder):
        raise InputError("lies outside of the folder of this file")
    found: dict[str, FaceLook] = {}
    own, current = _Record(), None
    text = text_file(place)
    for number, line in enumerate(text.data.decode("utf-8", "replace").split("\n"), 1):
        words = line.partition("#")[0].split()
        if not words:
            continue
        try:
            if words[0] == "newmtl":
                own, current = _Record(), " ".join(words[1:])
            elif words[0] in ("Kd", "Ks") and len(words) == 4:
                shares = np.array([_number(word) for word in words[1:]])
                own = replace(own, matt=shares) if words[0] == "Kd" else replace(own, bright=shares)
            elif words[0] in ("d", "Tr", "Ns", "illum") and len(words) > 1:
                own = own.with_number(words[0], _number(words[-1]))
        except ValueError:
            raise InputError(f"{words[0]} needs numbers", file=shown(place), line=number) from None
        if current is not None:
            found[current] = own.look
    return found


WHOLE_HIGHLIGHT = 10.0
"""The highlight that alone fills a palette: a tenth of it counts."""

NO_HIGHLIGHT = (0, 1)
"""What illum says of materials whose Ks does not count."""

HALFWAY = 4.0
"""Ns is the exponent of the cosine of half of the angle between mirrored ray and eye, sharpness that of the whole:
for small angles cos(b/2)^(4s) is cos(b)^s."""


@dataclass(frozen=True)
class _Record:
    """What a library says of a material: matt (3,), its Kd; bright (3,), its Ks; sharpness, its Ns; opacity, its d; and
    illum. None: it is not said."""

    matt: Floats | None = None
    bright: Floats | None = None
    sharpness: float | None = None
    opacity: float = 1.0
    illum: float | None = None

    def with_number(self, word: str, value: float) -> _Record:
        """With what one of the words d, Tr, Ns and illum says."""
        if word == "Ns":
            return replace(self, sharpness=value)
        if word == "illum":
            return replace(self, illum=value)
        return replace(self, opacity=min(max(value if word == "d" else 1.0 - value, 0.0), 1.0))

    @property
    def look(self) -> FaceLook:
        """Its colour, that of Kd, and its material: Ks and Kd share the palette in proportion to their largest parts.

        Source: Ramey, Rose and Tyerman, MTL file format 4.2 (illum 2: Ks (H . N)^Ns); Glaeser, section 8.5.
        """
        colour = None if self.matt is None else hex_colour(self.matt)
        share = self._share_of_highlight
        if share == 0.0:
            return FaceLook(colour, Material("normal", self.opacity) if self.opacity < 1.0 else None)
        sharpness = None if self.sharpness is None else self.sharpness / HALFWAY
        highlight = WHOLE_HIGHLIGHT * share
        finish = Material("normal", self.opacity, diffuse=1.0 - share, highlight=highlight, sharpness=sharpness)
        return FaceLook(colour, finish)

    @property
    def _share_of_highlight(self) -> float:
        """How much of the palette is that of the highlight."""
        none = self.sharpness is not None and self.sharpness <= 0.0
        if self.bright is None or none or self.illum in NO_HIGHLIGHT:
            return 0.0
        matt, bright = (np.ones(1) if one is None else np.clip(one, 0.0, 1.0) for one in (self.matt, self.bright))
        total = float(matt.max() + bright.max())
        return float(bright.max()) / total if total > 0.0 else 0.0


def _number(word: str) -> float:
    """The number that a word says. Errors: ValueError for what is none, or is not finite."""
    value = float(word)
    if not np.isfinite(value):
        raise ValueError
    return value


def hex_colour(shares: Floats) -> str:
    """The colour #rrggbb of red, green and blue (3,) from 0 to 1. Errors: ValueError for what is no number."""
    if not np.isfinite(shares).all():
        raise ValueError
    red, green, blue = np.rint(255.0 * np.clip(shares, 0.0, 1.0)).astype(int).tolist()
    return f"#{red:02x}{green:02x}{blue:02x}"


def looks_of_colours(mesh: Mesh, shares: Floats) -> FaceLooks | None:
    """The looks of faces with red, green, blue and perhaps opacity (f,3 or 4) from 0 to 1; NaN: none of their own."""
    known = np.flatnonzero(np.isfinite(shares).all(axis=1))
    steps = np.rint(255.0 * np.clip(shares[known], 0.0, 1.0))
    rows, which = np.unique(steps, axis=0, return_inverse=True)
    if len(rows) > MANY_COLOURS:
        steps = np.rint(np.rint(steps * (FEW_STEPS / 255.0)) * (255.0 / FEW_STEPS))
        rows, which = np.unique(steps, axis=0, return_inverse=True)
    looks = []
    for row in rows:
        opaque = len(row) < 4 or row[3] == 255.0
        material = None if opaque else Material("normal", opacity=float(row[3]) / 255.0)
        looks.append(FaceLook(hex_colour(row[:3] / 255.0), material))
    of_face = np.full(mesh.face_count, -1, dtype=np.intp)
    of_face[known] = which.ravel()
    return FaceLooks(mesh, tuple(looks), of_face) if looks else None
