"""Texts in the scene language, and formulas, that are nearly right: grown from their grammar with small geometry."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

from fuzz.fuzz_words import HOSTILE, NAMES, changed_bytes, changed_words, number, one, repeated, whole

from vectorplot.io.expressions import CONSTANTS, FUNCTIONS
from vectorplot.io.named_shapes import CURVES, SURFACES
from vectorplot.io.reserved_words import RESERVED
from vectorplot.words import COLOURS, LINE_WORDS, MATERIALS

VOCABULARY = (*sorted(RESERVED), *sorted(COLOURS), *NAMES, ",", '"', "#", "\n", "", "0", "-1", '"x"', '"2*pi"', '"1/0"')
_COLOURS, _MATERIALS = sorted(COLOURS), sorted(MATERIALS)

Writer = Callable[[Random], str]


def formula(rng: Random, variables: str, depth: int = 4) -> str:
    """A formula, rarely one that is none."""
    if depth == 0 or rng.random() < 0.2:
        return one(rng, (*variables, *variables, *CONSTANTS, number(rng, 0.02), number(rng, 0.02)))
    way = rng.randrange(8)
    if way < 4:
        operator = one(
            rng, ("+", "-", "*", "/", "^", "**", "+", "-", "*", "") if rng.random() < 0.3 else ("+", "-", "*")
        )
        return f"{formula(rng, variables, depth - 1)}{operator}{formula(rng, variables, depth - 1)}"
    if way == 4:
        return f"({formula(rng, variables, depth - 1)})"
    if way == 5:
        return f"-{formula(rng, variables, depth - 1)}"
    arguments = [formula(rng, variables, depth - 1) for _ in range(rng.choice((1, 1, 1, 2, 2, 3)))]
    return f"{one(rng, FUNCTIONS)}({','.join(arguments)})"


def formula_text(rng: Random) -> str:
    """A formula in x and y, damaged, or one part of it again and again."""
    way = rng.random()
    if way < 0.01:
        parts = (
            "-",
            "(",
            "x+",
            "2^",
            "sin(",
            "x*y+",
            "max(x,",
            "1",
            "x",
            " ",
            "atan2(",
            "x/y/",
            ".",
            "1e",
            "**",
            "(x)",
            "abs(x)*",
        )
        return one(rng, parts) * rng.randrange(1, 12_000)
    text = formula(rng, "xy", rng.randint(1, 7))
    if way < 0.4:
        letters = changed_words(rng, list(text), tuple("()+-*/^,.e_ xyz019\x1b\u202e\"'#%&|<>=[]{}:;!\\\n"))
        return "".join(letters)
    return text


def _numbers(count: int, comma: float = 0.1) -> Writer:
    return lambda rng: one(rng, (" ", " ", ", ") if rng.random() < comma else (" ",)).join(
        number(rng) for _ in range(count)
    )


def _angles(rng: Random) -> str:
    return one(rng, ("0 360", "0 90", "-45 45", "0 180", number(rng) + " " + number(rng), "90 0", "0 720"))


def _quoted(count: int, variables: str) -> Writer:
    return lambda rng: ", ".join(f'"{formula(rng, variables, 3)}"' for _ in range(count))


def _range(rng: Random) -> str:
    return one(rng, ("-1 1", "0 1", '0 "2*pi"', "-2 2", number(rng) + " " + number(rng), "1 1"))


_SIMPLE = (
    "major",
    "minor",
    "radius",
    "bottom",
    "top",
    "depth",
    "height",
    "slope",
    "depth_slope",
    "a",
    "b",
    "r",
    "s",
    "width",
)


def _slot(name: str, word: str) -> Writer:
    """A writer of the values of a slot of a surface or a curve."""
    if word in ("formulas", "formula"):
        variables = {"curve": "t", "function": "uv", "graph": "xy"}.get(name, "xyz")
        return _quoted(1 if word == "formula" else 3, variables)
    if name == "spline" and word in ("u", "v"):
        return lambda rng: one(rng, ("akima", "cubic closed", "bspline order 3", "approximating controls 4"))
    if word in ("u", "v"):
        return _range if name == "function" else _angles
    if word in CURVES and name not in ("spline", "landscape", "nurbs"):
        return lambda rng: _slots(rng, word, CURVES)
    if word == "path":
        return lambda rng: _named(rng, CURVES)
    writers: dict[str, Writer] = {
        "centre": _numbers(2 if name == "graph" else 3),
        "semi_axes": _numbers(3),
        "axis": lambda rng: one(rng, ("0 0 1", "1 0 0", "1 2 3", "0 0 0")),
        "box": lambda rng: one(rng, ("-1 1 -1 1 -1 1", "-2 2 -2 2 -2 2", " ".join(number(rng) for _ in range(6)))),
        "coefficients": _numbers(10),
        "points": _numbers(6) if name in ("line", "rod") else _points,
        "line": lambda rng: " line ".join([_points(rng)] * rng.randint(1, 5)),
        "order": lambda rng: whole(rng, 1, 6),
        "orders": lambda rng: f"{whole(rng, 1, 5)} {whole(rng, 1, 5)}",
        "controls": lambda rng: whole(rng, 1, 6),
        "tangents": _numbers(6),
        "heights": lambda rng: ", ".join(" ".join(number(rng) for _ in range(3)) for _ in range(rng.randint(1, 4))),
        **dict.fromkeys(("weights", "knots", "knots_u", "knots_v", "parameters"), _list),
        **dict.fromkeys(("akima", "cubic", "interpolating"), lambda rng: one(rng, ("", "closed", "order 3"))),
        "arc": _angles,
        "angle": _angles,
        "x": _range,
        "y": _range,
        "t": _range,
        "branch": lambda rng: whole(rng, 0, 3),
        "closed": lambda rng: "",
        "closed_u": lambda rng: "",
        "closed_v": lambda rng: "",
    }
    return writers.get(word, number)


def _points(rng: Random) -> str:
    return ", ".join(_numbers(3)(rng) for _ in range(rng.randint(1, 7)))


def _list(rng: Random) -> str:
    return ", ".join(number(rng) for _ in range(rng.randint(1, 8)))


def _slots(rng: Random, name: str, families: dict) -> str:
    family = families[name]
    bare, words = [], []
    for word, slot in family.slots.items():
        if word in family.bare and not words and rng.random() < 0.6:
            bare.append(_slot(name, word)(rng))
        elif (slot.needed and slot.into is None) or rng.random() < 0.25:
            words.append(f"{word} {_slot(name, word)(rng)}")
    generators = [word for word, slot in family.slots.items() if slot.into == "generator"]
    if generators and not any(word.split()[0] in generators for word in words):
        generator = one(rng, generators)
        words.append(f"{generator} {_slot(name, generator)(rng)}")
    rng.shuffle(words)
    return " ".join([*bare, *words])


def _named(rng: Random, families: dict) -> str:
    name = one(rng, list(families))
    return f"{name} {_slots(rng, name, families)}"


def _name(rng: Random) -> str:
    name = one(rng, NAMES)
    return (
        name
        if rng.random() < 0.6 and name.isalpha()
        else one(rng, ('"' + name.replace('"', '\\"') + '"', f"I{rng.randrange(9)}"))
    )


def _look(rng: Random) -> str:
    """Words about colour, material and placement."""
    words = []
    for _ in range(rng.choice((0, 1, 1, 2, 4))):
        words.append(
            one(
                rng,
                (
                    lambda: one(rng, _COLOURS),
                    lambda: one(rng, _MATERIALS),
                    lambda: f"opacity {one(rng, ('0', '0.5', '1', number(rng)))}",
                    lambda: f"refraction {one(rng, ('1.3', '0.8', number(rng)))}",
                    lambda: f"translation {_numbers(3)(rng)}",
                    lambda: f"rotation {one(rng, 'xyzw')} {number(rng)}",
                    lambda: f"scale {_numbers(rng.choice((1, 3)))(rng)}",
                    lambda: f"matrix {_numbers(12)(rng)}",
                    lambda: f"lines {', '.join(one(rng, (*LINE_WORDS, 'none')) for _ in range(rng.randint(1, 3)))}",
                    lambda: f"occludes {one(rng, ('yes', 'no', 'maybe'))}",
                    lambda: one(rng, ("convex", "hollow", "solid", "general", "+top", "+bottom")),
                    lambda: f"colour {one(rng, (*_COLOURS, 'blurple', chr(34) + '#12abef' + chr(34)))}",
                ),
            )()
        )
    return " ".join(words)


def _polygon(rng: Random, columns: int) -> str:
    return ", ".join(_numbers(columns)(rng) for _ in range(rng.choice((3, 3, 4, 5, 2, 1))))


def _solid(rng: Random, earlier: list[str]) -> str:
    """A polyhedron."""
    way = rng.randrange(6)
    if way < 2:
        return f"box {_numbers(3)(rng)}"
    if way == 2:
        meridian = one(rng, ("1 0 0, 1 0 1", "0 0 0, 1 0 1, 0 0 2", "2 0 0, 3 0 1, 2 0 1", _polygon(rng, 3)))
        angle = f"rot_angle {one(rng, ('90', '180', '360', number(rng)))}" if rng.random() < 0.4 else ""
        return f"revolution {angle} meridian {meridian} order {whole(rng, 2, 9)}"
    if way == 3:
        base = one(rng, ("0 0 0, 1 0 0, 0 1 0", "0 0 0, 2 0 0, 2 2 0, 1 1 0, 0 2 0", _polygon(rng, 3)))
        return f"translation base_points {base} trans_vector {one(rng, ('0 0 1', '1 1 1', _numbers(3)(rng)))}"
    if way == 4 and len(earlier) > 1:
        return f"intersection {one(rng, earlier)}, {one(rng, earlier)}"
    count = rng.randint(3, 6)
    points = (
        ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "1 1 0", "1 0 1"][:count]
        if rng.random() < 0.6
        else [_numbers(3)(rng) for _ in range(count)]
    )
    faces = [" ".join(whole(rng, 1, count) for _ in range(rng.choice((3, 3, 4, 5)))) for _ in range(rng.randint(1, 5))]
    if rng.random() < 0.4:
        points, faces = points[:4] + points[4:], ["1 3 2", "1 2 4", "2 3 4", "1 4 3"]
    edges = f"edges {whole(rng, 1, count)} {whole(rng, 1, count)}" if rng.random() < 0.05 else ""
    return f"vertices {', '.join(points)} {edges} faces {', '.join(faces)}"


def _after(rng: Random, smooth: bool) -> str:
    """Words that follow a shape."""
    words = []
    if rng.random() < 0.3:
        words.append(
            one(
                rng,
                (
                    f"parameter_lines {whole(rng, 0, 6)} {whole(rng, 0, 6)}",
                    f"isophotes {whole(rng, 1, 4)}",
                    f"isophotes at {_numbers(2, 1.0)(rng)} lit_by {one(rng, ('1', 'LAMP', '2'))}",
                    f"sections {one(rng, ('x', 'y', 'z', 'normal 1 2 3', 'normal 0 0 0'))} {whole(rng, 1, 4)}",
                    f"level_lines at {number(rng)}",
                )
                if smooth or rng.random() < 0.4
                else (
                    f"removed_faces {whole(rng, 1, 4)}",
                    f"patterns face {whole(rng, 1, 4)} polygon P red {_polygon(rng, 2)}",
                ),
            )
        )
    return " ".join(words)


def item(rng: Random, earlier: list[str], smooth: float) -> str:
    """An item: its name, its look, its shape."""
    name = _name(rng)
    shape, is_smooth = _solid(rng, earlier), False
    if rng.random() < smooth:
        shape, is_smooth = f"surface {_named(rng, SURFACES)}", True
        if rng.random() < 0.25:
            shape = one(rng, (f"curve {_named(rng, CURVES)}", f"curve {_quoted(3, 't')(rng)} t {_range(rng)}"))
    earlier.append(name)
    return f"{name} {_look(rng)} {shape} {_look(rng)} {_after(rng, is_smooth)}"


def _statement(rng: Random) -> str:
    """What a file says about the scene as a whole."""
    place = one(rng, ("5 4 3", "10 -5 6", "0 0 9", _numbers(3)(rng)))
    return one(
        rng,
        (
            f"camera eye {place}"
            + one(rng, ("", " parallel", " target 1 0 0", f" field_of_vision {number(rng)}", f" twist {number(rng)}")),
            f"camera view {one(rng, ('front', 'iso', 'top', 'side'))}",
            f"camera eye {place} up {_numbers(3)(rng)} height {number(rng)}",
            f"light LAMP position {place}"
            + one(rng, ("", " fading", f" intensity {one(rng, ('0.5', '1', number(rng)))}", " colour yellow")),
            f"light direction {place}",
            f"light {_name(rng)} position {_numbers(3)(rng)}",
            f"light position {place}",
            f"page {one(rng, ('A6', 'A5 landscape', '80x60', '80x60 margin 5', f'{number(rng)}x1', 'A99'))}",
            f"title {_name(rng)}",
            f'title "{one(rng, NAMES)}"',
            f"background {one(rng, ('white', 'gray', chr(34) + '#ffeedd' + chr(34)))}",
            "# a remark",
        ),
    )


def scene(rng: Random, smooth: float = 0.4) -> str:
    """A scene of a few small items; smooth: how many of them are no polyhedra."""
    earlier: list[str] = []
    lines = [item(rng, earlier, smooth) for _ in range(rng.choice((1, 1, 2, 2, 3, 4)))]
    lines += [_statement(rng) for _ in range(rng.choice((0, 1, 1, 2, 3)))]
    rng.shuffle(lines)
    return "\n".join(lines)


_PARTS = (
    '\\"', '"', "A box 1 1 1\n", "A blurgh box 1 1 1\n", "light position 1 1 1\n", ",", "1 ", "a",
    "#", "# a\n", "(", "\\",
    "A surface sphere\n", "+top ", "rotation x 5 ", "A vertices none faces none\n", "title ", "-",
    "\n", '"a" ', "\t", "1", "0.1, ",
    "patterns face 1 polygon p red 0 0, 0 1, 1 1 ", "light L position 1 2 3 ", "sections x 1 ", "\u2028", "A ",
)  # fmt: skip
_HEADS = (
    "",
    "A box 1 1 1 ",
    'title "',
    "A ",
    "A vertices ",
    "A box ",
    "A surface sphere ",
    'A surface graph "',
    "A hollow ",
    "light ",
)


def scene_bytes(rng: Random, smooth: float = 0.4) -> bytes:
    """A scene file: nearly right, damaged by words or by bytes, or one part of it again and again."""
    way = rng.random()
    if way < 0.02:
        many = repeated(rng, [lambda _, part=part: part.encode() for part in _PARTS], 8000)
        return one(rng, _HEADS).encode() + many + one(rng, (b"", b'"', b" box 1 1 1"))
    text = scene(rng, smooth)
    if way < 0.35:
        text = " ".join(changed_words(rng, text.replace("\n", " \n ").split(" "), VOCABULARY))
    if way < 0.40:
        text = text.replace(" ", f" {one(rng, HOSTILE)} ", 1)
    data = text.encode("utf-8", "surrogatepass")
    return changed_bytes(rng, data) if 0.40 <= way < 0.5 else data
