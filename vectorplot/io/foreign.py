"""Kinds of files that are not read, by their suffixes and their first bytes: what they are, and what to do instead."""

from __future__ import annotations

from pathlib import Path

_EXPORT_MESH = "export it as stl, obj, ply, off or glb"
_NO_SHAPES = "it holds no shapes in space"

_SUFFIXES = {
    ".step": ("a STEP file", _EXPORT_MESH),
    ".stp": ("a STEP file", _EXPORT_MESH),
    ".iges": ("an IGES file", _EXPORT_MESH),
    ".igs": ("an IGES file", _EXPORT_MESH),
    ".brep": ("an Open CASCADE shape", _EXPORT_MESH),
    ".fcstd": ("a FreeCAD document", _EXPORT_MESH),
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
    ".vtk": ("a VTK file", _EXPORT_MESH),
    ".vtp": ("a VTK file", _EXPORT_MESH),
    ".vtu": ("a VTK file", _EXPORT_MESH),
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
    (b"ISO-10303-21", *_SUFFIXES[".step"]),
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
    (b"# vtk", *_SUFFIXES[".vtk"]),
    (b"<", "an XML file", "it is neither a scene nor a mesh"),
    (b"{", "a JSON file", "it is neither a scene nor a mesh"),
)


def foreign_kind(path: Path, head: bytes) -> str | None:
    """What a file is that is neither a scene nor a mesh, and what to do with it; None for what may be a scene.

    head: the first bytes of the file.
    """
    by_suffix = _SUFFIXES.get(path.suffix.lower())
    start = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    found = by_suffix or next(((what, help_) for first, what, help_ in _BEGINNINGS if start.startswith(first)), None)
    if found is None:
        return "a binary file, neither a scene nor a mesh" if b"\0" in head else None
    return f"{found[0]}, which is not read; {found[1]}"
