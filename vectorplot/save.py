"""Saving a drawing, a picture of pixels or a scene under a name whose suffix says the format, or into an open file."""

from __future__ import annotations

import io
import os
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputError
from vectorplot.scene.scene import Scene
from vectorplot.shading.image import Image
from vectorplot.words import format_hint

# Module and function of each format; a backend is imported when it is called for.
_BACKENDS = {
    "svg": ("svg", "svg_bytes"),
    "ps": ("cairo", "ps_bytes"),
    "eps": ("cairo", "eps_bytes"),
    "pdf": ("cairo", "pdf_bytes"),
    "png": ("cairo", "png_bytes"),
    "tex": ("tikz", "tikz_bytes"),
    "dxf": ("dxf", "dxf_bytes"),
    "json": ("json", "json_bytes"),
}

_BINARY = getattr(os, "O_BINARY", 0)

FORMATS = tuple(_BACKENDS)
"""The formats of drawings."""

_SCENE = "scene"
"""The one format of scenes."""

MESHES = ("stl", "obj", "ply", "off")
"""The formats of meshes, for whatever has faces."""

_TEXTS = ("svg", "ps", "eps", "tex", "dxf", "json", "obj", "off", _SCENE)
"""The formats that text files take."""


class File(Protocol):
    """An open file, or what is written to as to one."""

    def write(self, content: Any, /) -> Any:
        """Take bytes, or text where it has an encoding."""
        ...


Destination = str | os.PathLike[str] | File
"""Where things are saved: a path, or an open file, binary or text."""


@runtime_checkable
class Frames(Protocol):
    """Pictures that know how they are saved together, as a film does."""

    @property
    def fps(self) -> float:
        """Frames a second."""
        ...

    def save(self, path: Destination, *, format: str | None = None) -> None:
        """Write them in the format of the suffix, or in that of the name."""
        ...


def save(drawing: Any, path: Destination, *, format: str | None = None) -> None:
    """Write a drawing, a picture of pixels, a scene, a mesh or a film in the format of the suffix, or in a named one.

    Parameters
    ----------
    drawing : Drawing, Image, Film, sequence of Drawing, or what the verbs take
        What is written: a drawing as svg, ps, eps, pdf, png, tex (PGF/TikZ, for LaTeX), dxf or json; a picture of
        pixels as png; a Scene, Item, Mesh or surface, or a list of these, as a mesh for other programs: stl, obj, ply
        or off, or as scene, a text in the scene language; a film as pdf, svg, mp4, webm, gif or vd1, or into a folder,
        as `vp.save_frames` writes it; several drawings, such as sheets, as the pages of one pdf.
    path : str, path or file object
        The file, whose suffix says the format; or an open file, which is not closed: a binary one, or a text file for
        svg, ps, eps, tex, dxf, json, obj, off and scene.
    format : str, optional
        In place of the suffix; needed for a file object. Of a film in a folder that of its files.

    Raises
    ------
    InputError
        For an unknown suffix or format or one that is not for such a thing, for a file object without a format, a
        text file that cannot hold it, for what page_marks.sheet refuses, for shapes of a scene that the language
        has no word for, and for a mesh format where there are no faces.
    TypeError
        For what is none of these.
    OSError
        Where the file cannot be written; it names the path.

    Notes
    -----
    The file is written whole or not at all; an old one stays until the new one is complete. A file object is given all
    at once, when the picture is complete. Meshes have the units of the scene and its axes, z upwards; smooth surfaces
    become triangles that are off by a part of 0.00005 of the whole at most; curves, cuts and lights are left out.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import vectorplot as vp
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     vp.save(drawing, pathlib.Path(folder, "triangle.json"))
    ...     again = vp.read(pathlib.Path(folder, "triangle.json"))
    >>> again.items
    ('triangle',)
    >>> import io
    >>> solid = io.BytesIO()
    >>> vp.save(triangle, solid, format="stl")
    >>> answer = io.BytesIO()
    >>> vp.save(drawing, answer, format="svg")
    >>> answer.getvalue()[:5]
    b'<?xml'
    """
    if isinstance(drawing, Frames):
        drawing.save(path, format=format)
        return
    word = format_for(path, format)
    if isinstance(drawing, Sequence) and word.lower() not in (*MESHES, _SCENE):
        if word.lower() != "pdf" or not drawing:
            raise InputError("several drawings are the pages of a .pdf; one at least", file=name_of(path))
        from vectorplot.backends.cairo import pdf_pages_bytes

        put(path, pdf_pages_bytes(drawing, drawing[0].title))
        return
    if format is None and word.lower() not in (*_BACKENDS, *MESHES, _SCENE):
        known = f"known are .{', .'.join(FORMATS)}{format_hint(word)}"
        raise InputError(f"unknown suffix {'.' + word if word else ''!r}; {known}", file=name_of(path))
    put(path, write(drawing, word))


OVERLAID = ("pdf", "eps")
"""The formats that LaTeX takes in as pictures, to set letters over them."""


