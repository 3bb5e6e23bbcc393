"""The options that the verbs which make pictures share: cuts, lines, camera, page, shading, hatching, pens."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from functools import partial, reduce, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import click

from vectorplot.cli.many import WORKER_OPTIONS, PictureVerb, WorkerOptions, is_folder, make_pictures
from vectorplot.cli.option_values import (
    AXES,
    KINDS,
    OptionGroup,
    ascending,
    at_least,
    between,
    chosen,
    colour_word,
    dash,
    depth_cue,
    direction,
    exclusive,
    exposure,
    format_of,
    kinds,
    layers,
    length,
    letter_size,
    light,
    number,
    of_option,
    page_size,
    pen,
    point,
    said_or_none,
    style,
    subdivision_scheme,
    tiles,
    upwards,
)
from vectorplot.cli.picture import (
    SILENT,
    Companion,
    Report,
    Source,
    kept_promise,
    make_picture,
    picture_contents,
    picture_made,
    tiles_beside,
    warn_of_nothing,
)
from vectorplot.errors import InputError, InputWarning
from vectorplot.pictures.options import SHADOWS
from vectorplot.words import TEXT_WORDS

if TYPE_CHECKING:
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.geometry.camera import Camera, Point
    from vectorplot.scene.material import Material
    from vectorplot.scene.page import Page
    from vectorplot.scene.scene import Scene
    from vectorplot.scene.surface_lines import Section, SurfaceLines
    from vectorplot.shading.image import Image


# Options that cut what is shown, move its parts apart, or make them one.


def cut_text(text: str) -> str:
    """The conditions of a cut, as they are; bad usage where they are none."""
    from vectorplot.scene.cuts import Cut

    try:
        Cut.of(text)
    except InputError as error:
        raise click.BadParameter(str(error)) from None
    return text


Apart = tuple["Point"] | tuple["Point", float] | tuple[str, "Point"]
"""How parts are moved apart: along an axis, with a factor; or a part by its name, and how far."""


def _explosion(text: str) -> Apart:
    """AXIS or AXIS,FACTOR; an axis is x, y, z, or X,Y,Z. Or NAME=X,Y,Z."""
    if "=" in text:
        name, _, step = text.rpartition("=")
        return name.strip(), point(step)
    if text.count(",") in (0, 2):
        return (direction(text),)
    axis, _, factor = text.rpartition(",")
    found = direction(axis), number(factor)
    if not found[1] >= 1.0:
        raise click.BadParameter(f"a factor of {found[1]:g}: expected 1 or more")
    return found


CUT_SPACING = click.option(
    "--cut-spacing",
    type=at_least(0.1),
    metavar="MM",
    help="From stroke to stroke of hatches of cut faces, on the page.  [default: 2.4, on narrow faces 1.2]",
)

EXPLODE = click.option(
    "--explode",
    type=_explosion,
    multiple=True,
    metavar="AXIS[,FACTOR]",
    show_default=False,
    help="Parts moved apart along x, y, z or X,Y,Z; z,1.5 is z. Or a part, NAME=X,Y,Z; repeat it for more.",
)

UNION = click.option("--union", is_flag=True, help="Solids that touch or overlap, and look alike, are one body.")

CUT_OPTIONS = (
    click.option(
        "--cut",
        type=cut_text,
        multiple=True,
        metavar="CONDITION",
        show_default=False,
        help="Take away what is before a plane, y=0 or x+2y=3; or all of 'x>0, y<2, 0<z<1'. Repeat it for more cuts.",
    ),
    click.option(
        "--cut-away",
        type=click.Choice(("gone", "ghost", "moved")),
        default="gone",
        help="What becomes of what is cut away: nothing, dashed outlines, or it is moved along the normal.",
    ),
    click.option("--cut-colour", metavar="COLOUR", help="Of cut faces.  [default: that of their bodies]"),
    CUT_SPACING,
    click.option("--cut-angle", type=number, default=45.0, metavar="DEG", help="Of these strokes, from what is level."),
    EXPLODE,
    UNION,
)


def moved_apart(scene: Scene, asked: Sequence[Apart]) -> Scene:
    """The scene with its parts moved apart as asked for, else as it says itself. Bad usage for an axis among moves."""
    from vectorplot.scene.exploded import exploded, shown_apart

    if not asked:
        return shown_apart(scene)
    moves = {one[0]: one[1] for one in asked if len(one) == 2 and isinstance(one[0], str)}
    if moves and len(moves) == len(asked):
        return exploded(scene, moves)
    if len(asked) > 1:
        raise click.UsageError("--explode: expected one axis, or NAME=X,Y,Z of several parts, each once")
    (one,) = asked
    return exploded(scene, one[0], *(float(x) for x in one[1:] if not isinstance(x, tuple)))


@dataclass(frozen=True)
class CutOptions(OptionGroup):
    """The cuts that the user asked for, how parts are moved apart, and whether those that touch are one."""

    cut: tuple[str, ...] = ()
    cut_away: str = "gone"
    cut_colour: str | None = None
    cut_spacing: float | None = None
    cut_angle: float = 45.0
    explode: tuple[Apart, ...] = ()
    union: bool = False

    def of_scene(self, scene: Scene) -> Scene:
        """The scene with these cuts. Errors: InputError for unknown colours."""
        from vectorplot.scene.cuts import Cut

        if self.union:
            from vectorplot.scene.united import united

            scene = united(scene)
        scene = moved_apart(scene, self.explode)
        spelled = partial(Cut.of, away=self.cut_away, colour=self.cut_colour)
        hatched = partial(spelled, spacing_mm=self.cut_spacing, angle_deg=self.cut_angle)
        cuts = tuple(hatched(text) for text in self.cut)
        return replace(scene, cuts=scene.cuts + cuts) if cuts else scene


# Options of dimensions: how measures are written.

MEASURE_OPTIONS = (
    click.option(
        "--decimals",
        type=click.IntRange(0, 9),
        metavar="N",
        help="Of the measures of dimensions.  [default: as many as six digits need]",
    ),
    click.option("--zeros/--no-zeros", default=None, help="Zeros at the end of their decimals, as 12.50."),
    click.option("--comma/--point", default=None, help="What stands before their decimals.  [default: a point]"),
)


@dataclass(frozen=True)
class MeasureOptions(OptionGroup):
    """How the user wants measures written; None where nothing was said."""

    decimals: int | None = None
    zeros: bool | None = None
    comma: bool | None = None

    def of_scene(self, scene: Scene) -> Scene:
        """The scene with measures like that, as far as anything was said."""
        from vectorplot.scene.labels import Measures

        said = {name: value for name, value in vars(self).items() if value is not None}
        return replace(scene, measures=replace(scene.measures or Measures(), **said)) if said else scene


# Options for all that is shown: plane sections, level lines, isophotes, colours, materials.


@dataclass(frozen=True)
class Planes:
    """Parallel planes: so many of them, or (count: 0) at these distances from the origin."""

    normal: Point
    count: int
    offsets: tuple[float, ...] = ()

    @classmethod
    def read(cls, text: str) -> Planes:
        """AXIS,N or AXIS=D,...; an axis is x, y, z, or a normal X,Y,Z."""
        if "=" in text:
            axis, _, distances = text.partition("=")
            found = cls(_axis(axis), 0, tuple(number(part.strip()) for part in distances.split(",")))
        else:
            axis, comma, last = text.rpartition(",")
            if not comma:
                raise click.BadParameter(f"{text!r} is not AXIS,N or AXIS=D,...")
            found = cls(_axis(axis), count(last))
        _check(found)
        return found

    @classmethod
    def read_levels(cls, text: str) -> Planes:
        """The same, or N alone, of heights along z."""
        return cls.read(text) if set(text) & set(",=") else cls(AXES["z"], count(text))


def _axis(text: str) -> Point:
    """The direction that a text spells, for words that say what planes are."""
    if "," not in text and text.strip().lower().lstrip("+-") not in AXES:
        raise click.BadParameter(f"{text!r} is no axis, expected x, y, z or a normal X,Y,Z")
    return direction(text)


def _check(planes: Planes) -> None:
    """Bad usage for planes that make no sense."""
    from vectorplot.scene.surface_lines import Section

    try:
        Section(planes.normal, planes.offsets)
    except InputError as error:
        raise click.BadParameter(str(error)) from None


def count(text: str) -> int:
    """How many lines: a whole number from 1 to the largest one of scene files."""
    from vectorplot.scene.surface_lines import MAX_LINES

    try:
        value = int(text)
    except ValueError:
        raise click.BadParameter(f"{text!r} is not a whole number") from None
    if not 1 <= value <= MAX_LINES:
        raise click.BadParameter(f"{value} of them, expected 1 to {MAX_LINES}")
    return value


@dataclass(frozen=True)
class ItemMaterial:
    """The material of an item, or (item: None) of all."""

    item: str | None
    material: Material

    @classmethod
    def read(cls, text: str) -> ItemMaterial:
        """[ITEM=]WORD[,WHAT=N...]."""
        from vectorplot.scene.material import FINISH_WORDS, Material

        first, *rest = (part.strip() for part in text.split(","))
        item, named, word = first.rpartition("=")
        numbers: dict[str, float] = {}
        for part in rest:
            name, _, value = part.partition("=")
            if name not in (words := (*FINISH_WORDS, "opacity", "refraction")):
                raise click.BadParameter(f"{part!r} is none of {', '.join(words)} with = and a number")
            if name in numbers:
                raise click.BadParameter(f"{text!r} says twice what its {name} is")
            numbers[name] = number(value)
        try:
            return cls(item if named else None, Material(word, **numbers))
        except InputError as error:
            raise click.BadParameter(error.cause) from None


LINE_OPTIONS = (
    click.option(
        "--sections",
        type=Planes.read,
        multiple=True,
        metavar="AXIS,N",
        help="N plane sections of the whole at right angles to x, y, z or X,Y,Z; or at AXIS=D,...; repeat it for more.",
        show_default=False,
    ),
    click.option(
        "--levels",
        type=Planes.read_levels,
        metavar="[AXIS,]N",
        help="About N level lines at round heights, every fifth of the kind index; or at AXIS=D,...",
    ),
    click.option(
        "--label-levels", is_flag=True, help="Heights stand on their index lines, or where there are none, on all."
    ),
    click.option("--isophotes", type=count, metavar="N", help="N lines of the same light on all that is shown."),
    click.option(
        "--detail",
        type=at_least(0.01),
        default=1.0,
        metavar="FACTOR",
        help="How much there is of suggestive, ridge, valley and apparent lines.",
    ),
    click.option(
        "--smooth-contours",
        is_flag=True,
        help="Contours of meshes run across faces, as those of the smooth shapes they stand for.",
    ),
    click.option(
        "--subdivision",
        type=subdivision_scheme,
        metavar="SCHEME[,DEG]",
        help="Limit surfaces of meshes by catmull-clark or loop; edges that turn by more than DEG stay sharp.",
    ),
    click.option(
        "--colour-by",
        metavar="WORD|FORMULA",
        help="Colours by x, y, z, height, slope, curvature, a formula such as x*y or a field of a file, and their bar.",
    ),
    click.option(
        "--colour-map",
        metavar="NAME",
        help="viridis, heat, diverging, land, gray, or one of matplotlib.",
    ),
    click.option("--colour-steps", type=click.IntRange(2, 100), metavar="N", help="How many colours (24)."),
    click.option(
        "--colour-range", type=ascending, metavar="LOW,HIGH", help="Numbers of the first and the last colour."
    ),
    click.option("--colour-classes", type=ascending, metavar="N,N,...", help="A colour from each limit to the next."),
    click.option("--colour-logarithmic", is_flag=True, help="Equal ratios have equal steps."),
    click.option("--colour-under", type=colour_word, metavar="COLOUR", help="Of numbers below those with colours."),
    click.option("--colour-over", type=colour_word, metavar="COLOUR", help="Of numbers above those with colours."),
    click.option("--colour-title", metavar="TEXT", help="At the bar; $...$ is a formula.  [default: what they are by]"),
    click.option("--colour-size", type=letter_size, metavar="SIZE", help="Of the letters at the bar: 2.5, or 8pt."),
    click.option("--unlit", is_flag=True, help="Colours by numbers without light and shade."),
    click.option(
        "--scale-bar", is_flag=False, flag_value="", metavar="UNIT", help="A bar of a round length below the picture."
    ),
    click.option(
        "--material",
        "materials",
        type=ItemMaterial.read,
        multiple=True,
        metavar="[ITEM=]WORD[,WHAT=N...]",
        help="metallic, wood, ..., of all or one item; after it exponent=N, diffuse=N, highlight=N, sharpness=N, "
        "opacity=N or refraction=N; repeat it for more.",
    ),
    click.option("--box", is_flag=True, help="A box with ticks around all that is shown."),
)


@dataclass(frozen=True)
class LineOptions(OptionGroup):
    """The lines that the user asked for on all that is shown, beside what a scene file asks for."""

    sections: tuple[Planes, ...] = ()
    levels: Planes | None = None
    label_levels: bool = False
    isophotes: int | None = None
    detail: float = 1.0
    smooth_contours: bool = False
    subdivision: tuple[str, float | None] | None = None
    colour_by: str | None = None
    colour_map: str | None = None
    colour_steps: int | None = None
    colour_range: tuple[float, ...] | None = None
    colour_classes: tuple[float, ...] | None = None
    colour_logarithmic: bool = False
    colour_under: str | None = None
    colour_over: str | None = None
    colour_title: str | None = None
    colour_size: float | None = None
    unlit: bool = False
    scale_bar: str | None = None
    box: bool = False
    materials: tuple[ItemMaterial, ...] = ()

    def in_scene(self, scene: Scene) -> tuple[Scene, tuple[str, ...]]:
        """A scene with these lines, colours and box, and the kinds of the lines."""
        from vectorplot.scene.added_lines import line_kinds, with_lines, without_level_lines

        if self.subdivision is not None:
            from vectorplot.scene.subdivided import subdivided

            scene = subdivided(scene, self.subdivision[0], crease_angle_deg=self.subdivision[1])
        charted, added = self.with_chart(scene), self.of_scene(scene)
        if self.levels is not None:
            charted = without_level_lines(charted, self.levels.normal)
        lined = with_lines(
            charted,
            sections=added.sections,
            isophotes=added.isophotes,
            detail=added.detail,
            smooth_contours=added.smooth_contours,
        )
        return self.with_numbers(lined), line_kinds(added)

    def with_materials(self, scene: Scene) -> Scene:
        """A scene with the materials that the user asked for; the last one counts. Bad usage for names of no item."""
        names = {item.name for item in scene.items}
        for told in self.materials:
            if told.item is not None and told.item not in names:
                raise click.UsageError(f"--material: no item is named {told.item!r}")
        items = scene.items
        for told in self.materials:
            items = tuple(
                replace(item, material=told.material) if told.item in (None, item.name) else item for item in items
            )
        return replace(scene, items=items) if self.materials else scene

    def with_chart(self, scene: Scene) -> Scene:
        """A scene with the colours and the box that the user asked for. Bad usage for a map of no colours."""
        from vectorplot.scene.colour_scales import BoxAxes, Colouring, ScaleBar

        said = self._of_colours()
        own = scene.colouring
        if self.colour_by is not None:
            own = Colouring(self.colour_by)
        if own is None and said:
            raise click.UsageError("options of colours go with --colour-by")
        if said:
            try:
                own = replace(own, **said)  # type: ignore[type-var]
            except InputError as error:
                raise click.UsageError(error.cause) from None
        bar = scene.scale_bar if self.scale_bar is None else ScaleBar(self.scale_bar)
        if own is scene.colouring and bar is scene.scale_bar and not self.box:
            return scene
        return replace(scene, colouring=own, box=BoxAxes() if self.box else scene.box, scale_bar=bar)

    def _of_colours(self) -> dict[str, Any]:
        """The fields of a colouring that the user gave."""
        for other in (("--colour-range", self.colour_range), ("--colour-steps", self.colour_steps)):
            exclusive([("--colour-classes", self.colour_classes), other])
        low, high = self.colour_range or (None, None)
        told = {
            **{"colour_map": self.colour_map, "steps": self.colour_steps, "low": low, "high": high},
            **{"at": self.colour_classes, "logarithmic": self.colour_logarithmic or None, "under": self.colour_under},
            **{"over": self.colour_over, "label": self.colour_title, "size_mm": self.colour_size},
            **{"is_lit": False if self.unlit else None},
        }
        return {name: value for name, value in told.items() if value is not None}

    def with_numbers(self, scene: Scene) -> Scene:
        """A scene with numbers on its level lines where the user asked for them. Bad usage where there are none."""
        from vectorplot.scene.added_lines import with_numbers

        if not self.label_levels:
            return scene
        if not any(not section.slices for item in scene.items for section in item.curves.sections):
            raise click.UsageError("--label-levels: there are no level lines, expected --levels too")
        return with_numbers(scene)

    def of_scene(self, scene: Scene) -> SurfaceLines:
        """The lines that these are in a scene. Errors: InputError as in even_sections and round_sections."""
        from vectorplot.scene.surface_lines import SurfaceLines, even_cosines

        cosines = even_cosines(self.isophotes) if self.isophotes else ()
        planes = tuple(_sections(one, scene) for one in self.sections) + _levels(self.levels, scene)
        return SurfaceLines(
            sections=planes, isophotes=cosines, detail=self.detail, smooth_contours=self.smooth_contours
        )


def _sections(planes: Planes, scene: Scene) -> Section:
    from vectorplot.scene.added_lines import even_sections
    from vectorplot.scene.surface_lines import Section

    return even_sections(scene, planes.normal, planes.count) if planes.count else Section(planes.normal, planes.offsets)


def _levels(planes: Planes | None, scene: Scene) -> tuple[Section, ...]:
    from vectorplot.scene.added_lines import heights_times, round_sections
    from vectorplot.scene.surface_lines import DEFAULT_EVERY, Section, with_index_lines

    if planes is None:
        return ()
    if planes.count:
        return round_sections(scene, planes.normal, planes.count)
    given = Section(planes.normal, planes.offsets)
    times = heights_times(scene, given)
    return with_index_lines(replace(given, offsets=tuple(times * height for height in given.offsets)), DEFAULT_EVERY)


# Options for camera and page, and what becomes of them; the scene file's own are the defaults, field by field.

Command = Callable[..., None]

VIEW_WORDS = ("front", "back", "left", "right", "top", "bottom", "iso")

CAMERA_OPTIONS = (
    click.option("--eye", type=point, metavar="X,Y,Z", help="Where one looks from."),
    click.option("--target", type=point, metavar="X,Y,Z", help="What one looks at."),
    click.option("--up", type=upwards, metavar="X,Y,Z", help="What is upwards, or x, y, z (default: z)."),
    click.option("--twist", type=number, metavar="DEG", help="Turn of the camera about its principal ray."),
    click.option("--fov", type=between(0.0, 180.0), metavar="DEG", help="Full angle over the picture height."),
    click.option("--parallel", is_flag=True, help="Parallel projection along eye - target."),
    click.option(
        "--height", type=between(0.0, math.inf), metavar="H", help="World units over the page, when parallel."
    ),
    click.option("--near", type=between(0.0, math.inf), metavar="D", help="What is nearer to the eye is cut off."),
    click.option("--far", type=between(0.0, math.inf), metavar="D", help="What is farther from the eye is cut off."),
    click.option(
        "--view",
        type=click.Choice(VIEW_WORDS),
        help="A main view of what stands along --up in place of --eye, parallel unless --fov is given.",
    ),
)


def fit_option(filled: str) -> Callable[[Command], Command]:
    """``--fit`` and ``--no-fit``, with what a fitted picture fills."""
    return click.option("--fit/--no-fit", default=True, help=f"Fill the {filled}, or keep the camera's scale.")


LANDSCAPE = click.option("--landscape", is_flag=True, help="Lay the page on its longer side.")
"""Of whatever has a page."""

PAGE_OPTIONS = (
    click.option(
        "--page",
        type=page_size,
        metavar="SIZE",
        help="A0 to A6, letter, legal, ... or WIDTHxHEIGHT in mm; fit: as large as the picture; 'scale 1:2': the same "
        "at a scale.  [default: A4]",
    ),
    click.option(
        "--width",
        type=length,
        metavar="LENGTH",
        help="Of a page as high as its picture: 80mm, 8cm, 3in, 120pt or, for LaTeX, '0.8\\linewidth'.",
    ),
    LANDSCAPE,
    click.option("--margin", type=at_least(0.0), metavar="MM", help="Empty border of the page.  [default: 10]"),
    fit_option("page"),
)


@dataclass(frozen=True)
class CameraOptions(OptionGroup):
    """What the user said about the camera; None and False: nothing."""

    eye: Point | None = None
    target: Point | None = None
    up: Point | None = None
    twist: float | None = None
    fov: float | None = None
    parallel: bool = False
    height: float | None = None
    near: float | None = None
    far: float | None = None
    view: str | None = None

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> Self:
        """What a command with CAMERA_OPTIONS was told. Bad usage for options that contradict each other."""
        found = super().of(options)
        found.check()
        return found

    def says_where(self) -> bool:
        """Whether the user said where one looks from, or what is up."""
        return any(one is not None for one in (self.eye, self.up, self.twist, self.view))

    def check(self) -> None:
        """Bad usage for options that contradict each other."""
        exclusive([("--up", self.up), ("--twist", self.twist)])
        exclusive([("--fov", self.fov), ("--parallel", self.parallel)])
        exclusive([("--fov", self.fov), ("--height", self.height)])
        exclusive([("--view", self.view), ("--eye", self.eye)])


@dataclass(frozen=True)
class PageOptions(OptionGroup):
    """What the user said about the page; None and False: nothing. page: width and height in mm, or a word."""

    page: tuple[float, float] | str | None = None
    landscape: bool = False
    margin: float | None = None

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> Self:
        """What a command with PAGE_OPTIONS was told. Bad usage for a page of a size and a width."""
        from vectorplot.scene.page import FIT

        size = None if options["page"] == FIT else options["page"]
        exclusive([("--page SIZE", size), ("--width", options.get("width"))])
        return super().of(options)


def camera_from(options: CameraOptions, scene: Scene) -> Camera:
    """The camera of the scene (or the default one) with the user's fields in place of its own.

    An InputWarning says where its field of vision will not look natural.
    """
    from vectorplot.geometry.camera import Camera, lens_advice
    from vectorplot.scene.placement import default_camera

    upright = chosen(options.up, (0.0, 0.0, 1.0))
    base = scene.camera or default_camera(scene, upright)
    if options.view is not None:
        named = Camera.view(options.view, chosen(options.target, base.target), base.distance, upright)
        height = base.height if base.parallel else None
        base = replace(named, fov_deg=base.fov_deg, height=height, near=base.near, far=base.far)
    parallel = options.parallel or (base.parallel and options.fov is None)
    if options.height is not None and not parallel:
        raise click.UsageError("--height needs --parallel")
    camera = replace(
        base,
        eye=chosen(options.eye, base.eye),
        target=chosen(options.target, base.target),
        up=base.up if options.view is not None else chosen(options.up, base.up),
        twist_deg=chosen(options.twist, base.twist_deg),
        fov_deg=chosen(options.fov, base.fov_deg),
        parallel=parallel,
        height=chosen(options.height, base.height) if parallel else None,
        near=chosen(options.near, base.near),
        far=chosen(options.far, base.far),
    )
    told = None if parallel else lens_advice(camera.fov_deg)
    if told is not None:
        warnings.warn(told, InputWarning, stacklevel=2)
    return camera


def page_from(options: PageOptions, scene: Scene) -> Page:
    """The page of the scene (or A4) with the user's size, margin and orientation; bad usage if nothing is left."""
    from vectorplot.scene.page import SCALE, Page
    from vectorplot.scene.placement import (
        FittedPage,
        PageAtScale,
        PageOfWidth,
        fitted_page,
        page_at_scale,
        page_of_width,
    )

    base = chosen(scene.page, Page())
    own = (base.width_mm, base.height_mm)
    width, height = own if options.page is None or isinstance(options.page, str) else options.page
    try:
        page = Page(width, height, chosen(options.margin, base.margin_mm))
    except InputError as error:
        raise click.UsageError(str(error)) from None
    page = page.landscape if options.landscape else page
    if isinstance(options.page, str) and options.page.startswith(SCALE):
        return page_at_scale(page, options.page.partition(" ")[2])
    if options.page is None and isinstance(base, PageOfWidth):
        return page_of_width(page, base.width_mm)
    if options.page is None and isinstance(base, PageAtScale):
        return page_at_scale(page, repr(base.mm_per_unit))
    fitted = isinstance(options.page, str) or (options.page is None and isinstance(base, FittedPage))
    return fitted_page(page) if fitted else page


