"""What a scene says of the pens it is drawn with."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from vectorplot.errors import InputError
from vectorplot.words import LineKind, nearest

HIDDEN = "hidden"
"""The kind of what something is in front of, whatever else it is."""

FRAME = "frame"
"""What draws the frame of a page and its title: a kind that no line of a scene is of."""

PEN_KINDS = (*(kind.word for kind in LineKind), HIDDEN, FRAME)
"""The kinds that pens are for."""

WIDEST_MM = 25.0
"""No pen and no brush that plotters take is wider: 50 is 0.50 without its point."""

LONGEST_MM = 1000.0
"""No dash and no gap is longer."""

FINEST_MM = 0.01
"""No pen is finer, or draws a shorter dash."""


@dataclass(frozen=True)
class Inks:
    """The style, the pens and the dashes that a scene asks for; what `vp.draw` is told comes before them.

    Parameters
    ----------
    style : str, optional
        The name of a style, or a file that ends in .toml; draw's own where None.
    pens : mapping of str to str
        As of `vp.draw`: kinds of lines, items, or item.kind, and WIDTH, COLOUR or WIDTH:COLOUR.
    dashes : mapping of str to str
        As of `vp.draw`: the same, and DASH,GAP or none.

    Notes
    -----
    Draw says what is no pen, no style, and no item of the scene.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import Inks
    >>> scene = vp.Scene((vp.Item("die", box((1, 1, 1))),), inks=Inks(pens={"contour": "0.8:red"}))
    >>> next(layer.pen.width_mm for layer in vp.draw(scene).layers if layer.name == "contour")
    0.8
    """

    style: str | None = None
    pens: Mapping[str, str] = field(default_factory=dict)
    dashes: Mapping[str, str] = field(default_factory=dict)

    def renamed(self, names: Mapping[str, str]) -> Inks:
        """The same of a scene whose items have other names.

        Parameters
        ----------
        names : mapping of str to str
            The new names by the old ones.

        Returns
        -------
        Inks
            With targets of the new names.

        Examples
        --------
        >>> from vectorplot.scene import Inks
        >>> Inks(pens={"a.crease": "0.2", "contour": "1"}).renamed({"a": "b"}).pens
        {'b.crease': '0.2', 'contour': '1'}
        """
        pens, dashes = (
            {_joined(*_renamed(target, names)): said for target, said in own.items()}
            for own in (self.pens, self.dashes)
        )
        return replace(self, pens=pens, dashes=dashes)


def target_of(text: str) -> tuple[str | None, str | None]:
    """The kind and the item that a pen is for: None for all of them."""
    if not text:
        return None, None
    if text.lower() in PEN_KINDS:
        return text.lower(), None
    item, dot, kind = text.rpartition(".")
    if dot and item and kind.lower() in PEN_KINDS:
        return kind.lower(), item
    return None, text


def unknown_item(item: str, items: Iterable[str]) -> InputError:
    """The error for an item that is not among those of a scene, with the word that may be meant."""
    word, known = item.lower(), {name.lower(): name for name in items}
    near = nearest(word, PEN_KINDS) or known.get(word, known.get(nearest(word, known) or "", ""))
    hint = f" (did you mean {near!r}?)" if near else ""
    return InputError(f"pen {item!r}: no kind of line, and no item{hint}")


def _renamed(target: str, names: Mapping[str, str]) -> tuple[str | None, str | None]:
    kind, item = target_of(target)
    return kind, None if item is None else names.get(item, item)


def _joined(kind: str | None, item: str | None) -> str:
    return ".".join(part for part in (item, kind) if part is not None)
