"""What is painted, and how finely."""

from __future__ import annotations

from dataclasses import dataclass

from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.light.face_shades import Shades
from vectorplot.shading.light.painted_colours import Lighting, corner_shades_of
from vectorplot.shading.light.refinement import SHORTEST_MM, refined
from vectorplot.visibility.painter.image_faces import ImageFaces, view_points
from vectorplot.visibility.projected_faces import ProjectedFaces


@dataclass(frozen=True, eq=False)
class Seen:
    """What is painted: a scene without smooth surfaces, its view, its faces in the image, the polygons of the picture
    back to front, and where the picture goes."""

    scene: Scene
    view: View
    projected: ProjectedFaces
    faces: ImageFaces
    placement: Placement


def finer(seen: Seen, lighting: Lighting, most: int) -> ImageFaces:
    """The polygons, those that are shaded so small that no corner shows, or as many as may be."""
    faces = seen.faces
    shortest = SHORTEST_MM / seen.placement.scale
    points, offsets, parent = refined(seen.view, lighting, faces.points, faces.offsets, faces.source, shortest, most)
    if len(parent) == len(faces):
        return faces
    return ImageFaces(points, offsets, faces.planes[:, parent], faces.source[parent], faces.rank[parent])


def shades_of_faces(seen: Seen, lighting: Lighting) -> Shades:
    """What every light gives to the corners of the polygons."""
    faces = seen.faces
    points = view_points(seen.view, faces.points)
    return corner_shades_of(seen.view, lighting, points, faces.offsets, faces.source)