# Options that the verbs which make pictures share, each written once, and the command that such a verb becomes.

Option = Callable[[Command], Command]

DRAWING_FORMATS = ("svg", "ps", "eps", "pdf", "png", "tex", "dxf", "json")
"""What a drawing on a page is written as."""


def drawing_format(path: str, given: str | None) -> str:
    """The format to write a drawing in: the one given, or the suffix of the path. Bad usage for others, and an
    InputError, before the work, where what writes it is not installed."""
    from vectorplot.save import backend

    written = format_of(path, given, DRAWING_FORMATS)
    backend(written)
    return written


POSITIVE = between(0.0, math.inf)

LIGHTS = click.option(
    "--lights",
    type=light,
    multiple=True,
    # A tuple without lamps would be darkness; not a word about lamps leaves those of the scene.
    callback=lambda _context, _parameter, lamps: lamps or None,
    metavar="X,Y,Z[,WORD...]",
    help="Lamp in place of those of the scene; its intensity (0 to 1), a colour, parallel, fading; repeat it for more.",
)

EXPOSURE = click.option(
    "--exposure",
    type=exposure,
    metavar="FACTOR",
    help="To the intensities of all lights; fitted: the brightest face as bright as can be.  [default: of the scene]",
)

DEPTH_CUE = click.option(
    "--depth-cue",
    type=depth_cue,
    metavar="WORD,...[,N]",
    help="Lines thinner (width) or paler (shade) the farther away, in N steps (5); or none.  [default: of the scene]",
)

