"""``vectorplot animate``: a scene that moves becomes frames."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.commands import draw, paint, render
from vectorplot.cli.many import (
    FPS,
    FRAME_FORMAT,
    FRAMES_OUT,
    WorkerOptions,
    check_out,
    is_sequence,
    write_frames,
)
from vectorplot.cli.option_values import chosen
from vectorplot.cli.options import (
    Told,
    camera_from,
    crease_angle_option,
    lines_option,
    page_from,
    shadows_option,
    with_options,
)
from vectorplot.cli.picture import Source, located, progress_bar, reported_warnings, summed, table

if TYPE_CHECKING:
    from vectorplot.pictures.pipeline import StageReport


MODE_WORDS = ("wire", "lines", "shading", "shadows", "erasing", "pixels")

VERBS = {"draw": draw, "paint": paint, "render": render}
"""What makes frames: the options of its command, and what they are to its function."""


@click.command(short_help="Make the frames of a moving scene.", context_settings={"show_default": True})
@with_options(
    click.argument("data_file", type=click.Path(), metavar="SCENE"),
    click.option(
        "-a", "--animation", metavar="FILE", required=True, help="What moves: a file, or a name in the folder anim."
    ),
    FRAMES_OUT,
    click.option(
        "-v", "--video", metavar="NAME", help="Also, or only, record NAME.vd1 and NAME.vd2, in the folder video."
    ),
    click.option("--mode", type=click.Choice(MODE_WORDS), help="Look of the frames.  [default: that of the animation]"),
    click.option("--frames", type=click.IntRange(1), metavar="N", help="How many.  [default: that of the animation]"),
    FPS,
    FRAME_FORMAT,
    lines_option("Kinds of lines", default=None, note="  [default: see the verbs]"),
    crease_angle_option("Sharper edges are creases."),
    shadows_option("render", "Whether lights cast shadows, and how pixels find them."),
)
def animate(
    data_file: str,
    animation: str,
    frames_out: str | None,
    video: str | None,
    mode: str | None,
    frames: int | None,
    fps: float | None,
    frame_format: str | None,
    explain: bool,
    quiet: bool,
    **told: Any,
) -> None:
    """Make the frames of SCENE, a scene file, mesh, CAD part, molecule or terrain, as an animation file moves it, and
    write them to OUT, or record them as a movie of polygons.

    SCENE is looked for in the current folder and in the folder data, with and without .scene; the animation in the
    current folder and in the folders anim and data, with and without .anim; and both among the samples that came with
    vectorplot. One fit holds for the whole film. Options are those
    of the verb that makes the frames: draw (modes wire and lines), paint (shading, shadows and erasing) or render
    (pixels). Camera options replace the fields of the camera in the scene file one by one, before it moves; sections
    and levels are of the scene at rest and move with its items, and cuts stand still.
    """
    from vectorplot.animation.animation import MODES
    from vectorplot.animation.animation_file import read_animation
    from vectorplot.io.named_files import animation_file
    from vectorplot.io.named_files import data_file as found
    from vectorplot.pictures.film import animate as film_of

    if frames_out is None and video is None:
        raise click.UsageError("nothing to write: give -o OUT, or -v NAME, or both")
    check_out(frames_out, frame_format)
    workers = WorkerOptions.of(told)
    sequence = is_sequence(frames_out) and video is None
    if workers.given and not sequence:
        raise click.UsageError("--workers and --cluster make frames into a folder alone: give -o FOLDER/, no -v")
    if workers.given and explain:
        raise click.UsageError("--explain is of work in this process: it does not go with --workers and --cluster")
    if told["text"] == "latex":
        raise click.UsageError("--text latex is of one picture")
    exaggeration, molecules, parts = (told.pop(name) for name in ("exaggeration", "molecules", "parts"))
    asked = Told.of(told)
    assert asked.page is not None
    source = Source((str(found(data_file)),), exaggeration, True, asked.fineness, molecules, parts)
    reports: list[StageReport] = []
    with reported_warnings(quiet=quiet), progress_bar(quiet=quiet) as progress:
        cut = asked.cuts.of_scene(asked.added.with_materials(source.read()))
        scene, kinds = asked.added.in_scene(cut)
        scene = replace(scene, camera=camera_from(asked.camera, scene), page=page_from(asked.page, scene))
        moving = read_animation(animation_file(animation), scene)
        moving = replace(
            moving,
            frames=chosen(frames, moving.frames),
            fps=chosen(fps, moving.fps),
            mode=chosen(mode, moving.mode),
        )
        options = _of_verb(MODES[moving.mode].verb, asked.rest)
        # Workers are as many as there is room for: threads of theirs would only be in each other's way.
        options["jobs"] = told["jobs"] or (1 if workers.given else None)
        if "lines" in options:
            options["lines"] = tuple(dict.fromkeys((*options["lines"], *kinds)))
        if explain:
            options["explain"] = reports.append
        with located(scene):
            film = film_of(moving, width=told["width"], size=told["size"], progress=progress, **options)
            if not sequence:
                write_frames(film, len(film), frames_out, video, film.fps, frame_format, progress)
    if sequence and frames_out is not None:
        from vectorplot.batch.running import frame_tasks

        tasks = frame_tasks(film, frames_out, format=frame_format)
        workers.run(tasks, len(film), "frames", quiet=quiet)
    if explain:
        click.echo(table(summed(reports)), err=True)


NOT_OF_FRAMES = {
    *(
        "certificate",
        "strict",
        "scene_file",
        "out",
        "format_",
        "panorama",
        "strips",
    )
}
"""Parameters of the verbs that frames have not."""

KNOWN = {verb: {str(option.name): option for option in getattr(made, verb).params} for verb, made in VERBS.items()}
"""The parameters of each verb, by their names."""

_own = {option.name for option in animate.params}
_of_verbs = {name: option for options in KNOWN.values() for name, option in options.items()}
animate.params += [option for name, option in _of_verbs.items() if name not in _own | NOT_OF_FRAMES]


def _of_verb(verb: str, told: Mapping[str, Any]) -> dict[str, Any]:
    """The keywords of the verb that makes frames. Bad usage for options of others that were given."""
    context = click.get_current_context()
    for name, option in _of_verbs.items():
        given = context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE
        if given and name not in KNOWN[verb]:
            raise click.UsageError(f"{option.opts[0]} does not go with frames that the verb {verb} makes")
    known = {name: value for name, value in told.items() if name in KNOWN[verb] and name not in ("size", "width")}
    found = {name: value for name, value in VERBS[verb].keywords(known).items() if value is not None}
    return found if verb == "draw" else {"lines": (), **found}
