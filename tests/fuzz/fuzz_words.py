"""What all generators of hostile files share: numbers, names, and changes to a text or to bytes.

Every function takes a random.Random and nothing else decides, so that a seed is a file, and hypothesis can shrink it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from random import Random
from typing import TypeVar

Value = TypeVar("Value")

SMALL = ("0", "1", "2", "3", "-1", "-2", "0.5", "1.5", "-0.25", "10", "4", "5", "6", "1e1", ".5", "5.", "+1", "-0")
HOSTILE = (
    "1e308", "-1e308", "1e-308", "5e-324", "1e400", "-1e400", "1e154", "1e-154", "1e77", "1e60", "1e61", "1e-60",
    "nan", "-nan", "inf", "-inf", "infinity", "1e", "e1", "--1", "+-1", "1.2.3", "0x10", "1_0", "1,5", "9" * 20,
    "9" * 70, "1e-62",
    "0." + "3" * 50, "2147483648", "-2147483649", "4294967296", "9223372036854775808", "1e9", "1000000", "1e16", "1/2",
    "3d", "'1'", "\u0663", "1e+", "-", "+", ".", "1e-400", "0e0", "1000000000000", "1e5", "1e-9", "1e12",
)  # fmt: skip
NAMES = (
    "A", "B", "C", "BOX", "A.1", "lamp", "a-b", "_", "x", "\x1b[31mred\x1b[0m", "\u202egnp.exe", "\x9b31m",
    "\u2028", "a\tb", "\u00e4\u00f6", "\U0001f600", '"><script>', "../../x", "%s%n", "'",
    "\u0000", "\x7f", "\ufeff", "\u200b",
    "none", "face",
)  # fmt: skip


def one(rng: Random, choices: Sequence[Value]) -> Value:
    """One of some values."""
    return choices[rng.randrange(len(choices))]


def number(rng: Random, hostile: float = 0.04) -> str:
    """A number as files have it, rarely a hostile one."""
    if rng.random() < hostile:
        return one(rng, HOSTILE)
    if rng.random() < 0.5:
        return one(rng, SMALL)
    return f"{rng.uniform(-5.0, 5.0):.{rng.randrange(12)}f}"


def whole(rng: Random, least: int, most: int, hostile: float = 0.03) -> str:
    """A whole number between two others, rarely a hostile one."""
    return one(rng, HOSTILE) if rng.random() < hostile else str(rng.randint(least, most))


def changed_words(rng: Random, words: list[str], vocabulary: Sequence[str]) -> list[str]:
    """The words with a few left out, doubled, swapped, or replaced by others."""
    words = list(words)
    for _ in range(rng.choice((1, 1, 2, 4))):
        if not words:
            break
        at = rng.randrange(len(words))
        what = rng.randrange(6)
        if what == 0:
            del words[at]
        elif what == 1:
            words.insert(at, words[rng.randrange(len(words))])
        elif what == 2:
            other = rng.randrange(len(words))
            words[at], words[other] = words[other], words[at]
        elif what == 3:
            words[at] = one(rng, vocabulary)
        elif what == 4:
            words[at] = one(rng, HOSTILE)
        else:
            words = (
                words[:at]
                if rng.random() < 0.3
                else words[:at] + words[at : at + 3] * rng.randint(2, 6) + words[at + 3 :]
            )
    return words


def changed_bytes(rng: Random, data: bytes) -> bytes:
    """The bytes with some flipped, cut out, doubled, or written over with numbers that lie."""
    content = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 5, 20))):
        if not content:
            break
        at = rng.randrange(len(content))
        length = min(rng.choice((1, 1, 2, 4, 8, 50)), len(content) - at)
        what = rng.randrange(7)
        if what == 0:
            content[at] ^= 1 << rng.randrange(8)
        elif what == 1:
            del content[at : at + length]
        elif what == 2:
            content[at:at] = content[at : at + length] * rng.randint(1, 3)
        elif what == 3:
            content[at] = one(rng, b'\x00\xff\n\r "\\#,-./0v\x1b\x80\xc2')
        elif what == 4:
            del content[at:]
        elif what == 5:
            content[at : at + 4] = one(
                rng, (b"\xff\xff\xff\xff", b"\0\0\0\0", b"\xff\xff\xff\x7f", b"\0\0\x80\x7f", b"\0\0\xc0\x7f")
            )
        else:
            content[at:at] = bytes(rng.randrange(256) for _ in range(length))
    return bytes(content)


def repeated(rng: Random, parts: Sequence[Callable[[Random], bytes]], most: int) -> bytes:
    """One part again and again, up to a size: what takes quadratic time shows here."""
    part = one(rng, parts)(rng) or b" "
    return part * max(1, rng.randrange(1, most) // len(part))