def save_for_latex(drawing: Drawing, path: str | os.PathLike[str]) -> None:
    """Write a drawing as PDF or EPS without its texts, and these, to be set over it by LaTeX, in a file beside it.

    Parameters
    ----------
    drawing : Drawing
        What is written: drawn with text="real", otherwise it has no texts.
    path : str or path
        The picture, in a name that ends in .pdf or .eps. The other file has its name, but ends in .tex; a document with
        the package tikz takes it in by \\input, and finds the picture where \\graphicspath says.

    Raises
    ------
    InputError
        For another suffix, and for what `save` refuses.
    OSError
        Where a file cannot be written; it names the path.

    Notes
    -----
    The letters have the document's font and the drawing's sizes; formulas between dollars are set as such.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import vectorplot as vp
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> corner = vp.Label("$\\\\alpha_1$", (0, 0, 0))
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),), labels=(corner,)), text="real")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     vp.save_for_latex(drawing, pathlib.Path(folder, "triangle.pdf"))
    ...     "$\\\\alpha_1$" in pathlib.Path(folder, "triangle.tex").read_text()
    True
    """
    name = Path(path)
    if name.suffix[1:].lower() not in OVERLAID:
        raise InputError("texts are set by LaTeX over a .pdf or .eps", file=os.fspath(path))
    picture, letters = write_for_latex(drawing, name.suffix[1:], name.name)
    write_together({path: picture, name.with_suffix(".tex"): letters})


def write_for_latex(drawing: Drawing, format: str, name: str) -> tuple[bytes, bytes]:
    """The contents of a picture, pdf or eps, without texts, and of the file that sets them over the picture of this
    name. Errors: see write."""
    from vectorplot.backends.cairo import pdf_bytes, whole_eps_bytes
    from vectorplot.backends.tikz import overlay_bytes, without_texts

    bare = without_texts(drawing)
    picture = pdf_bytes(bare) if format.lower() == "pdf" else whole_eps_bytes(bare)
    return picture, overlay_bytes(drawing, name)


def write(drawing: Any, format: str) -> bytes:
    """The drawing as the content of a file: svg, ps, eps, pdf, png (at 150 dpi), tex, dxf or json; a picture of pixels
    as png; a scene or whatever has a shape as stl, obj, ply, off or scene.

    Same drawing, same bytes. Errors: InputError for an unknown format and for what page_marks.sheet refuses; TypeError.
    """
    word = format.lower()
    if word not in (*_BACKENDS, *MESHES, _SCENE):
        raise InputError(f"unknown format {format!r}; known are {', '.join(FORMATS)}{format_hint(format)}")
    if not isinstance(drawing, Drawing | Image):
        return _shapes(drawing, word)
    if word == _SCENE:
        raise InputError("only a scene is written as scene")
    if word in MESHES:
        raise InputError(f"a picture has no faces: {word} is written of a scene, item, mesh or surface")
    if isinstance(drawing, Image):
        if word != "png":
            raise InputError(f"a picture of pixels is written as png, not as {format}")
        return drawing.png()
    return backend(format)(drawing)


def backend(format: str) -> Callable[[Drawing], bytes]:
    """What writes drawings in a format of FORMATS. Errors: InputError where the library for it is not installed."""
    module, function = _BACKENDS[format.lower()]
    found: Callable[[Drawing], bytes] = getattr(import_module(f"vectorplot.backends.{module}"), function)
    return found


def _shapes(shown: Any, format: str) -> bytes:
    """What has a shape as a scene or a mesh."""
    from vectorplot.io.anything import scene_of

    scene = scene_of(shown)
    if format == _SCENE:
        from vectorplot.io.scene_writer import write_scene

        return write_scene(scene).encode("ascii")
    if format not in MESHES:
        what = "scene" if isinstance(shown, Scene) else type(shown).__name__
        known = f"as {', '.join((_SCENE, *MESHES))}, not as {format}"
        raise InputError(f"a {what} is written {known}: draw, paint or render it first")
    from vectorplot.io.mesh_writer import mesh_bytes
    from vectorplot.shading.facet_resolution import as_meshes

    return mesh_bytes([(item.name, item.mesh) for item in as_meshes(scene).items], format)


# What is shown in a page, of the viewer or of a notebook.

MOST_MARKS = 30_000
"""Browsers and notebooks are given drawings with more of them as pixels."""


SHOWN = {"svg": "image/svg+xml", "png": "image/png"}
"""The formats that pages show, and their media types."""


def shown_as(drawing: Drawing) -> tuple[str, ...]:
    """The formats in which a page can show a drawing, the one to be shown first: svg, or png where it has very many
    marks. Without pycairo there is no png."""
    if find_spec("cairo") is None:
        return ("svg",)
    many = sum(len(mark) for layer in drawing.layers for mark in layer.marks) > MOST_MARKS
    return ("png", "svg") if many else ("svg", "png")


