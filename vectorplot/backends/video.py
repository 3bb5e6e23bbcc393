"""Pictures as a video: MP4, WebM and GIF, through the package av."""

from __future__ import annotations

import io
from collections.abc import Iterable
from fractions import Fraction
from types import ModuleType
from typing import Any

import numpy as np

from vectorplot.errors import InputError, not_installed
from vectorplot.shading.image import Bytes

CODECS = {"mp4": ("libx264", "yuv420p"), "webm": ("libvpx-vp9", "yuv420p"), "gif": ("gif", "pal8")}
"""The coder of each format, and how its pixels lie."""

QUALITY = {"mp4": {"crf": "18"}, "webm": {"crf": "30", "b": "0"}}
"""What coders are told, so that thin lines stay sharp."""

FINEST_TIME = 1000
"""Frames a second are told as a fraction of no larger denominator."""


def library() -> ModuleType:
    """The package av. Errors: InputError where it is not installed."""
    try:
        import av
    except ImportError:
        raise not_installed("a video", "av", "video") from None
    return av


def video_bytes(pictures: Iterable[Bytes], fps: float, format: str) -> bytes:
    """Pictures (rows, columns, 3) of one size as a video of a format of CODECS.

    Sides that are odd get a row or a column more, white, where the coder needs that.
    Errors: InputError where av is not installed, and for pictures that it refuses.
    """
    av = library()
    codec, layout = CODECS[format]
    stream_bytes = io.BytesIO()
    rate = Fraction(fps).limit_denominator(FINEST_TIME)
    try:
        with av.open(stream_bytes, mode="w", format=format) as file:
            stream, graph = None, None
            for number, picture in enumerate(pictures):
                even = picture if format == "gif" else _even(picture)
                if stream is None:
                    stream = _stream(file, codec, layout, rate, even, QUALITY.get(format, {}))
                    graph = _with_palettes(av, stream) if format == "gif" else None
                frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(even), format="rgb24")
                frame.pts, frame.time_base = number, 1 / rate
                for coded in _through(graph, frame):
                    file.mux(stream.encode(coded))
            if stream is not None:
                file.mux(stream.encode(None))
    except av.FFmpegError as error:
        raise InputError(f"the video cannot be coded: {error.strerror or error}") from None
    return stream_bytes.getvalue()


def _stream(file: Any, codec: str, layout: str, rate: Fraction, picture: Bytes, options: dict[str, str]) -> Any:
    stream = file.add_stream(codec, rate=rate, options=options)
    stream.height, stream.width = picture.shape[:2]
    stream.pix_fmt = layout
    stream.time_base = 1 / rate
    return stream


def _with_palettes(av: Any, stream: Any) -> Any:
    """The filters that take frames to 256 colours each."""
    graph = av.filter.Graph()
    source = graph.add_buffer(
        width=stream.width, height=stream.height, format=av.VideoFormat("rgb24"), time_base=stream.time_base
    )
    split = graph.add("split")
    colours = graph.add("palettegen", "stats_mode=single")
    used = graph.add("paletteuse", "new=1:dither=none")
    sink = graph.add("buffersink")
    source.link_to(split)
    split.link_to(colours, 0, 0)
    split.link_to(used, 1, 0)
    colours.link_to(used, 0, 1)
    used.link_to(sink)
    graph.configure()
    return graph


def _through(graph: Any, frame: Any) -> list[Any]:
    if graph is None:
        return [frame]
    graph.push(frame)
    return [graph.pull()]


def _even(picture: Bytes) -> Bytes:
    rows, columns = picture.shape[0] % 2, picture.shape[1] % 2
    return np.pad(picture, ((0, rows), (0, columns), (0, 0)), constant_values=255) if rows or columns else picture