BACKGROUND = click.option(
    "--background",
    metavar="COLOUR",
    help="Behind the picture: a palette, a plain colour or #rrggbb.  [default: that of the scene or the style]",
)

CURVES = click.option(
    "--curves", type=of_option("curves"), default="bezier", help="How curves and circles of meshes leave."
)

TOLERANCE = click.option(
    "--tolerance",
    "tolerance_mm",
    type=of_option("tolerance_mm"),
    default=0.02,
    metavar="MM",
    help="For approximations.",
)

PROMISES = (
    click.option(
        "--off-by",
        metavar="ERROR",
        help="The error to keep, such as 0.01mm (of pixels 0.2px, of colours 4shades): accuracy is chosen for it.",
    ),
    click.option("--within", metavar="TIME", help="The time to take, such as 0.5s: as accurate as that allows."),
    click.option("--strict", is_flag=True, help="Write nothing, and fail, where --off-by or --within is not kept."),
)
"""An error or a time that a picture keeps."""

UNIT = click.option(
    "--unit",
    type=click.Choice(["mm", "cm", "m", "in"]),
    help="What a unit of the part is; all other lengths are in mm whatever it is.  [default: mm]",
)

TITLE = click.option("--title", default="", metavar="TEXT", show_default=False, help="Letters in the lower margin.")

