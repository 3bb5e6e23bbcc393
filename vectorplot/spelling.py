"""How far a word is from another one as people misspell words, and which of some words it was meant for."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import SequenceMatcher

SHORT = 4
"""Letters of words in which two slips leave too little of the word."""

ALIKE = 0.72
"""Words that are more than two slips apart and share fewer of their letters, as a part of both words' letters, are not
taken for each other."""

FAR = 3
"""Slips between words that are no more than alike."""

LONGEST = 40
"""Letters of a word that are looked at."""


def slips(word: str, other: str) -> int:
    """By how many slips two words differ: letters that are missing, too many or wrong, and neighbours that are swapped.

    Source: Damerau, A technique for computer detection and correction of spelling errors, 1964 (optimal string
    alignment: no letter is touched twice).
    """
    before: list[int] = []
    row = list(range(len(other) + 1))
    for i, letter in enumerate(word, 1):
        earlier, before, row = before, row, [i]
        for j, against in enumerate(other, 1):
            least = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (letter != against))
            if i > 1 and j > 1 and letter == other[j - 2] and word[i - 2] == against:
                least = min(least, earlier[j - 2] + 1)
            row.append(least)
    return row[-1]


def one_slip(word: str, other: str) -> bool:
    """Whether two words are the same but for one slip at most; - and _ are the same."""
    return _apart(word, other, 1) < FAR


def share(word: str, other: str) -> float:
    """The letters that two words share in their order, as a part of all of their letters; 0 for less than ALIKE."""
    letters, of_other = _plain(word), _plain(other)
    total = len(letters) + len(of_other)
    # In whatever order, they share no fewer.
    shared = sum(min(letters.count(one), of_other.count(one)) for one in set(letters))
    if total and 2.0 * shared / total < ALIKE:
        return 0.0
    found = SequenceMatcher(None, of_other, letters).ratio()
    return found if found >= ALIKE else 0.0


def most_alike(word: str, known: Sequence[str]) -> str | None:
    """The known word that another one was most likely meant for, or None; the first one of several.

    Words one or two slips away come first, the nearest before all, with one slip at most where either word has no more
    than SHORT letters; then those that share most of their letters.
    """
    apart = [_apart(word, other, 2) for other in known]
    least = min(apart, default=FAR)
    # How much they share decides between those that are as near.
    near = [(-share(word, other), place) for place, other in enumerate(known) if apart[place] == least]
    found = min((one for one in near if least < FAR or one[0]), default=None)
    return None if found is None else known[found[1]]


def _apart(word: str, other: str, most: int) -> int:
    """The slips between two words, or FAR where they are more than so many, or more than leave enough of them."""
    letters, of_other = _plain(word), _plain(other)
    most = _most_slips(letters, of_other, most)
    # Each slip changes at most two of the letters that words have.
    possible = abs(len(letters) - len(of_other)) <= most and len(set(letters) ^ set(of_other)) <= 2 * most
    found = slips(letters, of_other) if possible else FAR
    return found if found <= most else FAR


def _most_slips(word: str, other: str, most: int) -> int:
    """The slips that two words for the same may be apart: less than all of their letters."""
    return min(most, 2 if min(len(word), len(other)) > SHORT else 1, max(len(word), len(other)) - 1)


def _plain(word: str) -> str:
    return word[:LONGEST].replace("_", "-")
