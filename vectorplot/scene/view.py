"""A scene as one camera sees it: all faces in one mesh, in the camera's axes, scaled to the unit box."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cameras.unit_projection import Projection, projection_of
from vectorplot.geometry.convex.convex_faces import convex_faces
from vectorplot.geometry.mesh import next_positions
from vectorplot.scene.coincidence.pools import pools
from vectorplot.scene.scene import Scene


@dataclass(frozen=True, eq=False)
class View(Projection):
    """A projection, and the faces of all items in its coordinates.

    Parameters
    ----------
    eye, target, focus, near, picture_height, tolerance, centre, scale, axes : of Projection
        As there.
    points : (3, v) array of float
        The vertices of all items in the view's coordinates.
    corners : (c,) array of int
        As of Mesh, but without the faces that are not present, and with those that are not planar and convex cut into
        triangles.
    offsets : (f+1,) array of int
        Face i has the corners offsets[i] to offsets[i+1].
    inner : (c,) array of bool
        Marks the diagonals of faces that are cut: the edges that begin at these corners.
    face_item : (f,) array of int
        Of which item each face is.
    item_vertices : (i+1,) array of int
        Item k has the points item_vertices[k] to item_vertices[k+1], none if it is a smooth surface.
    occludes : (i,) array of bool
        Whether each item hides what is behind it.

    Notes
    -----
    Smooth surfaces have no faces.

    Source: Glaeser, section 3.1 (the pools).

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene
    >>> cubes = [vp.Item(name, geometry.box((1, 1, 1))) for name in ("one", "two")]
    >>> view = scene.look(vp.Scene(tuple(cubes)), vp.Camera((5, 4, 3)))
    >>> view.points.shape, view.face_count, view.item_vertices.tolist()
    ((3, 16), 12, [0, 8, 16])
    >>> bool((view.depth > 0).all())
    True
    """

    points: Floats
    corners: Ints
    offsets: Ints
    inner: Bools
    face_item: Ints
    item_vertices: Ints
    occludes: Bools

    def __len__(self) -> int:
        return self.face_count

    @property
    def face_count(self) -> int:
        """How many faces there are."""
        return len(self.offsets) - 1

    @cached_property
    def face_sizes(self) -> Ints:
        """(f,) number of corners."""
        return np.diff(self.offsets)

    @cached_property
    def is_triangular(self) -> bool:
        """Whether every face is a triangle."""
        return len(self.corners) == 3 * self.face_count

    def after(self, position: Ints) -> Ints:
        """Where in corners the corners stand that follow those at some positions in their faces.

        Parameters
        ----------
        position : (n,) array of int
            Into corners.

        Returns
        -------
        (n,) array of int
            Into corners; after the last corner of a face comes its first.
        """
        return next_positions(self.offsets, position)

    def only_sides(self, position: Ints) -> Bools:
        """Which of some sides no other one of them has the same two corners as.

        Parameters
        ----------
        position : (n,) array of int
            Into corners, where the sides start.

        Returns
        -------
        (n,) array of bool
        """
        a, b = self.corners[position], self.corners[self.after(position)]
        key = np.minimum(a, b) * self.points.shape[1] + np.maximum(a, b)
        order = np.argsort(key, kind="stable")
        same = key[order][1:] == key[order][:-1]
        result = np.ones(len(key), dtype=np.bool_)
        result[order[1:][same]] = False
        result[order[:-1][same]] = False
        return result

    @cached_property
    def depth(self) -> Floats:
        """(v,) distance from the eye along the principal ray; in a parallel projection from the middle of the scene."""
        return self.depth_of(self.points)

    @cached_property
    def image(self) -> Floats:
        """(2,v) the points' images in the image plane, origin where the principal ray meets it.

        Points nearer than the near plane have no image: they get that of a point at the near plane.
        """
        return self.image_of(self.points)


def look(scene: Scene, camera: Camera) -> View:
    """The scene as a camera sees it.

    Parameters
    ----------
    scene : Scene
        What is looked at.
    camera : Camera
        Where the eye is, and how it looks.

    Returns
    -------
    View
        All faces in the camera's axes, in the unit box.

    Raises
    ------
    InputError
        Where the scene is so small, or the eye so far away, that its coordinates have no digits left; for a surface
        without a finite point.

    Notes
    -----
    Degenerate: an empty scene gives a view without points.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene
    >>> slab = vp.Scene((vp.Item("slab", geometry.box((4, 2, 1))),))
    >>> view = scene.look(slab, vp.Camera.view("top"))
    >>> view.scale, view.points.max(axis=1).tolist()
    (2.0, [1.0, 0.5, 0.25])
    """
    return view_of(scene, projection_of(camera, scene.bounds))


def view_of(scene: Scene, projection: Projection) -> View:
    """The faces of a scene in a projection, be it of this scene, or of another one that it stands for."""
    pool = pools(scene)
    points = projection.points_of(pool.points)
    faces = convex_faces(points, pool.corners, pool.offsets, projection.tolerance)
    return View(
        **{field.name: getattr(projection, field.name) for field in fields(Projection)},
        points=np.ascontiguousarray(points),
        corners=faces.corners,
        offsets=faces.offsets,
        inner=faces.inner,
        face_item=pool.face_item[faces.source],
        item_vertices=pool.item_vertices,
        occludes=np.array([item.hides for item in scene.items], dtype=np.bool_),
    )