FRAME = click.option("--frame", is_flag=True, help="A rectangle in the margin.")

TEXT = click.option(
    "--text",
    type=click.Choice([*TEXT_WORDS, "latex"]),
    default="strokes",
    help="Letters: strokes of the pen; in fonts of the reader; or, with a .pdf or .eps, in a .tex beside it.",
)

FONT = click.option(
    "--font", metavar="NAME|FILE", help="Of real text: a family that is installed, or, in SVG, a .ttf, .otf or .woff."
)

BUDGET = click.option(
    "--budget", type=POSITIVE, default=1.0, metavar="FACTOR", help="Times the usual work on a surface."
)

JOBS = click.option(
    "--jobs", type=click.IntRange(1), metavar="N", help="Threads to work on.  [default: as many as processors]"
)

EXPLAIN = click.option("--explain", is_flag=True, help="Print stages, times, counts, memory and errors on stderr.")

QUIET = click.option("-q", "--quiet", is_flag=True, help="No warnings, no progress bar.")

INPUT = click.argument("scene_file", type=click.Path(), nargs=-1, required=True, metavar="INPUT...")

EXAGGERATION = click.option(
    "--exaggeration",
    type=POSITIVE,
    metavar="FACTOR",
    help="Times that heights of a terrain file are as high.  [default: 1 where they are to be seen]",
)

