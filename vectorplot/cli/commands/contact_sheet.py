"""``vectorplot contact-sheet``: drawings of many files, views or values of options side by side on one sheet."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from functools import partial
from itertools import product
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from vectorplot.cli.commands.draw import draw
from vectorplot.cli.commands.paint import paint
from vectorplot.cli.many import WORKER_OPTIONS, PictureVerb, WorkerOptions, inputs_of, picture_of
from vectorplot.cli.option_values import at_least, page_size
from vectorplot.cli.options import (
    DRAWING_FORMATS,
    INPUT,
    LANDSCAPE,
    OUT,
    QUIET,
    drawing_format,
    format_option,
    with_options,
)
from vectorplot.cli.picture import check_place, progress_bar, reported_warnings, write_out

if TYPE_CHECKING:
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.scene.page import Page


VERBS = {"draw": draw, "paint": paint}
"""What makes drawings."""

MOST_CELLS = 1000
"""Drawings on one sheet."""

CELL_MARGIN_MM = 8.0
"""Around the drawing in its cell, where its name does not need more: letters stand in it."""

AS_WIDE_MM = 0.01
"""A figure has the width of its page to within this."""

Cell = tuple[str, ...]


def _varied(text: str) -> tuple[str, tuple[str, ...]]:
    """OPTION=VALUE,...: the option and its values; those with commas of their own stand between semicolons."""
    option, equals, values = text.partition("=")
    found = tuple(value.strip() for value in values.split(";" if ";" in values else ","))
    if not equals or not option.strip() or not all(found):
        raise click.BadParameter(f"{text!r} is not OPTION=VALUE,...")
    return option.strip().lstrip("-"), found


def _verb(text: str) -> tuple[str, ...]:
    """A verb and its options, as in a shell."""
    try:
        words = tuple(shlex.split(text))
    except ValueError as error:
        raise click.BadParameter(f"{text!r}: {error}") from None
    if not words or words[0] not in VERBS:
        raise click.BadParameter(f"{text!r} begins with none of {', '.join(VERBS)}")
    return words


@click.command("contact-sheet", short_help="Put many drawings on one sheet.", context_settings={"show_default": True})
@with_options(
    INPUT,
    OUT,
    format_option(DRAWING_FORMATS),
    click.option(
        "--vary",
        type=_varied,
        multiple=True,
        metavar="OPTION=VALUE,...",
        show_default=False,
        help="A drawing for each value of an option of the verb: view=front,top,iso; repeat it for all combinations.",
    ),
    click.option(
        "--with",
        "verb",
        type=_verb,
        default="draw",
        metavar="'VERB OPTIONS'",
        help="What makes the drawings, draw or paint, and its options: 'draw --hidden dashed'.",
    ),
    click.option(
        "--cell",
        type=page_size,
        default="80x60",
        metavar="SIZE",
        help="The page of each drawing, before it is made to fit.",
    ),
    click.option("--page", type=page_size, default="A4", metavar="SIZE", help="The sheet: A4, 'A3 landscape', WxH."),
    LANDSCAPE,
    click.option("--columns", type=click.IntRange(1), metavar="N", help="Side by side.  [default: as fits best]"),
    click.option("--gap", "gap_mm", type=at_least(0.0), default=5.0, metavar="MM", help="Between drawings."),
    click.option(
        "--panels",
        metavar="LETTERS",
        is_flag=False,
        flag_value="a)",
        show_default=False,
        help="A figure as wide as the page: in one row, at one scale, on one line, lettered a) b) c), or as in '(a)'.",
    ),
    click.option("--names/--no-names", default=True, help="Under each drawing what it shows."),
    click.option("--title", default="", metavar="TEXT", show_default=False, help="Of the file."),
    *WORKER_OPTIONS,
    QUIET,
)
def contact_sheet(
    scene_file: tuple[str, ...], out: str, format_: str | None, verb: tuple[str, ...], quiet: bool, **told: Any
) -> None:
    """Draw every INPUT, a file or all that hold shapes in a folder, with every value that is varied, and put the
    drawings side by side, in reading order, onto one sheet, OUT (svg, ps, eps, pdf, png, tex, dxf, json).
    """
    from vectorplot.batch.running import results
    from vectorplot.drawing.sheets import contact_sheet as sheet_of
    from vectorplot.drawing.titles import room_for_title
    from vectorplot.save import write
    from vectorplot.scene.page import Page

    written, workers = drawing_format(out, format_), WorkerOptions.of(told)
    cells = _cells(inputs_of(scene_file), told["vary"])
    width, height = _size("--cell", told["cell"])
    page = Page(*_size("--page", told["page"]))
    page = page.landscape if told["landscape"] else page
    captions = [name for _, name, _ in cells] if told["names"] else []
    margin = max([CELL_MARGIN_MM, *(room_for_title(name, width) for name in captions)])
    if told["panels"] is not None:
        given = {"--columns": told["columns"], "--no-names": None if told["names"] else True}
        for name in (name for name, value in given.items() if value is not None):
            raise click.UsageError(f"{name} does not go with --panels")
        made = _figure(verb, cells, page, told, workers, quiet)
        write_out(out, write(made, written))
        return
    same = ("--page", f"{width!r}x{height!r}", "--margin", repr(margin), *verb[1:])
    params = [_params(verb[0], path, (*same, *_named(name, told["names"]), *words)) for path, name, words in cells]
    if workers.given:
        params = [{**one, "jobs": one["jobs"] or 1} for one in params]
    check_place(out)
    done = 0

    def drawn(progress: Any) -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(f"drawing {done} of {len(cells)}", done / len(cells))

    with (
        reported_warnings(quiet=quiet),
        progress_bar(quiet=quiet) as progress,
        workers.executor() as (executor, window),
    ):
        calls = [partial(picture_of, verb[0], one) for one in params]
        drawings: list[Drawing] = results(calls, executor, window=window, tell=partial(drawn, progress))
        made = sheet_of(drawings, page, columns=told["columns"], gap_mm=told["gap_mm"], title=told["title"])
        write_out(out, write(made, written))


def _figure(
    verb: tuple[str, ...],
    cells: Sequence[tuple[str, str, Cell]],
    page: Page,
    told: Mapping[str, Any],
    workers: WorkerOptions,
    quiet: bool,
) -> Drawing:
    """The drawings in a row at one scale, with the width of the page inside its margin."""
    from vectorplot.batch.running import results
    from vectorplot.drawing.sheets import panels, shared_scale

    if len(cells) > 26:
        raise click.UsageError(f"{len(cells)} panels: expected 26 or fewer")
    width = page.width_mm - 2.0 * page.margin_mm
    with (
        reported_warnings(quiet=quiet),
        progress_bar(quiet=quiet) as progress,
        workers.executor() as (executor, window),
    ):

        def drawn(sheet: str, part: float) -> list[Drawing]:
            params = [
                _params(verb[0], path, ("--page", sheet, "--margin", "0", *verb[1:], *words))
                for path, _, words in cells
            ]
            params = [{**one, "jobs": one["jobs"] or 1} for one in params] if workers.given else params
            if progress is not None:
                progress("panels", part)
            return results([partial(picture_of, verb[0], one) for one in params], executor, window=window)

        # How wide they are beside each other tells the scale that they have room at; two such widths tell it exactly.
        first = drawn("fit", 0.0)
        # Pens draw on both sides of the edges of the picture.
        pen = max((layer.pen.width_mm for one in first for layer in one.layers if layer.strokes), default=0.0)
        width -= pen
        scale = shared_scale(first, width, told["gap_mm"])
        text: Literal["strokes", "real"] = "real" if "real" in verb else "strokes"
        found = drawn(f"scale {scale!r}", 0.3)
        beside = (len(found) - 1) * told["gap_mm"]
        if abs(sum(one.width_mm for one in found) + beside - width) > AS_WIDE_MM:
            found = drawn(f"scale {shared_scale(found, width, told['gap_mm'], first)!r}", 0.6)
        how = {"gap_mm": told["gap_mm"], "letters": told["panels"], "title": told["title"], "margin_mm": 0.5 * pen}
        return panels(found, text=text, **how)


def _cells(inputs: Sequence[str], vary: Sequence[tuple[str, Cell]]) -> list[tuple[str, str, Cell]]:
    """What stands in each cell: the file, what it is called, and the options that are its own. Bad usage for too many.

    Files change slowest, what is varied last fastest.
    """
    count = len(inputs) * prod(len(values) for _, values in vary)
    if count > MOST_CELLS:
        raise click.UsageError(f"{count} drawings on one sheet: expected at most {MOST_CELLS}")
    found = []
    for path, *chosen in product(inputs, *(values for _, values in vary)):
        told = [f"{option} {value}" for (option, _), value in zip(vary, chosen, strict=True)]
        name = ", ".join(([Path(path).stem] if len(inputs) > 1 or not told else []) + told)
        words = tuple(f"--{option}={value}" for (option, _), value in zip(vary, chosen, strict=True))
        found.append((path, name, words))
    return found


def _named(name: str, shown: bool) -> Cell:
    return ("--title", name) if shown else ()


def _size(option: str, size: tuple[float, float] | str) -> tuple[float, float]:
    if isinstance(size, str):
        raise click.UsageError(f"{option} {size}: expected a size")
    return size


def _params(verb: str, path: str, words: Sequence[str]) -> Mapping[str, Any]:
    """The values of a verb's parameters for a cell. Bad usage as in the verb."""
    command: PictureVerb = VERBS[verb]  # type: ignore[assignment]
    # Nothing is written under this name: the sheet takes the drawing itself.
    params = command.make_context(verb, [path, "-o", "cell.svg", *words]).params
    for name in ("explain", "workers", "cluster"):
        if params[name]:
            raise click.UsageError(f"--{name} does not go into --with")
    if params["text"] == "latex":
        raise click.UsageError("--text latex is of one picture: it does not go into --with")
    return params
