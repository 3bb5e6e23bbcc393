"""Bytes as printable text, four in five characters, as PostScript files hold them; in bulk.

Source: PostScript Language Reference, section 3.13.3 (ASCII85Encode and ASCII85Decode).
"""

from __future__ import annotations

import numpy as np

_POWERS = 85 ** np.arange(4, -1, -1, dtype=np.int64)
_FIRST, _LAST, _ZEROS = ord("!"), b"u", b"z"
_LINE = 80


def ascii85_decoded(text: bytes) -> bytes:
    """The bytes that a text without its end mark stands for; white space in it is passed over.

    Degenerate: no text, no bytes.
    """
    digits = b"".join(text.split()).replace(_ZEROS, b"!!!!!")
    missing = -len(digits) % 5
    rows = np.frombuffer(digits + missing * _LAST, dtype=np.uint8).reshape(-1, 5).astype(np.int64) - _FIRST
    return (rows @ _POWERS).astype(">u4").tobytes()[: 4 * len(rows) - missing]


def ascii85_encoded(data: bytes) -> bytes:
    """The text of bytes, without an end mark, in lines of 80 characters; four zeros are one character.

    Degenerate: no bytes, no text.
    """
    missing = -len(data) % 4
    words = np.frombuffer(data + bytes(missing), dtype=">u4").astype(np.int64)
    digits = (words[:, None] // _POWERS % 85 + _FIRST).astype(np.uint8)
    size = np.full(len(words), 5)
    # The last word is written out, cut by as many characters as it lacks bytes.
    short = (words == 0) & (np.arange(len(words)) < len(words) - (missing > 0))
    digits[short, 0], size[short] = ord(_ZEROS), 1
    size[-1:] -= missing
    text = digits[np.arange(5) < size[:, None]].tobytes()
    return b"\n".join(text[start : start + _LINE] for start in range(0, len(text), _LINE))
