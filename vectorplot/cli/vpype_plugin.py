"""``vpype vectorplot``: a drawing enters a pipeline of vpype, as layers with their pens.

vpype finds it by its entry point; nothing else here needs vpype.
"""

from __future__ import annotations

import io
from typing import Any

import click
from vpype import Document, convert_length, read_multilayer_svg
from vpype_cli import global_processor

from vectorplot.cli.commands.draw import draw
from vectorplot.cli.many import PictureVerb
from vectorplot.errors import InputError
from vectorplot.save import write

_OF_OUR_FILES = (
    *("scene_file", "out", "format_", "certificate", "tiles", "workers", "cluster"),
    *("explain", "quiet", "strict"),
)
"""Parameters of draw that say what is read and written, and what is said of it."""

QUANTIZATION_MM = 0.05
"""The length of the straight lines that curves become."""


@click.command(
    short_help="Draw a scene or a mesh with exact hidden lines.",
    context_settings={"show_default": True},
    params=[param for param in draw.params if param.name not in _OF_OUR_FILES],
)
@click.argument("scene_file", metavar="INPUT", type=click.Path())
@global_processor  # type: ignore[untyped-decorator]
def vectorplot(document: Document, scene_file: str, **told: Any) -> Document:
    """Draw INPUT, a scene file, mesh, molecule or terrain, by vectorplot: each of its layers becomes one here.

    Options, which are those of `vectorplot draw`, stand before INPUT.
    """
    assert isinstance(draw, PictureVerb)
    unsaid = {param.name: None for param in draw.params} | {"out": "a.svg", "strict": False, "quiet": True}
    try:
        made = draw.made({**unsaid, "scene_file": (scene_file,), **told})
    except (InputError, OSError) as error:
        raise click.ClickException(str(error)) from None
    text = io.StringIO(write(made, "svg").decode("utf-8"))
    document.extend(read_multilayer_svg(text, quantization=convert_length(f"{QUANTIZATION_MM}mm")))
    return document
