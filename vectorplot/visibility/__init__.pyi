from .hidden_points import points_hidden_by
from .painter.face_splitting import cut_into_slices, slice_order, sliced_order
from .painter.groups import (
    ObjectOrder,
    Objects,
    cyclic_overlap_report,
    cyclic_overlaps,
    demands,
    group_ranks,
    grouped_order,
    object_order,
    priorities,
    view_objects,
    wholly_hidden,
)
from .painter.image_faces import ImageFaces, image_faces, image_points
from .painter.painters_order import Painted, painters_order
from .painter.priority_tests import APART, BEHIND, COPLANAR, IN_FRONT, STRADDLING, Bodies, convex_bodies
from .painter.topological_order import Precedence, TopologicalSort, topological_order
from .polyhedra.hidden_lines import Segments, Visibility, counted_parts, visible_parts
from .polyhedra.lines import Lines, edge_lines
from .polyhedra.occluders import solid_items
from .projected_faces import ProjectedFaces, project_faces

__all__ = [
    "APART",
    "BEHIND",
    "COPLANAR",
    "IN_FRONT",
    "STRADDLING",
    "Bodies",
    "ImageFaces",
    "Lines",
    "ObjectOrder",
    "Objects",
    "Painted",
    "Precedence",
    "ProjectedFaces",
    "Segments",
    "TopologicalSort",
    "Visibility",
    "convex_bodies",
    "counted_parts",
    "cut_into_slices",
    "cyclic_overlap_report",
    "cyclic_overlaps",
    "demands",
    "edge_lines",
    "group_ranks",
    "grouped_order",
    "image_faces",
    "image_points",
    "object_order",
    "painters_order",
    "points_hidden_by",
    "priorities",
    "project_faces",
    "slice_order",
    "sliced_order",
    "solid_items",
    "topological_order",
    "view_objects",
    "visible_parts",
    "wholly_hidden",
]