MOLECULES = click.option(
    "--molecules",
    type=click.Choice(["ball-and-stick", "space-filling", "tube", "ribbon"]),
    help="How molecules are shown.  [default: ball-and-stick]",
)

PARTS = click.option(
    "--parts",
    type=click.Choice(["triangles", "exact"]),
    help="What lines of CAD parts are taken from: fine triangles, or the surfaces.  [default: triangles]",
)

OUT = click.option("-o", "--out", required=True, type=click.Path(), metavar="OUT", help="File to write; - for stdout.")

OUT_OR_FOLDER = click.option(
    "-o",
    "--out",
    required=True,
    type=click.Path(),
    metavar="OUT",
    help="File to write; - for stdout; FOLDER/ for a picture of each INPUT.",
)

_OF_THE_FILE = (
    "scene_file",
    "out",
    "format_",
    "exaggeration",
    "molecules",
    "parts",
    "quiet",
    "explain",
    "strict",
    "certificate",
    "tiles",
)
"""Parameters that say what is read and written, and what is said of it."""


def format_option(formats: Sequence[str]) -> Option:
    """``--format``, for a verb that writes these."""
    return click.option(
        "--format", "format_", type=click.Choice(formats), help="Format, where the name of OUT does not tell."
    )


def lines_option(meaning: str, *, default: str | None = "none", note: str = "") -> Option:
    """``--lines``, with what they are to the verb; note: what the help text says after the words."""
    return click.option("--lines", type=kinds, default=default, metavar="KIND,...", help=f"{meaning}: {KINDS}.{note}")


