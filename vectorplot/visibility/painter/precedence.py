"""What is known before any comparison of what has to be drawn before what."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.visibility.painter.image_faces import ImageFaces


@dataclass(frozen=True, eq=False)
class Precedence:
    """What is known of the order of one item's faces: of two that overlap in the image, which comes first.

    Parameters
    ----------
    face : (n,) array of int
        Faces of the item, by their numbers in the view, each one once, and -1 for gaps, which hide nothing but pass on
        what comes before what. The item's other faces are compared with all.
    before, after : (k,) array of int
        Positions in face: before[k] has to be drawn before after[k].

    Notes
    -----
    Faces that no chain of demands links, or that make circles, do not overlap or have to be compared.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import scene, visibility
    >>> corners = [(x, y, z) for z in (0, 1, 2) for x, y in ((0, 0), (4, 0), (4, 4), (0, 4))]
    >>> cards = vp.Mesh.from_polygons(corners, [(8, 9, 10, 11), (0, 1, 2, 3), (4, 5, 6, 7)])
    >>> view = scene.look(vp.Scene((vp.Item("cards", cards),)), vp.Camera((2, 2, 9)))
    >>> upwards = visibility.Precedence.of_order(np.array([1, 2, 0]))
    >>> visibility.painters_order(view, known={0: upwards}).faces.source.tolist()
    [1, 2, 0]
    """

    face: Ints
    before: Ints
    after: Ints

    @classmethod
    def of_order(cls, order: Ints) -> Precedence:
        """All faces (n,) of an item, back to front."""
        number = np.arange(len(order))
        return cls(order, number[:-1], number[1:])


@dataclass(frozen=True, eq=False)
class Nodes:
    """Precedences of several items among things that are drawn: of_face (f,) the thing of each face of the view;
    owner (m,): the item of each thing more, which stands for a gap or a face that is not drawn; before, after (k,)
    things."""

    of_face: Ints
    owner: Ints
    before: Ints
    after: Ints


def among_things(known: Mapping[int, Precedence], faces: ImageFaces, thing: Ints, count: int, face_count: int) -> Nodes:
    """The precedences of items as demands on things.

    thing (n,): that of each image face, of count ones in all; face_count: of the view.
    """
    of_face = np.full(face_count, -1, dtype=np.intp)
    of_face[faces.source] = thing
    before, after, owner = [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.intp)]
    for item, precedence in known.items():
        node = np.where(precedence.face >= 0, of_face[precedence.face], -1)
        more = np.flatnonzero(node < 0)
        node[more] = count + np.arange(len(more))
        count += len(more)
        owner.append(np.full(len(more), item, dtype=np.intp))
        before.append(node[precedence.before])
        after.append(node[precedence.after])
    return Nodes(of_face, np.concatenate(owner), np.concatenate(before), np.concatenate(after))
