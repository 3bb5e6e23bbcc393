from .painter.face_splitting import cut_into_slices, slice_order, sliced_order
from .painter.image_faces import image_faces, image_points
from .painter.painters_order import painters_order
from .painter.priority_tests import APART, BEHIND, IN_FRONT, convex_bodies
from .painter.topological_order import topological_order
from .polyhedra.hidden_lines import Segments, visible_parts
from .polyhedra.lines import edge_lines
from .polyhedra.occluders import solid_items
from .projected_faces import project_faces

__all__ = [
    "APART",
    "BEHIND",
    "IN_FRONT",
    "Segments",
    "convex_bodies",
    "cut_into_slices",
    "edge_lines",
    "image_faces",
    "image_points",
    "painters_order",
    "project_faces",
    "slice_order",
    "sliced_order",
    "solid_items",
    "topological_order",
    "visible_parts",
]
