"""Pictures for LaTeX: PGF/TikZ, and files with texts that LaTeX sets over them."""

from __future__ import annotations

import unicodedata
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Ints
from vectorplot.backends.page import Areas, Ink, PageStrokes, PageTexts, page_marks
from vectorplot.backends.shaded_triangles import grown, underlaps
from vectorplot.backends.svg import millimetres
from vectorplot.curves.arcs import EllipseArcs
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.fills import SEAM_MM
from vectorplot.drawing.formulas import FORMULA, checked_formula
from vectorplot.drawing.letters import clusters
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2
from vectorplot.scene.page import MM_PER_POINT, in_latex
from vectorplot.tolerances import ARC_DECIMAL_MM

# Colours in the words of PGF/TikZ.


def colour_of(packed: int) -> str:
    """A colour from its red, green and blue in one number."""
    return f"{{rgb,255:red,{packed >> 16};green,{packed >> 8 & 255};blue,{packed & 255}}}"


# Texts as nodes of PGF/TikZ: set by LaTeX in the document's fonts.

LEADING = 1.2
"""From line to line, in sizes of type."""

_ANCHORS = {0.0: "base west", 0.5: "base", 1.0: "base east"}

_SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\char34{}",
}

_GREEK = (
    "\\alpha \\beta \\gamma \\delta \\varepsilon \\zeta \\eta \\theta \\iota \\kappa \\lambda \\mu \\nu \\xi o \\pi"
    " \\rho \\varsigma \\sigma \\tau \\upsilon \\varphi \\chi \\psi \\omega"
)
_GREEK_CAPITALS = (
    "A B \\Gamma \\Delta E Z H \\Theta I K \\Lambda M N \\Xi O \\Pi P \\Sigma T \\Upsilon \\Phi X \\Psi \\Omega"
)
_RELATIONS = (
    "\\pm \\mp \\times \\cdot \\leq \\geq \\neq \\equiv \\propto \\infty \\surd \\subset \\cup \\supset \\cap"
    " \\in \\rightarrow \\uparrow \\leftarrow \\downarrow \\partial \\nabla \\int \\div \\parallel \\perp \\angle"
    " \\exists \\oslash ^\\circ - ' ''"
)
_SIGNS = {
    **dict(zip("αβγδεζηθικλμνξοπρςστυφχψω", _GREEK.split(), strict=True)),
    **dict(zip("ΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡΣΤΥΦΧΨΩ", _GREEK_CAPITALS.split(), strict=True)),
    **dict(zip("±∓×·≤≥≠≡∝∞√⊂∪⊃∩∈→↑←↓∂∇∫÷∥⊥∠∃⌀°−′″", _RELATIONS.split(), strict=True)),
}
"""Characters that LaTeX's usual fonts lack, in the words of its formulas."""

_OVER = {
    "\u0302": "\\hat",
    "\u0303": "\\tilde",
    "\u0304": "\\bar",
    "\u0307": "\\dot",
    "\u0308": "\\ddot",
    "\u20d7": "\\vec",
}
"""Accents over letters that no character has with them."""


def text_nodes(texts: PageTexts) -> bytes:
    """A node for each line, of its size of type, on the line that its letters stand on."""
    lines = []
    for (x, y, size, turn, anchor, colour, string), word in zip(texts.lines(texts.strings), texts.latex, strict=True):
        points = size / MM_PER_POINT
        font = word or f"\\fontsize{{{points:.4g}}}{{{LEADING * points:.4g}}}\\selectfont"
        turned = f",rotate={turn:g}" if turn else ""
        head = f"inner sep=0pt,outer sep=0pt,anchor={_ANCHORS[anchor]},text={colour_of(int(colour[1:], 16))}{turned}"
        lines.append(f"\\node[{head},font={font}] at ({x / 1000.0:.10g},{y / 1000.0:.10g}) {{{latex(string)}}};\n")
    return "".join(lines).encode("utf-8")


def latex(text: str) -> str:
    """The text for LaTeX: formulas between dollars stay as they are, all else is read as it stands; \\$ is a dollar.

    Errors: InputError for a formula that is more than mathematics.
    """
    parts = FORMULA.split(text)
    return "".join(
        f"${checked_formula(part)}$" if k % 2 else _plain(part.replace(r"\$", "$")) for k, part in enumerate(parts)
    )


def _plain(text: str) -> str:
    return "".join(map(_accented, clusters(text)))


