from .painter.face_splitting import cut_into_slices, slice_order, sliced_order
from .painter.image_faces import image_faces, image_points
from .painter.painters_order import painters_order
from .painter.priority_tests import APART, BEHIND, IN_FRONT
from .painter.topological_order import topological_order

__all__ = [
    "APART",
    "BEHIND",
    "IN_FRONT",
    "cut_into_slices",
    "image_faces",
    "image_points",
    "painters_order",
    "slice_order",
    "sliced_order",
    "topological_order",
]
