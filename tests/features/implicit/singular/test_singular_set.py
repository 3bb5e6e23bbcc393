import numpy as np
import pytest

from vectorplot.features.edge_splitting import Within
from vectorplot.features.implicit_singular_lines import led_into_lines, led_into_singular_set, singular_lines
from vectorplot.features.polygonization import polygonized, settled_mesh
from vectorplot.features.tessellation import facets
from vectorplot.io.expressions import parse_expression
from vectorplot.io.shape_arguments import Formulas, formula_implicit
from vectorplot.surfaces.implicit import ImplicitFunction

BOX = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])


def implicit(text: str, shift: float = 0.0) -> ImplicitFunction:
    box = BOX + shift * np.array([1.0, 0.7, 0.0])
    return formula_implicit(Formulas((parse_expression(text, ("x", "y", "z")),)), box)


@pytest.mark.slow
@pytest.mark.hard(79)
@pytest.mark.spread
@pytest.mark.parametrize("shift", [0.0137, 0.0])
@pytest.mark.parametrize(
    ("text", "along"), [("x*y", (-0.95, 0.95)), ("x^2-y^2*z", (0.2, 0.95)), ("x^2-y^2*z^2", (0.35, 0.95))]
)
def test_sheets_that_cross_end_on_their_common_line(text: str, along: tuple[float, float], shift: float) -> None:
    surface = implicit(text, shift)
    mesh = facets(surface, Within(lambda points: np.full(points.shape[:-1], 0.1))).mesh
    corners = mesh.vertices[mesh.corners.reshape(-1, 3)]
    on = np.hypot(corners[..., 0], corners[..., 1]) < 1e-6
    # Sides of triangles that lie on the line cover it, from four sheets.
    side = on & np.roll(on, -1, axis=1)
    ends = np.stack([corners[..., 2], np.roll(corners[..., 2], -1, axis=1)], axis=-1)[side]
    low, high = ends.min(axis=1), ends.max(axis=1)
    for z in np.linspace(*along, 41) + 0.00123:
        assert ((low <= z) & (z <= high)).sum() >= 4, z


def test_what_has_no_singular_point_stays_as_it_is() -> None:
    ball = implicit("x^2+y^2+z^2-0.8")
    mesh = settled_mesh(ball, 16)[0]
    led = led_into_singular_set(ball, mesh, singular_lines(ball, mesh))
    assert (led.vertices == mesh.vertices).all() and (led.corners == mesh.corners).all()
    nothing = settled_mesh(implicit("x^2+y^2+z^2+1"), 16)[0]
    assert not led_into_singular_set(ball, nothing, singular_lines(ball, nothing)).face_count


@pytest.mark.slow
@pytest.mark.hard(49)
def test_narrow_sheets_between_lines_are_not_led_into_them() -> None:
    swallowtail = implicit("16*x^4*z-4*x^3*y^2-128*x^2*z^2+144*x*y^2*z-27*y^4+256*z^3")
    mesh = polygonized(swallowtail, 48)
    led, on_line = led_into_lines(swallowtail, mesh, singular_lines(swallowtail, mesh))
    assert on_line.sum() > 20
    # Between its self-intersection z = x^2 / 4 and its two edges lies a tail of triangular sections.
    x, y, z = led.vertices[led.corners.reshape(-1, 3)].mean(axis=1).T
    tail = (np.abs(y) < 0.15) & (z < 0.2 * x**2)
    for low in np.linspace(-0.6, -0.3, 7):
        assert (tail & (x > low) & (x < low + 0.05)).sum() >= 4, low