def _accented(cluster: str) -> str:
    found = _letter(cluster[0])
    for mark in cluster[1:]:
        found = f"\\ensuremath{{{_OVER[mark]}{{{found}}}}}" if mark in _OVER else found + mark
    return found


def _letter(character: str) -> str:
    if character in _SPECIAL:
        return _SPECIAL[character]
    if character in _SIGNS:
        return f"\\ensuremath{{{_SIGNS[character]}}}"
    form, _, codes = unicodedata.decomposition(character).partition(" ")
    if form in ("<super>", "<sub>"):
        inner = "".join(_letter(chr(int(code, 16))) for code in codes.split())
        return f"\\text{form[1:-1]}script{{{inner}}}"
    return character


# What all pictures have: units, a box as large as the page, and an end.

_END_OF_PICTURE = b"\\end{tikzpicture}%\n"
"""Without the blank that the end of a line is in TeX: pictures side by side take no more than their widths."""


def _units(drawing: Drawing) -> str:
    """The units of coordinates: mm, or parts of the width that LaTeX knows; letters and pens do not grow with it."""
    width = in_latex(drawing.width_mm)
    unit = f"{{{width}/{drawing.width_mm:.10g}}}" if width else "1mm"
    return f"x={unit},y={unit}"


def _page_box(drawing: Drawing) -> str:
    width = in_latex(drawing.width_mm) or f"{round(drawing.width_mm, 3):.10g}"
    return f"\\useasboundingbox (0,0) rectangle ({width},{round(drawing.height_mm, 3):.10g});\n"


# A picture in a file of its own, and its texts for LaTeX to set over it.


def without_texts(drawing: Drawing) -> Drawing:
    """The drawing with all its other marks."""
    layers = (
        replace(layer, marks=tuple(mark for mark in layer.marks if not isinstance(mark, Texts)))
        for layer in drawing.layers
    )
    return replace(drawing, layers=tuple(layers))


def overlay_bytes(drawing: Drawing, picture: str) -> bytes:
    r"""A tikzpicture of the size of the page: the file of this name, and the texts of the drawing as nodes over it.

    picture: the name that \includegraphics finds the rest of the drawing by, whose box is the page.
    """
    page = page_marks(drawing)
    width = in_latex(drawing.width_mm)
    how = [*(["hiresbb"] if picture.endswith(".eps") else []), *([f"width={width}"] if width else [])]
    options = f"[{','.join(how)}]" if how else ""
    head = (
        "% \\usepackage{tikz}\n"
        f"\\begin{{tikzpicture}}[{_units(drawing)}]\n"
        f"{_page_box(drawing)}"
        "\\node[inner sep=0pt,outer sep=0pt,anchor=south west] at (0,0)"
        f" {{\\includegraphics{options}{{\\detokenize{{{picture}}}}}}};\n"
    )
    nodes = b"".join(text_nodes(part) for ink in page.inks for part in ink.parts if isinstance(part, PageTexts))
    return head.encode("utf-8") + nodes + _END_OF_PICTURE


# A picture for LaTeX documents, in the commands of PGF/TikZ.

ARC_DIGITS = 5
"""Decimals of the numbers of arcs, which TeX reckons with no more of."""

LARGEST_PAGE_MM = 5000.0
"""TeX knows no lengths of more than 16383 points."""

LONGEST_PATH = 1000
"""Points after which an open polyline goes on as another path: TeX keeps a path in its memory as a whole."""

# What stands before and after points; each is one byte until the text is whole.
_TOKENS = {
    1: b"\\draw ",
    2: b" -- ",
    3: b" .. controls ",
    4: b" and ",
    5: b" .. ",
    6: b";\n",
    7: b" -- cycle;\n",
    8: b" ",
    9: b" -- cycle",
    11: b"\n-- ",
    12: b"\n.. controls ",
}
_BEGIN, _LINE, _FIRST, _SECOND, _END, _STOP, _RING, _NEXT, _AROUND, _NEW_LINE, _NEW_CURVE = _TOKENS
_BREAK = 8
"""Points of a line of the text."""