# Where contents go: under a path, whole or not at all, or into an open file, all at once.


def name_of(destination: Destination) -> str | None:
    """The path; None of an open file."""
    return os.fspath(destination) if isinstance(destination, (str, os.PathLike)) else None


def format_for(destination: Destination, format: str | None) -> str:
    """The format that is named, or that of the suffix, without its point.

    Errors: InputError for an open file for which none is named, a text file where the format is no text, and what is no
    destination.
    """
    name = name_of(destination)
    if name is not None:
        return Path(name).suffix[1:] if format is None else format
    if not hasattr(destination, "write"):
        raise InputError(f"expected a path or an open file to save into, not {type(destination).__name__}")
    if format is None:
        raise InputError("an open file has no suffix: name the format, as in format='svg'")
    if hasattr(destination, "encoding") and format.lower() not in _TEXTS:
        raise InputError(f"a text file takes {', '.join(_TEXTS)}; {format} needs a binary one, opened with mode 'wb'")
    return format


def put(destination: Destination, content: bytes) -> None:
    """Write the content under a path, as write_whole does, or into an open file, which must take it as format_for says.

    Errors: InputError for a text file whose encoding would not keep it; OSError.
    """
    if isinstance(destination, (str, os.PathLike)):
        write_whole(destination, content)
    elif hasattr(destination, "encoding"):
        destination.write(_text(content, destination.encoding))
    elif isinstance(destination, io.RawIOBase):
        rest = memoryview(content)
        while rest:
            # Files without a buffer may take a part only.
            rest = rest[destination.write(rest) or 0 :]
    else:
        destination.write(content)


def _text(content: bytes, encoding: str | None) -> str:
    """The content, which is UTF-8, for a text file with this encoding, or none."""
    text = content.decode("utf-8")
    if encoding is not None and text.encode(encoding, "replace") != content:
        raise InputError(f"a text file in {encoding} cannot hold it: open it with encoding='utf-8', or mode 'wb'")
    return text


def write_whole(path: str | os.PathLike[str], content: bytes) -> None:
    """Put the content into a file beside the path and rename it, so that nobody ever sees half of it.

    The mode bits of a file that is replaced are kept; a link is followed; devices and pipes are written directly.
    Errors: OSError that names the path.
    """
    write_together({path: content})


def write_together(contents: Mapping[str | os.PathLike[str], bytes]) -> None:
    """The same for files that belong together, whatever stops it: all of them are new, or all are as they were.

    Errors: OSError that names the path of the one that cannot be written.
    """
    placed: list[tuple[str | os.PathLike[str], Path, Path]] = []
    # What stands here is called in the opposite order: files get back their contents, then what lies beside them goes.
    with ExitStack() as leftovers, ExitStack() as undoing:
        for path, content in contents.items():
            with _naming(path):
                # A pipe behind a link, such as /dev/stdout, has a name of its own that nobody can open.
                if os.path.exists(path) and not os.path.isfile(path):
                    Path(path).write_bytes(content)
                    continue
                target = Path(os.path.realpath(path))
                beside = _beside(target, leftovers)
                _write(beside, target, content)
                placed.append((path, target, beside))
        for path, target, beside in placed:
            with _naming(path):
                if len(placed) > 1:
                    undoing.callback(_put_back, _kept(target, leftovers), target)
                os.replace(beside, target)
        undoing.pop_all()


@contextmanager
def _naming(path: str | os.PathLike[str]) -> Iterator[None]:
    """In the errors of the system: this path. The name of a file beside it, which is never seen, would only puzzle."""
    try:
        yield
    except OSError as error:
        raise type(error)(error.errno, error.strerror, os.fspath(path)) from None


def _beside(target: Path, leftovers: ExitStack) -> Path:
    """A new name in the folder of a file: known before it is there, so that whatever stops the work leaves none."""
    beside = target.parent / f".vectorplot-{os.urandom(8).hex()}.part"
    leftovers.callback(beside.unlink, missing_ok=True)
    return beside


def _write(beside: Path, target: Path, content: bytes) -> None:
    # As private as what is replaced, from the start; of a new file the system takes off what it may not have.
    mode = target.stat().st_mode & 0o7777 if target.exists() else None
    bits = 0o666 if mode is None else mode & 0o666
    with os.fdopen(os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _BINARY, bits), "wb") as file:
        file.write(content)
    if mode is not None:
        os.chmod(beside, mode)


def _kept(target: Path, leftovers: ExitStack) -> Path | None:
    """A second name of a file, by which it can be put back; None where there is none yet."""
    if not target.exists():
        return None
    old = _beside(target, leftovers)
    try:
        os.link(target, old)
    except OSError:
        # Not every file system knows links.
        shutil.copy2(target, old)
    return old


def _put_back(old: Path | None, target: Path) -> None:
    # What could not be replaced need not be put back either: the first error is told.
    with suppress(OSError):
        if old is None:
            target.unlink(missing_ok=True)
        else:
            os.replace(old, target)
