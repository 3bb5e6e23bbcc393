import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.drawing.strokes import clusters, connected


def test_the_smallest_index_stands_for_a_component():
    np.testing.assert_array_equal(connected(6, np.array([2, 2, 5]), np.array([0, 1, 4])), [0, 0, 0, 3, 4, 4])
    np.testing.assert_array_equal(connected(3, np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp)), [0, 1, 2])


@given(
    st.lists(st.tuples(st.integers(0, 40), st.integers(0, 40), st.integers(0, 1)), min_size=1, max_size=40),
    st.floats(0.01, 3.0),
)
def test_points_of_a_lattice_with_noise_are_grouped_as_on_the_lattice(points, pitch):
    lattice = np.array(points)
    noise = np.random.default_rng(len(points)).uniform(-0.3, 0.3, (len(points), 2))
    x, y = (lattice[:, :2] * pitch + noise * 0.1 * pitch).T
    found = clusters(x, y, lattice[:, 2], 0.1 * pitch)
    _, first, number = np.unique(lattice, axis=0, return_index=True, return_inverse=True)
    np.testing.assert_array_equal(found, first[number.ravel()])
