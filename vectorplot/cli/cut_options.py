"""Options that cut what is shown, or move its parts apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.options import at_least, direction, number
from vectorplot.errors import InputError

if TYPE_CHECKING:
    from vectorplot.geometry.cameras.camera import Point
    from vectorplot.scene.scene import Scene


def cut_text(text: str) -> str:
    """The conditions of a cut, as they are; bad usage where they are none."""
    from vectorplot.scene.cuts.cut import Cut

    try:
        Cut.of(text)
    except InputError as error:
        raise click.BadParameter(str(error)) from None
    return text


def _explosion(text: str) -> tuple[Point] | tuple[Point, float]:
    """AXIS or AXIS,FACTOR; an axis is x, y, z, or X,Y,Z."""
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
    click.option(
        "--explode",
        type=_explosion,
        metavar="AXIS[,FACTOR]",
        help="Parts moved apart along x, y, z or X,Y,Z; z,1.5 is z.",
    ),
)


@dataclass(frozen=True)
class CutOptions:
    """The cuts that the user asked for, and how parts are moved apart."""

    cut: tuple[str, ...] = ()
    cut_away: str = "gone"
    cut_colour: str | None = None
    cut_spacing: float | None = None
    cut_angle: float = 45.0
    explode: tuple[Point] | tuple[Point, float] | None = None

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> CutOptions:
        """What a command with CUT_OPTIONS was told."""
        return cls(**{field.name: options[field.name] for field in fields(cls)})

    def of_scene(self, scene: Scene) -> Scene:
        """The scene with these cuts. Errors: InputError for unknown colours."""
        from vectorplot.scene.cuts.cut import Cut
        from vectorplot.scene.cuts.exploded import exploded, shown_apart

        scene = shown_apart(scene) if self.explode is None else exploded(scene, *self.explode)
        spelled = partial(Cut.of, away=self.cut_away, colour=self.cut_colour)
        hatched = partial(spelled, spacing_mm=self.cut_spacing, angle_deg=self.cut_angle)
        cuts = tuple(hatched(text) for text in self.cut)
        return replace(scene, cuts=scene.cuts + cuts) if cuts else scene