def crease_angle_option(meaning: str) -> Option:
    """``--crease-angle``, with what sharper edges are to the verb."""
    return click.option(
        "--crease-angle",
        "crease_angle_deg",
        type=of_option("crease_angle_deg"),
        default=25.0,
        metavar="DEG",
        help=meaning,
    )


def shadows_option(verb: str, meaning: str) -> Option:
    """``--shadows``, with the ways that a verb has of finding them; auto is one of them."""
    return click.option("--shadows", type=click.Choice(SHADOWS[verb]), default="auto", help=meaning)


@dataclass(frozen=True)
class Told:
    """What the user told a verb: camera, page (None: pictures of pixels have none), lines on all that is shown, cuts
    through it, how measures are written, and all else.

    rest: values by the keywords of the function of the package that has the verb's name.
    """

    camera: CameraOptions
    page: PageOptions | None
    added: LineOptions
    cuts: CutOptions
    measures: MeasureOptions
    rest: Mapping[str, Any]

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> Told:
        """What the options of a command say. Bad usage for options that contradict each other."""
        groups = (CameraOptions, PageOptions, LineOptions, CutOptions, MeasureOptions, WorkerOptions)
        taken = {field.name for group in groups for field in fields(group)}
        return cls(
            CameraOptions.of(options),
            PageOptions.of(options) if "page" in options else None,
            LineOptions.of(options),
            CutOptions.of(options),
            MeasureOptions.of(options) if "decimals" in options else MeasureOptions(),
            {name: value for name, value in options.items() if name not in taken},
        )

    def keywords(self, scene: Scene) -> dict[str, Any]:
        """Keywords of the verb's function for a scene: its camera and page but for what the user said, and the rest."""
        camera = camera_from(self.camera, scene)
        page = {} if self.page is None else {"page": page_from(self.page, scene)}
        return {"camera": camera, **page, **self.rest}

    @property
    def fineness(self) -> float | None:
        """How far parts of CAD systems may be off, as part of their extent: as far as the picture may, where they fill
        its page; None for pictures of pixels."""
        from vectorplot.scene.scene import Scene

        if self.page is None or "tolerance_mm" not in self.rest:
            return None
        page, allowed = page_from(self.page, Scene(())), self.rest["tolerance_mm"]
        if self.rest.get("off_by") is not None:
            from vectorplot.pictures.promises import off_by_of

            # What is no error to keep, the verb itself says.
            with suppress(InputError):
                allowed = off_by_of(self.rest["off_by"], "mm", "shades").get("mm", allowed)
        return float(allowed / math.hypot(page.width_mm, page.height_mm))

    def with_lines(self, scene: Scene) -> tuple[Scene, dict[str, Any]]:
        """A scene with the lines and the cuts that the user asked for, and the keywords of the verb's function, which
        draws them."""
        cut = self.measures.of_scene(self.cuts.of_scene(self.added.with_materials(scene)))
        keywords = self.keywords(cut)
        lined, kinds = self.added.in_scene(cut)
        if keywords.get("lines") is not None:
            keywords["lines"] = tuple(dict.fromkeys((*keywords["lines"], *kinds)))
        return lined, keywords


