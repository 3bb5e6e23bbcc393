"""``vectorplot animate``: a scene that moves becomes frames."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.many import (
    FPS,
    FRAME_FORMAT,
    FRAMES_OUT,
    WORKER_OPTIONS,
    WorkerOptions,
    check_out,
    is_sequence,
    write_frames,
)
from vectorplot.cli.option_values import chosen, pixels
from vectorplot.cli.options import (
    BACKGROUND,
    BUDGET,
    CAMERA_OPTIONS,
    CUT_OPTIONS,
    DEPTH_CUE,
    EXPLAIN,
    EXPOSURE,
    FACE_OPTIONS,
    FRAME,
    HALO,
    HATCHING_OPTIONS,
    JOBS,
    LAYERS,
    LIGHTS,
    LINE_OPTIONS,
    PAGE_OPTIONS,
    QUIET,
    STROKE_OPTIONS,
    TITLE,
    TOLERANCE,
    CameraOptions,
    CutOptions,
    LineOptions,
    PageOptions,
    camera_from,
    crease_angle_option,
    hatching_from,
    lines_option,
    page_from,
    shadows_option,
    with_options,
)
from vectorplot.cli.picture import located, progress_bar, reported_warnings, summed, table

if TYPE_CHECKING:
    from vectorplot.pictures.pipeline import StageReport


MODE_WORDS = ("wire", "lines", "shading", "shadows", "erasing", "pixels")

_LINES = ("lines", "crease_angle_deg", "style", "pens", "dashes", "depth_cue", "background")

_HATCH = ("hatch", "spacing", "angle", "cross", "along", "stipple", "hatch_width")

VERBS = {
    "draw": {*_LINES, "hidden", "halo_mm", *_HATCH, "layers", "tolerance_mm", "title"},
    "paint": {*_LINES, "lights", "exposure", "shadows", "aura_mm", "palette", "flat", "tolerance_mm", "title"},
    "render": {*_LINES, "lights", "exposure", "shadows"},
}
"""The options that go with each verb, beside those for camera, page, lines on all that is shown, cuts and work."""


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
    *CAMERA_OPTIONS,
    *PAGE_OPTIONS,
    click.option("--size", type=pixels, default="800x600", metavar="WxH", help="Columns and rows of pixels."),
    lines_option("Kinds of lines", default=None, note="  [default: as of the verbs]"),
    crease_angle_option("Sharper edges are creases."),
    *STROKE_OPTIONS,
    HALO,
    *HATCHING_OPTIONS,
    LAYERS,
    LIGHTS,
    EXPOSURE,
    shadows_option(("auto", "none"), "Whether lights cast shadows."),
    *FACE_OPTIONS,
    DEPTH_CUE,
    BACKGROUND,
    TOLERANCE,
    TITLE,
    FRAME,
    *LINE_OPTIONS,
    *CUT_OPTIONS,
    BUDGET,
    JOBS,
    *WORKER_OPTIONS,
    EXPLAIN,
    QUIET,
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
    """Make the frames of SCENE, a scene file, mesh, molecule or terrain, as an animation file moves it, and write them
    to OUT, or record them as a movie of polygons.

    SCENE is looked for in the current folder and in the folder data, with and without .scene; the animation in the
    current folder and in the folder anim, with and without .anim. One fit holds for the whole film. Camera options
    replace the fields of the camera in the scene file one by one, before it moves; sections and levels are of the scene
    at rest and move with its items, and cuts stand still.
    """
    from vectorplot.animation.animation import MODES
    from vectorplot.animation.animation_file import read_animation
    from vectorplot.io.named_files import animation_file
    from vectorplot.io.named_files import data_file as found
    from vectorplot.io.read_file import read
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
    camera, page = CameraOptions.of(told), PageOptions.of(told)
    reports: list[StageReport] = []
    with reported_warnings(quiet=quiet), progress_bar(quiet=quiet) as progress:
        added, cuts = LineOptions.of(told), CutOptions.of(told)
        scene, kinds = added.in_scene(cuts.of_scene(added.with_materials(read(found(data_file)))))
        scene = replace(scene, camera=camera_from(camera, scene), page=page_from(page, scene))
        moving = read_animation(animation_file(animation), scene)
        moving = replace(
            moving,
            frames=chosen(frames, moving.frames),
            fps=chosen(fps, moving.fps),
            mode=chosen(mode, moving.mode),
        )
        options = _of_verb(MODES[moving.mode].verb, told)
        # Workers are as many as there is room for: threads of theirs would only be in each other's way.
        options["jobs"] = told["jobs"] or (1 if workers.given else None)
        if "lines" in options:
            options["lines"] = tuple(dict.fromkeys((*options["lines"], *kinds)))
        if explain:
            options["explain"] = reports.append
        with located(scene):
            film = film_of(
                moving, width=told["width"], size=told["size"], fit=told["fit"], progress=progress, **options
            )
            if not sequence:
                write_frames(film, len(film), frames_out, video, film.fps, frame_format, progress)
    if sequence and frames_out is not None:
        from vectorplot.batch.running import frame_tasks

        tasks = frame_tasks(film, frames_out, format=frame_format)
        workers.run(tasks, len(film), "frames", quiet=quiet)
    if explain:
        click.echo(table(summed(reports)), err=True)


def _of_verb(verb: str, told: dict[str, Any]) -> dict[str, Any]:
    """The options of the verb that makes frames. Bad usage for others that were given."""
    context = click.get_current_context()
    known, every = VERBS[verb], set().union(*VERBS.values())
    for name in sorted(every - known):
        if context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE:
            option = next(param for param in context.command.params if param.name == name).opts[0]
            raise click.UsageError(f"{option} does not go with frames that the verb {verb} makes")
    given = {name: told[name] for name in known if told[name] is not None}
    if verb == "draw":
        hatch, given = hatching_from({**dict.fromkeys(_HATCH), **given})
        given = {**given, "hatch": hatch}
    if verb == "paint":
        given["smooth"] = not given.pop("flat")
    own = {name: told[name] for name in ("budget", "jobs")}
    if verb != "render":
        own["frame"] = told["frame"]
    elif "lines" not in given:
        given["lines"] = ()
    return {**given, **own}
