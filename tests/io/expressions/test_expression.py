"""Formulas: what they mean, their derivatives, and that nothing but InputError comes out of any text."""

from __future__ import annotations

import builtins
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples
from support.pace import cpu_seconds

from vectorplot.errors import InputError
from vectorplot.io import expressions as expression_derivatives
from vectorplot.io.expressions import FUNCTIONS, MAX_DEPTH, MAX_LENGTH, MAX_NODES, parse_expression

NUMPY = {
    **{name: getattr(np, name) for name in "sin cos tan sinh cosh tanh exp log log2 log10 sqrt cbrt".split()},
    **{name: getattr(np, name) for name in "abs sign floor ceil hypot mod".split()},
    **{"asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2},
    **{"min": np.minimum, "max": np.maximum, "pi": np.pi, "e": np.e, "tau": 2 * np.pi},
}
SMOOTH = "sin cos tan asin acos atan sinh cosh tanh exp log log2 log10 sqrt cbrt".split()
U, V = np.meshgrid(np.linspace(-1.9, 2.1, 21), np.linspace(-1.45, 1.7, 17))


def values(text: str, **arrays: object) -> np.ndarray:
    return parse_expression(text, tuple(arrays))(**arrays)


def fails(text: str, *variables: str) -> str:
    with pytest.raises(InputError) as caught:
        parse_expression(text, variables, file="torus.scene", line=7)
    message = str(caught.value)
    assert message.startswith("torus.scene:7: ") and "\n" not in message and len(message) < 400
    return message.removeprefix("torus.scene:7: ")


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("-2^2", -4),
        ("2^-1", 0.5),
        ("2^3^2", 512),
        ("2**3**2", 512),
        ("-2^-2", -0.25),
        ("2*-3", -6),
        ("1-2-3", -4),
        ("8/4/2", 1),
        ("2--3", 5),
        ("1+2*3^2/9-1", 2),
        ("(1+2)*3", 9),
        (".5+5.", 5.5),
        ("1e3*1.5E-2", 15),
        ("mod(-1, 3)", 2),
        ("max(1, 5, 3) + min(4, 2, 8)", 7),
        ("hypot(2, 3, 6)", 7),
        ("cbrt(-27)", -3),
        ("tau - 2*pi", 0),
        ("log(e)", 1),
        ("atan2(1, -1)", 0.75 * np.pi),
        (" \t3\n", 3),
    ],
)
def test_precedence_and_functions(text, result):
    assert values(text) == pytest.approx(result, abs=1e-15)