def check_overlaid(out: str, format_: str) -> None:
    """Bad usage for letters over what LaTeX takes for no picture."""
    from vectorplot.save import OVERLAID

    if out == "-" or format_ not in OVERLAID or not out.lower().endswith(f".{format_}"):
        raise click.UsageError("--text latex needs a name that ends in .pdf or .eps")


def _why_nothing(verb: str, scene: Scene, keywords: Mapping[str, Any]) -> str:
    """Why the picture of a scene is empty that a verb made with these keywords."""
    from vectorplot.pictures.nothing_seen import why_nothing
    from vectorplot.scene.page import Page

    size = keywords.get("size", (1, 1))
    page = keywords.get("page") or Page(size[0], size[1], 0.0)
    lines = keywords["lines"] if verb == "draw" else None
    return why_nothing(scene, keywords["camera"], page, fit=keywords["fit"], lines=lines)


_UNPROVED = ("panorama", "halo_mm", "thin_ends")
"""Options with which a drawing shows less than its lines, or has no camera."""


def _proof(params: Mapping[str, Any], told: Told, source: Source) -> Companion:
    """The certificate that is asked for. Errors: bad usage for options with which there is none."""
    path = params["certificate"]
    for name in _UNPROVED:
        if params[name]:
            raise click.UsageError(f"--certificate does not go with --{name.removesuffix('_mm').replace('_', '-')}")
    if path == "-" or os.path.realpath(path) == os.path.realpath(params["out"]):
        raise click.UsageError("--certificate needs a file of its own")

    def content(scene: Scene, made: Drawing | Image) -> bytes:
        from vectorplot.drawing.drawing import Drawing
        from vectorplot.testing.certificates import certificate

        assert isinstance(made, Drawing)
        lined, keywords = told.with_lines(scene)
        known = ("camera", "page", "lines", "crease_angle_deg", "style", "hidden")
        found = certificate(lined, made, **{name: keywords[name] for name in known})
        if found.unproved:
            text = f"{source.name}: the certificate does not prove {'; '.join(found.unproved)}"
            warnings.warn(text, InputWarning, stacklevel=2)
        return bytes(found)

    return Companion("certificate", path, content)


def with_options(*options: Option) -> Callable[[Command], Command]:
    """A decorator that gives a command these options, in this order."""
    return lambda command: reduce(lambda inner, option: option(inner), reversed(options), command)


