"""Files and standard input -> scenes, by suffix and first bytes; kinds that are not read, and what reads them."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from vectorplot.errors import InputError
from vectorplot.io.mesh_file import check_file, shown
from vectorplot.io.named_files import CAD_SUFFIXES, NO_PARTS, data_file_or_name
from vectorplot.io.read_mesh import MESH_SUFFIXES, mesh_scene
from vectorplot.scene.scene import Scene

# Kinds of files that are not read, by their suffixes and their first bytes: what they are, and what to do instead.

_EXPORT_MESH = "export it as stl, obj, ply, off or glb"
_NO_SHAPES = "it holds no shapes in space"

_SUFFIXES = {
    ".fcstd": ("a FreeCAD document", "export it as step, stl, obj, ply, off or glb"),
    ".scad": ("an OpenSCAD program", "export it from OpenSCAD as stl or off"),
    ".dxf": ("a DXF drawing", _EXPORT_MESH),
    ".dwg": ("a DWG drawing", _EXPORT_MESH),
    ".gltf": ("a glTF text with its data beside it", "save it as one glb file"),
    ".3mf": ("a 3MF package", _EXPORT_MESH),
    ".amf": ("an AMF file", _EXPORT_MESH),
    ".3ds": ("a 3DS file", _EXPORT_MESH),
    ".fbx": ("an FBX file", _EXPORT_MESH),
    ".dae": ("a COLLADA file", _EXPORT_MESH),
    ".blend": ("a Blender file", _EXPORT_MESH),
    ".x3d": ("an X3D file", _EXPORT_MESH),
    ".wrl": ("a VRML file", _EXPORT_MESH),
    ".vtp": ("a VTK file", _EXPORT_MESH),
    ".msh": ("a Gmsh mesh", _EXPORT_MESH),
    ".usd": ("a USD file", _EXPORT_MESH),
    ".usda": ("a USD file", _EXPORT_MESH),
    ".usdc": ("a USD file", _EXPORT_MESH),
    ".usdz": ("a USD package", _EXPORT_MESH),
    ".ifc": ("an IFC model", _EXPORT_MESH),
    ".zip": ("a zip archive", "unpack it first"),
    ".gz": ("a gzip archive", "unpack it first"),
    ".svg": ("an SVG picture", _NO_SHAPES),
    ".pdf": ("a PDF document", _NO_SHAPES),
    ".ps": ("a PostScript file", _NO_SHAPES),
    ".eps": ("a PostScript file", _NO_SHAPES),
    ".png": ("a PNG picture", _NO_SHAPES),
    ".jpg": ("a JPEG picture", _NO_SHAPES),
    ".anim": ("an animation, not a scene", "animate SCENE -a FILE moves a scene by it"),
    ".vd1": ("a film", "replay shows it"),
    ".vd2": ("a film", "replay shows it"),
    ".py": ("a Python program", "run it with python"),
}

_BEGINNINGS = (
    (b"ISO-10303-21", "a STEP file", "give its name the suffix .step"),
    (b"PK\x03\x04", "a zip archive", "unpack it first, or export a mesh"),
    (b"\x1f\x8b", *_SUFFIXES[".gz"]),
    (b"%PDF", *_SUFFIXES[".pdf"]),
    (b"%!PS", *_SUFFIXES[".ps"]),
    (b"\x89PNG", *_SUFFIXES[".png"]),
    (b"\xff\xd8\xff", *_SUFFIXES[".jpg"]),
    (b"BLENDER", *_SUFFIXES[".blend"]),
    (b"glTF", "a glb file", "give its name the suffix .glb"),
    (b"ply\n", "a PLY file", "give its name the suffix .ply"),
    (b"ply\r", "a PLY file", "give its name the suffix .ply"),
    (b"OFF\n", "an OFF file", "give its name the suffix .off"),
    (b"OFF\r", "an OFF file", "give its name the suffix .off"),
    (b"Kaydara FBX", *_SUFFIXES[".fbx"]),
    (b"#VRML", *_SUFFIXES[".wrl"]),
    (b"# vtk", "a VTK file", "give its name the suffix .vtk"),
    (b"<", "an XML file", "it is neither a scene nor a mesh"),
    (b"{", "a JSON file", "it is neither a scene nor a mesh"),
)


def unsupported_kind(path: Path, head: bytes) -> str | None:
    """What a file is that is neither a scene nor a mesh, and what to do with it; None for what may be a scene.

    head: the first bytes of the file.
    """
    by_suffix = _SUFFIXES.get(path.suffix.lower())
    start = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    found = by_suffix or next(((what, help_) for first, what, help_ in _BEGINNINGS if start.startswith(first)), None)
    if found is None:
        return "a binary file, neither a scene nor a mesh" if b"\0" in head else None
    return f"{found[0]}, which is not read; {found[1]}"


MOLECULE_SUFFIXES = (".xyz", ".pdb", ".ent", ".cif", ".mmcif")
TERRAIN_SUFFIXES = (".asc",)
SCENE_SUFFIXES = (".scene", ".txt")


def read(
    path: str | os.PathLike[str],
    *,
    exaggeration: float | None = None,
    tolerance: float | None = None,
    molecules: str | None = None,
    parts: str | None = None,
) -> Scene:
    """The scene in a file: a mesh (one of MESH_SUFFIXES), parts of a CAD system (see cad_files.cad_scene), a molecule
    (xyz, pdb, cif), a terrain (asc, xyz), or the scene language (any other suffix). exaggeration: factor of a terrain's
    heights; where None, extreme heights are scaled by 1, 2 or 5 times a power of ten, with an InputWarning. tolerance:
    of parts. molecules: see molecule_scene. parts: "triangles" or "exact", see cad_files.cad_scene. A mesh file gives
    one item, or one for each object or node. Meshes are repaired (see mesh_repair.repaired), reported in one
    InputWarning a file. The file is found as named_files.data_file has it.
    Errors: InputError, one line with file, line and cause; a file of another kind is named as such.
    """
    path = Path(data_file_or_name(os.fspath(path)))
    check_file(path)
    is_molecule = path.suffix.lower() in MOLECULE_SUFFIXES and not _is_terrain(path)
    if parts is not None and (is_molecule or _is_terrain(path) or path.suffix.lower() in MESH_SUFFIXES):
        raise InputError(NO_PARTS, file=shown(path))
    if molecules is not None and not is_molecule:
        raise InputError("a style of molecules is for molecules only (xyz, pdb, cif)", file=shown(path))
    if _is_terrain(path):
        from vectorplot.io.terrain_files import scene_of_heights

        return scene_of_heights(path, exaggeration)
    if exaggeration is not None:
        raise InputError("heights are exaggerated of terrains only (asc, xyz)", file=shown(path))
    if is_molecule:
        from vectorplot.io.molecules import STYLES, molecule_scene, read_molecule

        return molecule_scene(read_molecule(path), STYLES[0] if molecules is None else molecules)
    if path.suffix.lower() in MESH_SUFFIXES:
        return mesh_scene(path)
    if path.suffix.lower() in CAD_SUFFIXES:
        from vectorplot.io.cad_files import cad_scene
        from vectorplot.tolerances import USUAL_PART_TOLERANCE

        fine = USUAL_PART_TOLERANCE if tolerance is None else tolerance
        return cad_scene(path, fine) if parts is None else cad_scene(path, fine, parts)
    _check_text(path)
    return _scene_text(path, tolerance, parts)


def _is_terrain(path: Path) -> bool:
    """Whether a file holds heights: its suffix tells, and that of molecules with what it begins with."""
    if path.suffix.lower() != ".xyz":
        return path.suffix.lower() in TERRAIN_SUFFIXES
    from vectorplot.io.terrain_files import holds_points

    return holds_points(path)


def _scene_text(path: Path, tolerance: float | None, parts: str | None) -> Scene:
    """The scene that a text describes; what is wrong with it may be that it is none. tolerance, parts: see read."""
    from vectorplot.io.scene_language import read_scene

    try:
        return read_scene(path, tolerance, parts)
    except InputError as error:
        if path.suffix.lower() in SCENE_SUFFIXES:
            raise
        cause = f"{error.cause} (it was read as a scene: meshes end in {', '.join(MESH_SUFFIXES)})"
        raise InputError(cause, file=error.file, line=error.line) from None


def _check_text(path: Path) -> None:
    """An InputError, which names its kind, for a file that cannot be a scene text."""
    with path.open("rb") as file:
        kind = unsupported_kind(path, file.read(4096))
    if kind:
        raise InputError(kind, file=shown(path))


# Standard input -> a scene: what another program writes in the scene language.

STANDARD_INPUT = "-"
"""What stands for standard input where a file is expected."""

_NAME = "standard input"
"""What messages call it."""


def read_named(
    name: str,
    *,
    exaggeration: float | None = None,
    tolerance: float | None = None,
    molecules: str | None = None,
    parts: str | None = None,
) -> Scene:
    """The scene in the file of a name, as io.read_file.read has it; of the
    name ``-`` the one in the scene language on standard input, in which names of files are relative to the folder that
    one is in.

    Errors: InputError as in read; for a text that is empty, larger than 64 MiB, not UTF-8 or something else.
    """
    if name != STANDARD_INPUT:
        return read(name, exaggeration=exaggeration, tolerance=tolerance, molecules=molecules, parts=parts)
    from vectorplot.io.scene_language import MAX_FILE_BYTES, parse_scene

    if exaggeration is not None:
        raise InputError("heights are exaggerated of terrains only (asc, xyz)", file=_NAME)
    if molecules is not None:
        raise InputError("a style of molecules is for molecules only (xyz, pdb, cif)", file=_NAME)
    if parts is not None:
        raise InputError(NO_PARTS, file=_NAME)
    if sys.stdin is None:
        raise InputError("it is closed", file=_NAME)
    data = sys.stdin.buffer.read(MAX_FILE_BYTES + 1)
    if not data:
        raise InputError("nothing came in", file=_NAME)
    if len(data) > MAX_FILE_BYTES:
        raise InputError(f"larger than {MAX_FILE_BYTES >> 20} MiB: this is no scene", file=_NAME)
    kind = unsupported_kind(Path(STANDARD_INPUT), data)
    if kind:
        raise InputError(f"{kind}; standard input is read as a scene", file=_NAME)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError("not UTF-8: this is no scene", file=_NAME, line=line) from None
    return parse_scene(text, _NAME, beside=os.path.join(os.curdir, STANDARD_INPUT))