def trees() -> st.SearchStrategy[str]:
    """Texts that Python and the language read alike."""
    leaves = st.one_of(
        st.sampled_from(["u", "v", "pi", "e", "tau", "u", "v"]),
        st.floats(0, 10).map(lambda x: f"{x:.3g}"),
        st.integers(0, 9).map(lambda n: f"{n}."),
    )

    def grown(part: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
        one = sorted(set(FUNCTIONS) - {"atan2", "mod", "min", "max", "hypot"})
        return st.one_of(
            st.builds(lambda a, o, b: f"{a} {o} {b}", part, st.sampled_from(["+", "-", "*", "/", "**"]), part),
            st.builds(lambda a: f"-{a}", part),
            st.builds(lambda a: f"({a})", part),
            st.builds(lambda f, a: f"{f}({a})", st.sampled_from(one), part),
            st.builds(
                lambda f, a, b: f"{f}({a}, {b})", st.sampled_from(["atan2", "mod", "min", "max", "hypot"]), part, part
            ),
        )

    return st.recursive(leaves, grown, max_leaves=12)


@pytest.mark.slow
@settings(max_examples=examples(200))
@given(trees())
def test_values_are_those_of_python_and_numpy(text):
    # Python would divide constants by zero with an exception and count powers of integers exactly: arrays everywhere.
    expected = np.broadcast_to(np.asarray(_by_arrays(text)), U.shape)
    found = values(text, u=U, v=V)
    assert found.shape == U.shape and found.dtype == np.float64
    np.testing.assert_allclose(found, expected, rtol=1e-12, equal_nan=True)


def _by_arrays(text: str) -> np.ndarray:
    # Numbers become numpy scalars, so that 1./0. is inf as for arrays.
    wrapped = re.sub(r"(?<![\w.])(\d+\.?\d*(?:e[-+]?\d+)?)", r"N(\1)", text)
    with np.errstate(all="ignore"):
        constants = {name: np.float64(NUMPY[name]) for name in ("pi", "e", "tau")}
        return eval(wrapped, {"__builtins__": {}}, {**NUMPY, **constants, "N": np.float64, "u": U, "v": V})


SMOOTH_FORMULAS = [
    *(f"{name}(0.3*u + 0.2*v + {offset})" for name in SMOOTH for offset in (0.2, 0.9)),
    *("u*v", "u/(3+v)", "u^3 - 3*u*v^2", "-u^-2", "(2+v)^u", "3^(u*v)", "u^v^2", "(u^2+1)^(v-u)"),
    *("atan2(u+0.01, v)", "atan2(-2+u/4, v)", "hypot(u, v, 1)", "abs(u)*u", "min(u, v)*max(sin(u), v)", "max(u,v,0.3)"),
    *("mod(u+0.003, 0.7)*v", "mod(u, 1.5+v/4)", "sign(u)*v", "floor(3*u)*u", "ceil(v)*v^2", "-(-u)", "u - u"),
    *("exp(-u^2-v^2)*cos(8*hypot(u,v))", "sin(hypot(u,v))/hypot(u,v)", "2^2*u", "sqrt(1-u^2-v^2)", "e^(sin(u)*tau/9)"),
]


@pytest.mark.parametrize("text", SMOOTH_FORMULAS)
@pytest.mark.parametrize("variable", ["u", "v"])
def test_derivative_is_that_of_a_complex_step(text, variable):
    expression = parse_expression(text, ("u", "v"))
    step = 1e-150j
    posterized = expression(u=U + step if variable == "u" else U, v=V + step if variable == "v" else V)
    plain, slope = expression(u=U, v=V), expression.derivative(variable)(u=U, v=V)
    there = np.isfinite(plain)
    assert there.any()
    there &= np.isfinite(slope)
    assert there.sum() > 0.9 * np.isfinite(plain).sum()
    # The real parts are the real function: the complex one continues it.
    np.testing.assert_allclose(posterized.real[there], plain[there], rtol=1e-13, atol=1e-14)
    np.testing.assert_allclose(slope[there], posterized.imag[there] / 1e-150, rtol=1e-10, atol=1e-11)


@pytest.mark.parametrize("text", ["sin(u*v)/(2+cos(u))", "u^3*v^2", "exp(u*v)", "atan2(u, v+3)", "u*hypot(u,v)"])
def test_second_derivatives_commute_and_are_right(text):
    expression = parse_expression(text, ("u", "v"))
    mixed = expression.derivative("u").derivative("v")
    other = expression.derivative("v").derivative("u")
    np.testing.assert_allclose(mixed(u=U, v=V), other(u=U, v=V), rtol=1e-11, atol=1e-12)
    posterized = expression.derivative("u")(u=U, v=V + 1e-150j)
    np.testing.assert_allclose(mixed(u=U, v=V), posterized.imag / 1e-150, rtol=1e-11, atol=1e-12)


def test_derivatives_are_simplified():
    expression = parse_expression("3*u^2 + 7*v + sin(2)", ("u", "v"))
    assert len(expression.derivative("v").nodes) == 1
    assert len(expression.derivative("u").nodes) <= 6
    assert expression.derivative("u").derivative("u").derivative("u")(u=1.0, v=2.0) == 0
    assert expression.derivative("v")(u=U, v=V).shape == U.shape


@pytest.mark.slow
def test_derivatives_of_long_products_stay_short(monkeypatch):
    text = "*".join(f"sin({k}*u)" for k in range(1, 60))
    expression = parse_expression(text, ("u",))
    assert len(expression.derivative("u").nodes) < 8 * len(expression.nodes)
    monkeypatch.setattr(expression_derivatives, "MAX_DERIVED_NODES", 20 * len(expression.nodes))
    with pytest.raises(InputError, match="operations"):
        for _ in range(20):
            expression = expression.derivative("u")


@settings(max_examples=examples(100))
@given(trees(), st.floats(-2, 2), st.floats(-2, 2))
def test_every_derivative_is_that_of_small_differences(text, u, v):
    expression = parse_expression(text, ("u", "v"))
    slope = expression.derivative("u")
    h = 1e-5 * 2.0 ** np.arange(2)
    ends = np.stack((u - h, u + h))
    with np.errstate(invalid="ignore"):
        rises = np.diff(expression(u=ends, v=v), axis=0)[0] / (2 * h)
    scale = np.abs(expression(u=ends, v=v)).max()
    # Only where two steps agree, that is where the formula is smooth, differences are worth something.
    if np.isfinite(rises).all() and scale < 1e6 and abs(rises[0] - rises[1]) < 1e-7 * (1 + abs(rises[0])):
        if abs(rises[0]) < 1e6 and np.isfinite(slope(u=ends, v=v)).all():
            around = slope(u=np.array([u - h[1], u, u + h[1]]), v=v)
            margin = 1e-4 * (1 + abs(rises[0]) + scale)
            assert around.min() - margin <= rises[0] <= around.max() + margin


def test_values_keep_shape_and_kind():
    assert values("2", u=U).shape == U.shape and (values("2", u=U) == 2).all()
    assert values("u+v", u=np.arange(3)[:, None], v=np.arange(4.0)).shape == (3, 4)
    assert values("u/2", u=np.arange(3)).tolist() == [0, 0.5, 1]
    assert values("u^-1", u=np.array([2, 4])).tolist() == [0.5, 0.25]
    assert values("u*u", u=1j).dtype == np.complex128
    assert values("abs((u-1)/(u+1))", u=U).shape == U.shape
    assert values("u", u=np.float32(0.5)).dtype == np.float64
    result = values("u", u=U)
    assert not np.shares_memory(result, U)


def test_outside_the_domain_is_nan_without_a_warning():
    assert np.isnan(values("log(u) + sqrt(u) + asin(u-3)", u=np.array([-1.0, -2.0]))).all()
    assert np.isnan(values("(-8)^(1/3)"))
    assert np.isinf(values("1/0")) and np.isinf(values("9^9^9"))
    assert np.isnan(values("0*sqrt(1-u^2)", u=2.0)) and values("0*sqrt(1-u^2)", u=0.5) == 0


def test_values_of_missing_and_unknown_variables():
    expression = parse_expression("u + 2", ("u", "v"))
    assert expression.used == {"u"} and expression(u=1.0) == 3
    with pytest.raises(InputError, match="needs a value of u"):
        expression(v=1.0)
    with pytest.raises(InputError, match="no variable w"):
        expression(u=1.0, w=1.0)
    with pytest.raises(InputError, match=r"do not fit: u \(3,\), v \(4,\)"):
        expression(u=np.zeros(3), v=np.zeros(4))
    with pytest.raises(InputError, match="no variable t"):
        expression.derivative("t")


@pytest.mark.parametrize(
    ("text", "position", "cause"),
    [
        ("", 1, "expected a number, a name, '(' or a sign, got the end"),
        ("sin(u", 6, "sin takes one argument, got the end"),
        ("(1 + 2", 7, "expected an operator or ')', got the end"),
        ("sin u", 5, "expected '(' after sin, got 'u'"),
        ("2 u", 3, "a product is written with *, got 'u'"),
        ("1 + * 2", 5, "got '*'"),
        ("1 + 2)", 6, "expected an operator, got ')'"),
        ("sinn(u)", 1, "did you mean 'sin'"),
        ("w + 1", 1, "unknown name (known are u v pi e tau), got 'w'"),
        ("atan2(u)", 8, "atan2 takes two arguments"),
        ("sin(u, v)", 6, "sin takes one argument"),
        ("max(u)", 6, "max takes two or more arguments"),
        ("1e999", 1, "expected a finite number"),
        ("3 \u03c0", 3, "got '\u03c0'"),
        ("u \x1b[2J", 3, "got '?'"),
        ("u = 3", 3, "got '='"),
        ("u < 3", 3, "got '<'"),
        ("choose(u,u,u,u)", 1, "unknown function"),
        ("u" + " + u" * 30 + " $", 123, "got '$'"),
    ],
)
def test_errors_name_the_position_and_what_was_expected(text, position, cause):
    message = fails(text, "u", "v")
    assert message.startswith(f"position {position} of '") and cause in message


def test_names_of_variables():
    assert values("speed_2*2", speed_2=4.0) == 8
    with pytest.raises(InputError, match="pi is a constant"):
        parse_expression("1", ("pi",))
    with pytest.raises(InputError, match="sin is a function"):
        parse_expression("1", ("sin",))
    with pytest.raises(InputError, match="no name for a variable"):
        parse_expression("1", ("a b",))


@pytest.mark.hard(70)
def test_an_expression_is_never_run_as_code(monkeypatch):
    def forbidden(*arguments: object, **named: object) -> None:
        raise AssertionError("a formula reached Python")

    attacks = [
        "__import__('os').system('true')",
        "().__class__.__bases__[0].__subclasses__()",
        "exec('1')",
        "eval(u)",
        "open(u)",
        "u.__class__",
        "lambda: 1",
        "[u for u in (1,2)]",
        "u if u else v",
        "u; v",
        "u\n__import__",
        "f'{u}'",
        "u:=3",
        "@u",
        "print(u)",
        "numpy",
        "__builtins__",
    ]
    for name in ("eval", "exec", "compile", "open", "__import__"):
        monkeypatch.setattr(builtins, name, forbidden)
    caught = []
    for text in attacks:
        try:
            parse_expression(text, ("u", "v"))
        except InputError as error:
            caught.append(error)
    monkeypatch.undo()
    assert len(caught) == len(attacks)


@pytest.mark.hard(70)
@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("(" * 4000 + "u" + ")" * 4000, f"deeper than {MAX_DEPTH}"),
        ("-" * 9000 + "u", f"deeper than {MAX_DEPTH}"),
        ("sin(" * 2000 + "u", f"deeper than {MAX_DEPTH}"),
        ("2^" * 4000 + "u", f"deeper than {MAX_DEPTH}"),
        ("u+" * 4000 + "u", f"more than {MAX_NODES}"),
        ("1" * 20_000, f"at most {MAX_LENGTH}"),
        ("9" * 9000, "expected a finite number"),
    ],
)
def test_deep_and_long_expressions_are_refused_in_one_line(text, cause):
    with cpu_seconds(1.0):
        assert cause in fails(text, "u")


def test_nesting_up_to_the_bound_is_read():
    text = "(" * (MAX_DEPTH - 1) + "u" + ")" * (MAX_DEPTH - 1)
    assert values(text, u=3.0) == 3
    assert fails("(" * MAX_DEPTH + "u" + ")" * MAX_DEPTH, "u")
    long = parse_expression("+".join(f"u^{k}" for k in range(600)), ("u",))
    assert long.derivative("u")(u=0.5) == pytest.approx(4.0)


@pytest.mark.slow
@settings(max_examples=examples(300))
@given(
    st.one_of(
        st.text(max_size=40),
        st.text(alphabet="uvpie0123456789.+-*/^(), ", max_size=30),
        st.lists(st.sampled_from([*FUNCTIONS, "(", ")", "u", "1", ",", "-", "^", "**", "*", "e"]), max_size=12).map(
            "".join
        ),
    )
)
def test_any_text_is_read_or_refused(text):
    try:
        expression = parse_expression(text, ("u", "v"), file="a", line=1)
    except InputError as error:
        message = str(error)
        assert message.startswith("a:1: ") and message.isprintable()
    else:
        found = expression(u=U, v=V)
        assert found.shape == U.shape
        assert expression.derivative("u")(u=U, v=V).shape == U.shape