def tikz_bytes(drawing: Drawing) -> bytes:
    """The drawing as a tikzpicture for a LaTeX document.

    Source: Tantau, TikZ and PGF manual.
    """
    if max(drawing.width_mm, drawing.height_mm) > LARGEST_PAGE_MM:
        size = f"{drawing.width_mm:g} x {drawing.height_mm:g} mm"
        raise InputError(f"page of {size}: TeX takes at most {LARGEST_PAGE_MM:.0f} mm")
    page = page_marks(drawing)
    title = "".join(c if 32 <= ord(c) < 127 else "?" for c in page.title)
    head = f"% {title}\n" if title else ""
    head += f"\\begin{{tikzpicture}}[{_units(drawing)},line cap=round,line join=round]\n{_page_box(drawing)}"
    body = b"".join(_layer(ink) for ink in page.inks)
    return head.encode("ascii") + body + _END_OF_PICTURE


def _layer(ink: Ink) -> bytes:
    parts = [_part(part, ink.pen.width_mm) for part in ink.parts]
    label = "".join(c if 32 <= ord(c) < 127 else "?" for c in ink.label)
    pen = f"draw={colour_of(int(ink.pen.colour[1:], 16))},line width={ink.pen.width_mm:.6g}mm"
    return f"% {label}\n\\begin{{scope}}[{pen}]\n".encode("ascii") + b"".join(parts) + b"\\end{scope}\n"


def _part(part: PageStrokes | Areas | PageTexts, pen_mm: float) -> bytes:
    if isinstance(part, PageTexts):
        return text_nodes(part)
    return _areas(part, pen_mm) if isinstance(part, Areas) else _strokes(part) + _arcs(part)


def _arcs(lines: PageStrokes) -> bytes:
    """Strokes that are arcs, as such: those of circles, or of ellipses, which may be turned."""
    arcs = lines.arcs
    wide, high = np.hypot(*arcs.first.T), np.hypot(*arcs.second.T)
    is_round = np.abs(wide - high) < ARC_DECIMAL_MM
    tilt = np.degrees(arctan2(arcs.first[:, 1], arcs.first[:, 0])).round(ARC_DIGITS) + 0.0
    # Where the second axis lies clockwise from the first one angles run the other way.
    sense = np.where(arcs.first[:, 0] * arcs.second[:, 1] > arcs.first[:, 1] * arcs.second[:, 0], 1.0, -1.0)
    ends = np.degrees(np.stack((arcs.start, arcs.end))) * sense + np.where(is_round, tilt, 0.0)
    begin = lines.microns[lines.offsets[:-1][arcs.stroke]] / 1000.0
    columns = (arcs.centre, begin, ends.T, np.stack((wide, high), axis=1))
    rows = np.concatenate(columns, axis=1).round(ARC_DIGITS) + 0.0
    found = []
    for row, turn, same, whole in zip(
        rows.tolist(), tilt.tolist(), is_round.tolist(), lines.closed[arcs.stroke].tolist(), strict=True
    ):
        cx, cy, x, y, start, end, a, b = (f"{number:.10g}" for number in row)
        radii = f"radius={a}" if same else f"x radius={a},y radius={b}"
        turned = "" if same or turn == 0.0 else f"rotate={turn:.10g}"
        if whole:
            found.append(f"\\draw ({cx},{cy}) circle[{','.join(filter(None, (radii, turned)))}];\n")
            continue
        arc = f"arc[start angle={start},end angle={end},{radii}]"
        found.append(f"\\draw ({x},{y}) {f'{{[{turned}] {arc}}}' if turned else arc};\n")
    return "".join(found).encode("ascii")


def _strokes(lines: PageStrokes) -> bytes:
    """All strokes but arcs as paths that are drawn."""
    is_arc = np.zeros(len(lines.offsets) - 1, dtype=np.bool_)
    is_arc[lines.arcs.stroke] = True
    kept = ~np.repeat(is_arc, np.diff(lines.offsets))
    lines = PageStrokes(
        lines.microns[kept],
        ragged.offsets(np.diff(lines.offsets)[~is_arc]),
        lines.closed[~is_arc],
        lines.curved[~is_arc],
        EllipseArcs.none(),
    )
    sizes = np.diff(lines.offsets)
    place, owner = ragged.place(sizes), ragged.owner(sizes)
    count, curved = sizes[owner], lines.curved[owner]
    step = (place - 1) % 3
    breaks = place % _BREAK == 0
    straight = np.where(breaks, _NEW_LINE, _LINE)
    bent = np.choose(step, [np.where(place % (3 * _BREAK) == 1, _NEW_CURVE, _FIRST), _SECOND, _END])
    before = np.where(place == 0, _BEGIN, np.where(curved, bent, straight))
    last = place == count - 1
    after = np.where(last, np.where(lines.closed[owner], _RING, _STOP), 0)
    index = np.arange(len(place))
    cut = np.flatnonzero(~curved & ~lines.closed[owner] & (place % LONGEST_PATH == 0) & (place > 0) & ~last)
    # The point at which a path is cut ends one and begins the next.
    index = np.insert(index, cut, cut)
    before, after = np.insert(before, cut, _LINE), np.insert(after, cut, _STOP)
    before[cut + np.arange(len(cut)) + 1] = _BEGIN
    return _text(before, lines.microns[index], after)


