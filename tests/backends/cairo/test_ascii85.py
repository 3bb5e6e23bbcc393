"""Bytes as text of PostScript: what Python's own slow coder makes of them."""

from __future__ import annotations

import base64

import numpy as np

from vectorplot.backends.cairo import ascii85_decoded, ascii85_encoded


def test_all_lengths_and_zeros_are_coded_as_by_the_standard_library() -> None:
    random = np.random.default_rng(4)
    for length in (*range(70), 4099):
        for zeros in (0.0, 0.6, 1.0):
            data = np.where(random.random(length) < zeros, 0, random.integers(0, 256, length)).astype(np.uint8)
            text = base64.a85encode(data.tobytes(), wrapcol=80)
            assert ascii85_encoded(data.tobytes()) == text
            assert ascii85_decoded(text) == ascii85_decoded(text.replace(b"\n", b" ")) == data.tobytes()