def picture_verb(
    short_help: str, formats: Sequence[str], *options: Option
) -> Callable[[Callable[..., Drawing | Image]], click.Command]:
    """A decorator that makes a command of a function: a scene, and what the user told, become a picture.

    The function's name and docstring are the command's name and help; its keywords are those of Told, progress and
    explain. options: the verb's own, between those for INPUT, OUT and camera and those for work and reports; each is
    named as the keyword it becomes.
    """

    def command_of(verb: Callable[..., Drawing | Image]) -> click.Command:
        def asked(params: Mapping[str, Any]) -> dict[str, Any]:
            """What is to be pictured and how, as make_picture and picture_contents take it."""
            told = Told.of({name: value for name, value in params.items() if name not in _OF_THE_FILE})
            out, given, jobs = params["out"], params["format_"], told.rest["jobs"]
            written = drawing_format(out, given) if formats == DRAWING_FORMATS else format_of(out, given, formats)
            overlaid = told.rest.get("text") == "latex"
            if overlaid:
                told = replace(told, rest={**told.rest, "text": "real"})
                check_overlaid(out, written)

            def picture(scene: Scene, report: Report) -> Drawing | Image:
                lined, keywords = told.with_lines(scene)
                with kept_promise(report, keywords, strict=params["strict"], quiet=params["quiet"]) as explain:
                    made = verb(lined, **keywords, progress=report.progress, explain=explain)
                warn_of_nothing(source, made, lambda: _why_nothing(verb.__name__, lined, keywords))
                return made

            upright, fineness = told.camera.says_where(), told.fineness
            how = params["molecules"], params["parts"]
            source = Source(params["scene_file"], params["exaggeration"], upright, fineness, *how)
            said = {"source": source, "format_": written, "picture": picture, "jobs": jobs, "overlaid": overlaid}
            beside = [] if params.get("certificate") is None else [_proof(params, told, source)]
            beside += [] if params.get("tiles") is None else tiles_beside(params, written)
            return {**said, "beside": beside} if beside else said

        def content(params: Mapping[str, Any]) -> bytes:
            """What a file of pictures in a folder holds."""
            return picture_contents(name=Path(params["out"]).name, report=SILENT, **asked(params))[0]

        def made(params: Mapping[str, Any]) -> Drawing | Image:
            """The picture itself."""
            said = asked(params)
            return picture_made(said["source"], said["picture"], SILENT)

        @click.command(cls=PictureVerb, short_help=short_help, context_settings={"show_default": True})
        @with_options(
            INPUT,
            OUT_OR_FOLDER,
            format_option(formats),
            EXAGGERATION,
            MOLECULES,
            PARTS,
            *CAMERA_OPTIONS,
            *options,
            *LINE_OPTIONS,
            *CUT_OPTIONS,
            *MEASURE_OPTIONS,
            *PROMISES,
            BUDGET,
            JOBS,
            *WORKER_OPTIONS,
            EXPLAIN,
            QUIET,
        )
        @wraps(verb)
        def command(**params: Any) -> None:
            if is_folder(params["out"]):
                for name in ("certificate", "tiles"):
                    if params.get(name) is not None:
                        raise click.UsageError(f"--{name} is of one picture: OUT must be a file")
                make_pictures(verb.__name__, params, formats, asked)
                return
            if WorkerOptions.of(params).given:
                raise click.UsageError("--workers and --cluster make pictures into a folder: OUT must be one, FOLDER/")
            told = asked(params)
            make_picture(out=params["out"], quiet=params["quiet"], explain=params["explain"], **told)

        assert isinstance(command, PictureVerb)
        command.content = content
        command.made = made
        return command

    return command_of


# Options for how painted faces and their shadows look.

FACE_OPTIONS = (
    click.option(
        "--aura",
        "aura_mm",
        type=of_option("aura_mm"),
        default=0.0,
        metavar="MM",
        help="Width of the soft border of shadows.",
    ),
    click.option("--palette", type=of_option("palette"), default=32, metavar="N", help="Shades of every colour."),
    click.option("--flat", is_flag=True, help="One shade for every plane: no gradients, nothing looks round."),
)


# Options for how strokes look: a style, hidden lines, pens and dashes.

_STYLE, HIDDEN_LINES, _PEN, _DASH = (
    click.option(
        "--style",
        type=style,
        metavar="STYLE",
        help="plain, plotter, book, draft, blueprint, wireframe, depth-cue, or a file that ends in .toml."
        "  [default: what the scene says, or plain]",
    ),
    click.option(
        "--hidden",
        type=of_option("hidden"),
        help="How hidden lines look.  [default: none, or what the style says; of sheets dashed]",
    ),
    click.option(
        "--pen",
        "pens",
        type=pen,
        multiple=True,
        callback=said_or_none,
        metavar="[WHAT=]PEN,...",
        help="WIDTH, COLOUR or WIDTH:COLOUR of a kind of line (or hidden), an item, or ITEM.KIND; repeat it for more.",
    ),
    click.option(
        "--dash",
        "dashes",
        type=dash,
        multiple=True,
        callback=said_or_none,
        metavar="[WHAT=]DASH,GAP",
        help="Dashes of the same, in mm or with units (8pt,3pt), or none; repeat it for more.",
    ),
)
STROKE_OPTIONS = (_STYLE, HIDDEN_LINES, _PEN, _DASH)
"""Of lines where faces are not filled."""

OVERLAID_OPTIONS = (_STYLE, _PEN, _DASH)
"""Of lines on top of faces that are filled, where hidden lines are hidden."""

HALO = click.option(
    "--halo",
    "halo_mm",
    type=of_option("halo_mm"),
    default=0.0,
    metavar="MM",
    help="Gap beside lines that lie in front.",
)

REFLECTIONS = click.option(
    "--reflections",
    type=of_option("reflections"),
    default=1,
    metavar="N",
    help="How often one looks on from plane mirror to plane mirror; 0: they are plain faces.",
)

SHORTEST = click.option(
    "--shortest",
    "shortest_mm",
    type=of_option("shortest_mm"),
    metavar="MM",
    help="Shorter strokes of lines are left out.  [default: none, of drawings those below 0.05 that are alone]",
)

TILES = click.option(
    "--tiles",
    type=tiles,
    metavar="CxR",
    help="Also the page in C x R parts, with registration marks, as OUT-ROW-COLUMN.",
)

LAYERS = click.option(
    "--layers",
    type=layers,
    metavar="WORD,...",
    help="What shares a layer: kind, object, colour, or several of these; pen: all of a pen.  [default: kind, or what "
    "the style says]",
)
