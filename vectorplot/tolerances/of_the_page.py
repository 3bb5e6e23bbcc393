"""Millimetres on the page."""

from __future__ import annotations

COINCIDENT_MM = 1e-4
"""Strokes that are no further apart than this lie on each other, ends on the same point: a tenth of what a file's
numbers keep."""

COLLINEAR_MM = 1e-4
"""A point that is no further from the straight line between its neighbours is left out. So a stroke moves by less than
a millionth of a picture on a sheet of paper: what is drawn stays as visible as it was found to be."""

TOUCHING_AT_MM = 1e-4
"""Curves of a sheet of paper's size that touch in four points at once are so close over the length below which a shared
part only touches; where points are known less well, over more of it, by the fourth root."""

EXACT_MM = 1e-4
"""A Bézier curve that is no farther off a curve, at most, is the curve: a tenth of what files keep."""

GRID_MM = 1e-4
"""Corners of regions lie on a grid of so many millimetres; the scene's own have digits to spare."""

CLEARANCE_MM = 1e-3
"""What is cut away is wider by this than what lies above it: of two sides that nearly coincide nothing is left between
them, which would be drawn as wide as a seam."""

SIDE_BY_SIDE_MM = 0.01
"""Transparent polygons that overlap in strips narrower than this lie side by side: a strip of it is a tenth of a pixel
of a screen wide at most, on most of them less."""

ARC_DECIMAL_MM = 1e-5
"""Unit of the numbers of arcs: their radii and centres are kept better than their ends."""

HATCH_GAP_MM = 0.005
"""Strokes of a hatching on one line that are no further apart are one: between the parts of a region that was cut to
pieces there are gaps of some GRID_MM, and no pen shows them."""

STEP_BORDER_MM = 0.005
"""Borders between steps of shade are known to a part of a triangle's size: points that are no further from the chord of
their neighbours say nothing, and no pen shows them."""
