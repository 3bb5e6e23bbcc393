import numpy as np
import pytest

from vectorplot.geometry import weld
from vectorplot.geometry.weld import close_points, distinct_points, one_each


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_distinct_points_are_those_of_numpy(kind: type) -> None:
    points = np.random.default_rng(1).integers(-3, 4, size=(5000, 3)).astype(kind)
    first, number = distinct_points(points)
    assert np.array_equal(points[first][number], points)
    assert len(first) == len(np.unique(points, axis=0))
    assert (np.diff(first) > 0).all()


def test_minus_zero_is_zero() -> None:
    first, number = distinct_points(np.array([[0.0, 1.0, -0.0], [-0.0, 1.0, 0.0]]))
    assert len(first) == 1
    assert number.tolist() == [0, 0]


def test_distinct_points_are_right_when_all_hashes_collide(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(weld, "_slots", lambda points, multipliers, bits: np.zeros(len(points), dtype=np.int64))
    points = np.random.default_rng(2).integers(0, 5, size=(300, 3)).astype(np.float64)
    first, number = distinct_points(points)
    assert np.array_equal(points[first][number], points)
    assert len(first) == len(np.unique(points, axis=0))


def test_points_that_differ_in_the_last_bit_stay_apart() -> None:
    points = np.array([[1.0, 2.0, 3.0], [1.0, 2.0, np.nextafter(3.0, 4.0)]])
    assert len(distinct_points(points)[0]) == 2


def test_no_points() -> None:
    first, number = distinct_points(np.zeros((0, 3)))
    assert len(first) == len(number) == 0


def test_close_points_agree_with_all_pairs() -> None:
    rng = np.random.default_rng(3)
    centres = rng.random((60, 3))
    points = np.concatenate([centres, centres[:30] + 1e-7 * rng.random((30, 3)), centres[:10] - 1e-7])
    label = close_points(points, 4e-7)
    near = np.linalg.norm(points[:, None] - points, axis=2) <= 4e-7
    for _ in range(6):
        near = near @ near
    assert np.array_equal(label, near.argmax(axis=1))


def test_a_chain_of_close_points_is_one_point() -> None:
    points = np.arange(50)[:, None] * np.array([0.9, 0.0, 0.0])
    assert (close_points(points, 1.0) == 0).all()
    assert np.array_equal(close_points(points, 0.8), np.arange(50))


@pytest.mark.parametrize("size", [0.3, 1e-7, 1e9])
def test_of_the_points_in_a_cube_the_first_one_is_taken(size: float) -> None:
    points = np.random.default_rng(3).uniform(-2.0, 2.0, size=(400, 6)) * np.array([1.0, 1.0, 1.0, 0.1, 0.1, 0.0])
    cubes = np.floor((points - points.min(axis=0)) / size)
    first: dict[tuple[float, ...], int] = {}
    for place, cube in enumerate(cubes.tolist()):
        first.setdefault(tuple(cube), place)
    assert one_each(points, size).tolist() == sorted(first.values())
