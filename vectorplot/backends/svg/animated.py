"""Several drawings as one SVG that moves by itself: SMIL, no script."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from xml.sax.saxutils import escape

from vectorplot.backends.page.page_texts import plain_text
from vectorplot.backends.svg.svg_document import svg_bytes
from vectorplot.drawing.drawing import Drawing

_SVG = re.compile(rb"^(.*?<svg\b[^>]*>)(?:<defs ?/>)?(.*)</svg>\s*$", re.DOTALL)
_TIME_DECIMALS = 6


def animated_svg_bytes(drawings: Iterable[Drawing], fps: float, title: str = "") -> bytes:
    """The drawings as the bytes of an SVG file that shows one after the other, again and again.

    Parameters
    ----------
    drawings : iterable of Drawing
        The frames, on pages of one size.
    fps : float
        Frames a second, positive.
    title : str
        That of the file.

    Returns
    -------
    bytes
        A group for each picture, with its layers, and in it when it is visible. A picture that comes several times is
        in the file once. Readers that know no animation show the first frame.

    Raises
    ------
    InputError
        For what ps_bytes refuses.

    Notes
    -----
    The animation is declared in the language of SVG (SMIL): it runs where scripts do not, as in an image of a page.

    Degenerate: no drawings are an empty picture.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import backends
    >>> pages = [vp.Drawing(100, 80, ()), vp.Drawing(100, 80, (vp.Layer("visible", vp.Pen(), ()),))]
    >>> backends.animated_svg_bytes(pages, fps=2).count(b'dur="1s"')
    2
    """
    head = b'<?xml version="1.0" encoding="utf-8"?>\n<svg xmlns="http://www.w3.org/2000/svg" width="0" height="0">'
    shown: dict[bytes, list[int]] = {}
    count = 0
    for drawing in drawings:
        found = _SVG.match(svg_bytes(replace(drawing, title="")))
        if found is None:  # pragma: no cover
            raise AssertionError("an SVG without a root")
        head = found[1] if not count else head
        shown.setdefault(found[2], []).append(count)
        count += 1
    name = plain_text(title)
    parts = [head, f"<title>{escape(name)}</title>".encode() if name else b"", b"\n"]
    for body, frames in shown.items():
        hidden = b"" if frames[0] == 0 else b' visibility="hidden"'
        parts += [b"<g", hidden, b">", _visible(frames, count, fps), b"\n", body.strip(), b"\n</g>\n"]
    return b"".join([*parts, b"</svg>\n"])


def _visible(frames: list[int], count: int, fps: float) -> bytes:
    """The animation of a group that is visible in some frames of so many."""
    if len(frames) == count:
        return b""
    among = set(frames)
    times, values = [], []
    for frame in sorted({0, *frames, *(frame + 1 for frame in frames if frame + 1 < count)}):
        times.append(f"{frame / count:.{_TIME_DECIMALS}g}")
        values.append("visible" if frame in among else "hidden")
    said = f'values="{";".join(values)}" keyTimes="{";".join(times)}" dur="{count / fps:.{_TIME_DECIMALS}g}s"'
    return f'<animate attributeName="visibility" calcMode="discrete" {said} repeatCount="indefinite"/>'.encode()
