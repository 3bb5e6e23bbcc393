from .hidden_points import points_hidden_by
from .painter.cuts.slices import cut_into_slices, slice_order, sliced_order
from .painter.groups import ObjectOrder, gordian_knots, group_ranks, grouped_order, knot_report, object_order
from .painter.image_faces import ImageFaces, image_faces, image_points
from .painter.mikado import Mikado, mikado
from .painter.painters_order import Painted, painters_order
from .painter.pairs.convex_bodies import Bodies, convex_bodies
from .painter.pairs.face_pairs import APART, BEHIND, COPLANAR, IN_FRONT, STRADDLING
from .painter.precedence import Precedence
from .painter.priorities import Objects, demands, priorities, view_objects, wholly_hidden
from .polyhedra.hidden_lines import Visibility, counted_parts, visible_parts
from .polyhedra.lines import Lines, edge_lines
from .polyhedra.occluders import solid_items
from .polyhedra.pairs import Segments
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
