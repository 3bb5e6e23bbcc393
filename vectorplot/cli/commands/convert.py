"""``vectorplot convert``: a scene as a mesh for other programs, or as a scene file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.option_values import format_of
from vectorplot.cli.options import INPUT, JOBS, MOLECULES, OUT, QUIET, UNION, format_option, with_options
from vectorplot.cli.picture import Source, make_picture

if TYPE_CHECKING:
    from vectorplot.cli.picture import Report
    from vectorplot.scene.scene import Scene

FORMATS = ("stl", "obj", "ply", "off", "scene")


@click.command(short_help="Write shapes as a mesh for other programs.")
@with_options(
    INPUT,
    OUT,
    format_option(FORMATS),
    UNION,
    MOLECULES,
    JOBS,
    QUIET,
)
def convert(
    scene_file: tuple[str, ...],
    out: str,
    format_: str | None,
    union: bool,
    molecules: str | None,
    jobs: int | None,
    quiet: bool,
) -> None:
    """Write the shapes of INPUT, scenes, meshes or parts, as OUT (stl, obj, ply, off) in the units of the scene, or as
    a scene file (scene).

    Smooth surfaces become triangles; curves, lights and cuts are left out of meshes.
    """

    def shapes(scene: Scene, _: Report) -> Any:
        if not union:
            return scene
        from vectorplot.scene.united import united
        from vectorplot.shading.facet_resolution import as_meshes

        return united(as_meshes(scene))

    source = Source(scene_file, upright=True, molecules=molecules)
    make_picture(source, out, format_of(out, format_, FORMATS), shapes, quiet=quiet, explain=False, jobs=jobs)
