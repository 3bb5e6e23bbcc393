"""Draws the gallery: scenes in data/, some of them painted too, scripts in examples/, and the page that shows them.

``python docs/gallery.py`` writes docs/gallery/*.svg, docs/gallery/*.png and docs/gallery/README.md. A test
compares what it would write with what is stored.
"""

from __future__ import annotations

import importlib.util
import re
import sys
import tempfile
from inspect import signature
from pathlib import Path

import vectorplot as vp

ROOT = Path(__file__).resolve().parent.parent
GALLERY = ROOT / "docs" / "gallery"
HEIGHT = 220
"""Height of a picture on the page, in pixels."""

LOOK_AT = {
    "asymptotic_lines": "Along them a surface does not bend towards its normals; on a minimal one they cross squarely.",
    "box": "A hollow box has no bottom and no top; `+bottom` closes it below. The back walls are seen inside.",
    "capped": "Flat ends make bodies of cylinders, cones and balls; their rims and contours are arcs in closed form.",
    "cone": "A meridian with its upper end on the axis: all faces meet in a single vertex. `edges` shows them.",
    "conic_section": "A cone cut in an ellipse, with names, axis and height: a figure for a textbook.",
    "cubes": "They have their centre in common; edges stop where one cube enters the other, and the section is drawn.",
    "curves": "Curves in space, some of them on surfaces that hide half of them: a course, a knot, borders of holes.",
    "curvature_lines": "They cross at right angles, close, and bend round the umbilics, of which one is in front.",
    "cyclide": "A torus inverted in a sphere; all parameter lines are circles, before and after.",
    "cylinder": "One looks in at the open top: inside the faces show their back, and the near rim hides the bottom.",
    "face_looks": "Faces have colours and materials of their own; an end of the house mirrors and lights the floor.",
    "geodesics": "Straightest lines: those that start steeply wind round the tube, the flat one stays outside.",
    "house": "The scene of the first page: a body and a ball, whose contour is a circle, not a polygon.",
    "implicit": "Surfaces by their equations alone: level lines on a rounded cube, isophotes on a pretzel.",
    "interpenetrating": "Beams driven through one another; the tips that come out of the die are small and complete.",
    "intersections": "Two cubes, a cylinder and a cube, a ring and a slab: only what each pair has in common is drawn.",
    "mirror": "The mirror shows backs and patterns of things, in lines as well as painted; painted, their shadows too.",
    "mixed": "A polyhedron and smooth surfaces pierce one another; each hides what is behind it.",
    "patterns": "Each polygon lies in the coordinates of its face; what is on a face that turns away is not drawn.",
    "pencil": "A cone of order 45 on a cylinder, cut with a hexagonal prism: the sides end in arcs of hyperbolas.",
    "plate": "Rims of holes are circles; through the large one their other side is seen, through the small ones not.",
    "plotted_town": "Walls, shadows and panes of one pen: tone by hatching, windows by grid and ring, a street name.",
    "pool": "The floor seems raised by the water, and the pole bent, in lines as well as painted.",
    "pyramid": "The book's example of an object with a convex outline; it is open above, and one looks inside.",
    "removed_faces": "Two walls of the house and the lid of the crate are gone: one looks in, and through.",
    "revolutions": "The same meridian solid, hollow with a bottom, and cut off after three quarters of a turn.",
    "rotsweep": "Half a turn of a meridian; the first and the last one bound a single flat face.",
    "ruled": "Straight lines turned, screwed and moved: hyperboloid, helicoid and saddle, with all their lines.",
    "shadows": "Where shadows of several lamps lie on one another it is darker: polygons like everything else.",
    "slices": "Surfaces cut by parallel planes; the lines between the slices are hidden where they are behind.",
    "splines": "Curves and surfaces through points, or drawn by them, and a landscape through heights on a grid.",
    "table": "Things stand on a table: their lower edges lie in its top, and stay visible there.",
    "three_bars": "Each lies above the next: no order of painting is right, geometry has no such trouble.",
    "torus": "Columns and rows of parameter lines; the contour ends in cusps where it turns away behind the surface.",
    "town": "Thirty blocks on a plate, each edge as far as it is seen; painted, with shadows of the sun and of a lamp.",
    "translational_sweep": "A plane polygon moved along a vector.",
    "tube": "Nothing closes the ends: one looks through, on what is behind.",
}
"""What a scene shows, in a sentence."""