def _text(before: Ints, microns: Ints, after: Ints) -> bytes:
    """Points in mm with what stands before and after them, by number."""
    many = len(microns)
    signs = [np.full(many, ord(sign), np.uint8) for sign in "(,)"]
    x, y = (millimetres(column) for column in microns.T)
    table = np.column_stack((before.astype(np.uint8), signs[0], x, signs[1], y, signs[2], after.astype(np.uint8)))
    chosen: NDArray[np.uint8] = table[table != 0]
    text = chosen.tobytes()
    for number, words in _TOKENS.items():
        text = text.replace(bytes((number,)), words)
    return text


def _areas(areas: Areas, pen_mm: float) -> bytes:
    """Filled polygons, those of one colour that follow each other in one path; groups are blended as wholes."""
    if not len(areas):
        return b""
    alone = np.concatenate((areas.group_ends.reshape(-1), areas.part_ends.reshape(-1)))
    shaded = np.flatnonzero(areas.shaded)
    alone = np.concatenate((alone, shaded, shaded + 1))
    starts = np.union1d(areas.runs[:-1], alone[alone < len(areas)]).astype(np.intp)
    laps = underlaps(areas)
    stroked = np.logical_or.reduceat(laps.open, starts).tolist()
    microns, offsets, parts = grown(areas, laps)
    colours = np.add.reduceat(areas.colours.astype(np.float64), areas.offsets[:-1]) / areas.sizes[:, None]
    packed = (np.rint(colours).astype(np.intp)[starts] @ (65536, 256, 1)).tolist()
    opacity, line = areas.own_opacity[starts].tolist(), (areas.sizes[starts] == 2).tolist()
    bounds = np.append(parts[starts], len(offsets) - 1).tolist()
    bodies = [
        _polygons(microns, offsets[first : last + 1], closed=not is_line)
        for first, last, is_line in zip(bounds[:-1], bounds[1:], line, strict=True)
    ]
    heads = [
        f"\\draw[draw={colour_of(colour)},draw opacity={clear:.3g},line width={pen_mm:.6g}mm]"
        if is_line
        else f"\\path[nonzero rule,fill={colour_of(colour)},fill opacity={clear:.3g}"
        + (f",draw={colour_of(colour)},line width={SEAM_MM:g}mm]" if seam else ",draw=none]")
        for colour, clear, is_line, seam in zip(packed, opacity, line, stroked, strict=True)
    ]
    texts = [head.encode("ascii") + body for head, body in zip(heads, bodies, strict=True)]
    for rows, blended in ((areas.part_ends, False), (areas.group_ends, True)):
        begins, ends = np.searchsorted(starts, rows.T).tolist() if len(rows) else ([], [])
        for (first, last), begin, end in zip(rows.tolist(), begins, ends, strict=True):
            texts[begin] = _clipped(areas, first, last, blended) + texts[begin]
            texts[end - 1] += b"\\end{scope}\n"
    return b"".join(texts)


def _clipped(areas: Areas, first: int, last: int, blended: bool) -> bytes:
    """The beginning of a scope that is clipped to the outline of polygons from first to before last, blended or not."""
    corners, offsets = areas.outline(first, last)
    faint = f",transparency group,opacity={areas.opacity[first]:.3g}" if blended else ""
    clip = _polygons(np.rint(corners).astype(np.int64), offsets, closed=True)
    return f"\\begin{{scope}}[even odd rule{faint}]\n\\clip".encode("ascii") + clip


def _polygons(microns: Ints, offsets: Ints, *, closed: bool) -> bytes:
    """Polygons as the rest of a command."""
    sizes = np.diff(offsets)
    place = ragged.place(sizes)
    before = np.where(place == 0, _NEXT, np.where(place % _BREAK == 0, _NEW_LINE, _LINE))
    after = np.where(place == np.repeat(sizes, sizes) - 1, _AROUND if closed else 0, 0)
    after[-1:] = _RING if closed else _STOP
    return _text(before, microns[offsets[0] : offsets[-1]], after)
