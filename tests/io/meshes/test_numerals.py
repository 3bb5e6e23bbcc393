from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples

from vectorplot.errors import InputError
from vectorplot.io.mesh_file import PAD, NumeralError, decimals, integers, padded
from vectorplot.io.obj import read_obj


def placed(words: list[str]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    data = " ".join(words).encode()
    ends = np.cumsum([len(word.encode()) + 1 for word in words]) - 1 + PAD
    return padded(data), ends - [len(word.encode()) for word in words], ends


def test_decimals_are_those_of_python() -> None:
    words = [
        "0",
        "-0",
        "1",
        "+1.5",
        ".5",
        "5.",
        "-.25",
        "0.1",
        "123456.789",
        "99999999.99999999",
        "0.08156099999999999",
    ]
    words += [
        "1e-06",
        "-2.5E+3",
        "0.12345678901234567",
        "123456789012",
        "12345678.1234567890123456",
        "4.9e-324",
        "1e308",
    ]
    words += ["9007199254740993", "0.3", "2.2250738585072011e-308", "00000000000000001.5", "0." + "0" * 20 + "1"]
    values = decimals(*placed(words))
    assert values.tolist() == [float(word) for word in words]
    assert np.signbit(values[1])


@pytest.mark.slow
@settings(max_examples=examples(200))
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=20), st.integers(0, 12))
def test_decimals_of_any_double_in_any_notation(values: list[float], digits: int) -> None:
    words = [repr(value) for value in values] + [f"{value:.{digits}f}" for value in values if abs(value) < 1e20]
    assert decimals(*placed(words)).tolist() == [float(word) for word in words]


def test_decimals_of_seventeen_digits_and_ties() -> None:
    rng = np.random.default_rng(4)
    values = [
        *rng.normal(size=20000),
        *(1.0 + rng.integers(0, 4096, 2000) * 2.0**-52),
        *(2.0 - 2.0**-53, 1.0 - 2.0**-53),
    ]
    words = [f"{value:.17g}" for value in values] + [f"{value:.16f}" for value in values]
    words += ["0.9999999999999999999", "0.9223372036854775808", "0.9223372036854775807", "1.99999999999999999999"]
    words += ["9.2233720368547758080", "12345678.0000000001", "0.0000000000000000001", "0.00000000000000000001"]
    words += [f"{value / 37:.19f}" for value in values[:3000]]
    # Halfway between two doubles, and a hair beside it.
    words += [
        "9007199254740993.0",
        "9007199254740993.01",
        "9007199254740992.99",
        "4503599627370496.5",
        "4503599627370497.5",
    ]
    words += [f"{k}.{half}" for k in range(2**51, 2**51 + 40) for half in ("125", "375", "25", "75", "249", "251")]
    assert decimals(*placed(words)).tolist() == [float(word) for word in words]


@pytest.mark.hard(53)
@pytest.mark.parametrize(
    "word", ["nan", "inf", "-Infinity", "1e999", "1_0", "0x10", "1,5", "--1", "1.2.3", "e", ".", "-", "1e", "١"]
)
def test_what_is_no_finite_decimal_number_is_refused(word: str) -> None:
    with pytest.raises(NumeralError) as error:
        decimals(*placed(["1", "2.5", word, "3"]))
    assert error.value.index == 2


def test_integers() -> None:
    words = ["0", "7", "-12", "+3", "12345678", "123456789", "0000000000042", "99999999"]
    assert integers(*placed(words)).tolist() == [int(word) for word in words]


@pytest.mark.parametrize("word", ["1.0", "a", "-", "1e3", "9" * 19, "1-2", "1_0"])
def test_what_is_no_integer_is_refused(word: str) -> None:
    with pytest.raises(NumeralError) as error:
        integers(*placed(["1", word]))
    assert error.value.index == 1


def test_nothing() -> None:
    none = np.zeros(0, dtype=np.intp)
    assert len(decimals(padded(b""), none, none)) == len(integers(padded(b""), none, none)) == 0


def test_exponents_of_mathematica_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_text("v 2.7*^-4 0 0\nv 1 -3.*^+1 0\nv 0 1.5*^2 1e-3\nf 1 2 3\n")
    assert read_obj(path).mesh.vertices.tolist() == [[2.7e-4, 0.0, 0.0], [1.0, -30.0, 0.0], [0.0, 150.0, 1e-3]]
    path.write_text("v 0 0 0\nv 2*^*^3 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(InputError, match=r"a\.obj:2: expected a finite number, got '2\*\^\*\^3'"):
        read_obj(path)
