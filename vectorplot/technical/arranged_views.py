"""Where views of a part stand on a sheet: in line with each other, with the free room spread evenly around them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.sheets.drawing_frames import drawing_space
from vectorplot.drawing.sheets.drawing_scales import DrawingScale
from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.scene.pages.page import Page
from vectorplot.scene.point_of_view import page_of
from vectorplot.scene.scene import Scene

THIRD_ANGLE = {"front": (0, 0), "right": (1, 0), "left": (-1, 0), "top": (0, 1), "bottom": (0, -1), "back": (2, 0)}
"""Column and row of main views, rightwards and upwards from the front, where each is on the side it is seen from."""

FIRST_ANGLE = {view: (x if view == "back" else -x, -y) for view, (x, y) in THIRD_ANGLE.items()}
"""The same where each is on the side opposite to that it is seen from."""

PICTORIAL = ((1, -1), (1, 1), (-1, -1), (-1, 1), (1, 0), (0, -1), (-1, 0), (0, 1), (0, 0), (2, 0))
"""Where an isometric view may stand, the best first."""

GAP_MM = 8.0
"""No less is between views, and between them and what is around them."""

Cell = tuple[int, int]


@dataclass(frozen=True, eq=False)
class SheetView:
    """A view on a sheet.

    name: of the main view, or the letter of a section; cell: column and row; world (2,2): how far what it shows reaches
    from the middle of the part, to the left and down, and to the right and up, in units of the world; mm (2,2): how far
    what is around it reaches beyond that.
    """

    name: str
    camera: Camera
    cell: Cell
    world: Floats
    mm: Floats

    def reach_mm(self, factor: float) -> Floats:
        """(2,2) how far it reaches on paper, where a unit of the world is so many mm."""
        return factor * self.world + self.mm


def cells_of(names: Sequence[str], sections: Sequence[str], first_angle: bool) -> dict[str, Cell]:
    """The cells of main views, and of sections, each by the letter and with the main view that it is like.

    sections: that view for each. Empty columns and rows take no room.
    """
    places = FIRST_ANGLE if first_angle else THIRD_ANGLE
    cells = {name: places[name] for name in names if name in places}
    columns, rows = ({cell[axis] for cell in cells.values()} for axis in (0, 1))
    if "iso" in names:
        free = [cell for cell in PICTORIAL if cell not in cells.values()]
        cells["iso"] = min(free, key=lambda cell: (cell[0] not in columns) + (cell[1] not in rows))
    for number, like in enumerate(sections):
        row = cells.get(like, (0, 0))[1]
        # Beyond all that is in its row.
        last = max((x for x, y in cells.values() if y == row), default=-1)
        cells[LETTERS[number]] = (last + 1, row)
    across, upwards = (sorted({cell[axis] for cell in cells.values()}) for axis in (0, 1))
    return {name: (across.index(x), upwards.index(y)) for name, (x, y) in cells.items()}


LETTERS = "ABCDEFGHJKLMNPRSTUVWXYZ"
"""The names of sections, without letters that look like figures."""


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Views in the columns and rows of a space (2,2) on the page, in mm."""

    views: tuple[SheetView, ...]
    space: Floats

    def largest_factor(self) -> float:
        """The largest factor at which all views have room: infinite for views without extent, and negative where there
        is no room at all."""
        factors = [math.inf]
        for axis in (0, 1):
            sizes = self._bands(axis, lambda view: view.world)
            mm = self._bands(axis, lambda view: view.mm)
            left = float(np.ptp(self.space[:, axis])) - (len(sizes) + 1) * GAP_MM - float(mm.sum())
            whole = float(sizes.sum())
            factors.append(left / whole if whole > 0.0 else math.copysign(math.inf, left))
        return min(factors)

    def middles(self, factor: float) -> list[tuple[float, float]]:
        """Where the middle of the part is in every view."""
        found = []
        for axis in (0, 1):
            bands = self._bands(axis, lambda view: view.reach_mm(factor))
            low = float(self.space[0, axis])
            gap = (float(np.ptp(self.space[:, axis])) - float(bands.sum())) / (len(bands) + 1)
            ends = low + gap * np.arange(1, len(bands) + 1) + np.cumsum(bands.sum(axis=1)) - bands[:, 1]
            found.append(ends.tolist())
        return [(found[0][view.cell[0]], found[1][view.cell[1]]) for view in self.views]

    def _bands(self, axis: int, reach: Callable[[SheetView], Floats]) -> Floats:
        """(k,2) how far the columns, or rows, reach to both sides of the middle of the part."""
        cells = np.array([view.cell[axis] for view in self.views])
        most = np.zeros((int(cells.max()) + 1, 2))
        np.maximum.at(most, cells, np.array([reach(view)[:, axis] for view in self.views]))
        return most


def roomiest(page: Page | str, views: tuple[SheetView, ...], frame: bool, below: float) -> tuple[Page, Arrangement]:
    """The sheet, and the views on it; a named one lies as gives them more room. below: the mm below the views that the
    title block takes."""
    given = page_of(page, Scene(()))
    turned = isinstance(page, str) and len(page.split()) == 1 and "x" not in page.lower()
    papers = (given.landscape, given) if turned else (given,)
    above = np.array([(0.0, below), (0.0, 0.0)])
    tried = [(paper, Arrangement(views, drawing_space(paper, frame) + above)) for paper in papers]
    paper, arranged = max(tried, key=lambda pair: pair[1].largest_factor())
    if not arranged.largest_factor() > 0.0:
        taken = " above the title block" if below else ""
        raise InputError(f"page {paper.width_mm:g}x{paper.height_mm:g} mm: no room for {len(views)} views{taken}")
    return paper, arranged


def fitting_scale(asked: DrawingScale | None, arranged: Arrangement, paper: Page) -> DrawingScale:
    """The scale asked for, or the largest standard one that fits. Errors: InputError for one that is too large."""
    room = arranged.largest_factor()
    if asked is None:
        return DrawingScale.largest_standard(room) if math.isfinite(room) else DrawingScale(1.0, 1.0)
    if asked.factor > room:
        largest = DrawingScale.largest_standard(room)
        raise InputError(
            f"scale {asked}: too large for {len(arranged.views)} views on {paper.width_mm:g}x{paper.height_mm:g} mm; "
            f"the largest standard scale that fits is {largest}"
        )
    return asked
