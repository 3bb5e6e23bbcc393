import math

import click
import pytest

from vectorplot.cli import option_values as options


@pytest.mark.parametrize(("text", "value"), [("-3,4,5", (-3, 4, 5)), (" 1e3, -.5 ,0", (1000, -0.5, 0))])
def test_a_point_is_three_numbers(text, value):
    assert options.point(text) == value


@pytest.mark.parametrize("text", ["1,2", "1,2,3,4", "1,2,x", "nan,0,0", "inf,0,0", "", "1 2 3"])
def test_anything_else_is_no_point(text):
    with pytest.raises(click.BadParameter):
        options.point(text)


def test_bounds_of_numbers_are_kept():
    assert options.at_least(0.0)("0") == 0.0
    assert options.at_least(0.0, at_most=180.0)("180") == 180.0
    assert options.between(0.0, math.inf)("1e-9") == 1e-9
    wrong = (
        (options.at_least(0.0), "-1"),
        (options.at_least(0.0, at_most=180.0), "180.1"),
        (options.between(0.0, 180.0), "180"),
        (options.number, "1_0x"),
    )
    for read, text in wrong:
        with pytest.raises(click.BadParameter):
            read(text)


def test_pages_have_names_or_sizes():
    assert options.page_size("A4") == (210.0, 297.0)
    assert options.page_size("300x200.5") == (300.0, 200.5)
    assert options.page_size("A4 landscape") == (297.0, 210.0)
    assert options.page_size("300x200.5 portrait") == (200.5, 300.0)
    for text in ("A9", "0x5", "5x-5", "nanx5", "x"):
        with pytest.raises(click.BadParameter):
            options.page_size(text)


def test_kinds_come_once_in_the_order_given():
    assert options.kinds("crease,Contour,crease") == ("crease", "contour")
    for text in ("", "creases", "contour;crease"):
        with pytest.raises(click.BadParameter):
            options.kinds(text)


@pytest.mark.parametrize(
    ("path", "given", "word"),
    [("a.svg", None, "svg"), ("a/b.c/d.EPS", None, "eps"), ("x.svg", "pdf", "pdf"), ("-", "json", "json")],
)
def test_the_format_is_given_or_the_suffix(path, given, word):
    assert options.format_of(path, given, ("svg", "eps", "pdf", "json")) == word


@pytest.mark.parametrize("path", ["-", "svg", ".svg", "a.tiff", "a.svg/b", "a.svg."])
def test_without_a_format_it_is_bad_usage(path):
    with pytest.raises(click.UsageError):
        options.format_of(path, None, ("svg", "eps"))


def test_one_format_alone_is_no_choice():
    with pytest.raises(click.UsageError, match=r"^a\.gcode: .* \.svg, \.pdf; vpype writes it from an \.svg$"):
        options.format_of("a.gcode", None, ("svg", "pdf"))
    with pytest.raises(click.UsageError, match=r"^a\.jpg: the name must end in \.png$"):
        options.format_of("a.jpg", None, ("png",))
