from .hidden_points import points_hidden_by
from .painter.cuts import cut_into_slices, slice_order, sliced_order
from .painter.groups import (
    ObjectOrder,
    Objects,
    demands,
    gordian_knots,
    group_ranks,
    grouped_order,
    knot_report,
    object_order,
    priorities,
    view_objects,
    wholly_hidden,
)
from .painter.image_faces import ImageFaces, image_faces, image_points
from .painter.mikado import Mikado, Precedence, mikado
from .painter.painters_order import Painted, painters_order
from .painter.pairs import APART, BEHIND, COPLANAR, IN_FRONT, STRADDLING, Bodies, convex_bodies
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
    "Mikado",
    "ObjectOrder",
    "Objects",
    "Painted",
    "Precedence",
    "ProjectedFaces",
    "Segments",
    "Visibility",
    "convex_bodies",
    "counted_parts",
    "cut_into_slices",
    "demands",
    "edge_lines",
    "gordian_knots",
    "group_ranks",
    "grouped_order",
    "image_faces",
    "image_points",
    "knot_report",
    "mikado",
    "object_order",
    "painters_order",
    "points_hidden_by",
    "priorities",
    "project_faces",
    "slice_order",
    "sliced_order",
    "solid_items",
    "view_objects",
    "visible_parts",
    "wholly_hidden",
]