PAINTED = set("capped cubes face_looks interpenetrating mirror patterns pencil plate pool shadows table".split())
PAINTED |= {"three_bars", "town"}
"""The scenes that are painted as well."""

TOLERANCE_MM = 0.2
"""How far painted pictures may be off curves: they are small, and so are their files."""


def scenes() -> list[Path]:
    """The scene files."""
    return sorted((ROOT / "data").glob("*.scene"))


def examples() -> list[Path]:
    """The scripts."""
    return sorted((ROOT / "examples").glob("*.py"))


def draw_scene(path: Path, folder: Path) -> list[Path]:
    """Draw a scene file into a folder, and paint it if it is one of those; the files it made."""
    scene, drawn, painted = vp.read(path), folder / f"{path.stem}.svg", folder / f"{path.stem}_painted.svg"
    vp.save(vp.draw(scene), drawn)
    if path.stem not in PAINTED:
        return [drawn]
    vp.save(vp.paint(scene, tolerance_mm=TOLERANCE_MM), painted)
    return [drawn, painted]


def run_example(path: Path, folder: Path, width: int | None = None) -> list[Path]:
    """Run a script, its own folder being one inside this one; the files it made.

    Scripts whose pictures of pixels have any width are run with this one, if one is given.
    """
    (own := folder / path.stem).mkdir()
    main = module(path).main
    main(own, **({} if width is None or "width" not in signature(main).parameters else {"width": width}))
    return sorted(own.iterdir())


def module(path: Path):
    """A script as a module, with what scripts share beside it."""
    if str(path.parent) not in sys.path:
        sys.path.append(str(path.parent))
    spec = importlib.util.spec_from_file_location(f"example_{path.stem}", path)
    assert spec is not None and spec.loader is not None
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def text_of(path: Path) -> tuple[str, str]:
    """The first sentence of a script's docstring, and the rest of it."""
    doc = re.match(r'"""(.*?)"""', path.read_text(encoding="utf-8"), flags=re.DOTALL)
    assert doc is not None, path
    title, _, rest = doc.group(1).strip().partition("\n\n")
    return " ".join(title.split()), " ".join(rest.split())


def entry(title: str, source: Path, pictures: list[str], text: str) -> list[str]:
    """The lines of the page about one source."""
    link = f"../../{source.relative_to(ROOT).as_posix()}"
    shown = "\n".join(f'<img src="{name}" alt="{title}" height="{HEIGHT}">' for name in pictures)
    return [f"### {title}", "", shown, "", f"{text} [{source.name}]({link})", ""]


def page(pictures: dict[Path, list[str]]) -> str:
    """The text of docs/gallery/README.md."""
    lines = ["# Gallery", "", "Written by docs/gallery.py. Every picture comes from the file named below it.", ""]
    lines += ["## Scenes", "", "`vectorplot draw data/NAME.scene -o NAME.svg` draws each of them,"]
    lines += ["`vectorplot paint data/NAME.scene -o NAME.svg` paints those with a second picture.", ""]
    for path in scenes():
        lines += entry(vp.read(path).title, path, pictures[path], LOOK_AT[path.stem])
    lines += ["## Scripts", "", "`python examples/NAME.py FOLDER` makes each of them, and checks what it claims.", ""]
    for path in examples():
        title, text = text_of(path)
        lines += entry(title.rstrip("."), path, pictures[path], text)
    return "\n".join(lines)


def draw_all(folder: Path) -> dict[Path, list[Path]]:
    """Draw everything into a folder; the files that each source made."""
    made = {path: draw_scene(path, folder) for path in scenes()}
    return made | {path: run_example(path, folder) for path in examples()}


def main() -> None:
    """Write the gallery."""
    with tempfile.TemporaryDirectory() as desk:
        made = draw_all(Path(desk))
        GALLERY.mkdir(exist_ok=True)
        for old in (*GALLERY.glob("*.svg"), *GALLERY.glob("*.png")):
            old.unlink()
        for files in made.values():
            for file in files:
                (GALLERY / file.name).write_bytes(file.read_bytes())
    small = vp.draw(vp.read(ROOT / "data" / "pencil.scene"), page=vp.Page(130, 70, 4))
    vp.save(small, GALLERY / "pencil.png")
    names = {path: [file.name for file in files] for path, files in made.items()}
    (GALLERY / "README.md").write_text(page(names), encoding="utf-8")
    print(f"{sum(map(len, names.values()))} pictures")


if __name__ == "__main__":
    main()
