from __future__ import annotations

import gzip
import hashlib
import io
import os
import subprocess
import sys
import tempfile
import time
from base64 import b64encode
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from support.paths import DATA

import vectorplot as vp
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import box
from vectorplot.save import FORMATS, MOST_MARKS, save, write, write_together, write_whole
from vectorplot.surfaces import Domain, surface_of_function
from vectorplot.testing import assert_drawings_equal, certificate

# Also run in processes of their own.
BUILD = """
import numpy as np
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
n = np.zeros(50, dtype=np.intp)
points = np.random.default_rng(1).uniform(0.0, 90.0, (150, 2))
paths = Paths(points, np.arange(51) * 3, n > 0, n, n, n, np.zeros((150, 3)))
layers = (Layer("visible", Pen(), (paths,)), Layer("b", Pen(), (Paths.empty(),)))
drawing = Drawing(100.0, 90.0, layers, ("x",), "title")
"""
HASHES = """
import hashlib
from vectorplot.save import FORMATS, write
print(*(hashlib.sha256(write(drawing, format)).hexdigest() for format in FORMATS))
"""


@pytest.fixture
def drawing() -> Drawing:
    names: dict[str, object] = {}
    exec(BUILD, names)
    return names["drawing"]  # type: ignore[return-value]


@pytest.mark.slow
@pytest.mark.hard(57)
def test_hard_57_same_drawing_same_bytes_in_another_second_and_process(drawing):
    first = [hashlib.sha256(write(drawing, format)).hexdigest() for format in FORMATS]
    time.sleep(1.1)
    environment = {**os.environ, "PYTHONHASHSEED": "7", "TZ": "Asia/Tokyo", "LC_ALL": "C"}
    command = [sys.executable, "-c", BUILD + HASHES]
    other = subprocess.run(command, capture_output=True, text=True, check=True, env=environment).stdout.split()
    assert first == other


@pytest.mark.parametrize("format", FORMATS)
def test_save_writes_what_write_returns(drawing, tmp_path, format):
    for name in (f"a.{format}", f"b.{format.upper()}"):
        save(drawing, tmp_path / name)
        save(drawing, str(tmp_path / name))
        assert (tmp_path / name).read_bytes() == write(drawing, format)
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"a.{format}", f"b.{format.upper()}"]


def test_languages_of_plotters_are_those_of_vpype(drawing, tmp_path):
    with pytest.raises(InputError, match=r"unknown suffix '\.HPGL'.*\.json; vpype writes it from an \.svg$"):
        save(drawing, tmp_path / "a.HPGL")


@pytest.mark.parametrize("name", ["a.gif", "a", ".svg", "a.svg.bak"])
def test_an_unknown_suffix_is_refused(drawing, tmp_path, name):
    with pytest.raises(InputError, match=r"unknown suffix .*\.svg, \.ps, \.eps, \.pdf, \.png, \.tex, \.dxf, \.json"):
        save(drawing, tmp_path / name)
    with pytest.raises(InputError, match="unknown format"):
        write(drawing, "gif")
    assert not list(tmp_path.iterdir())


def test_a_refused_drawing_leaves_the_old_file(drawing, tmp_path):
    file = tmp_path / "a.svg"
    file.write_text("old")
    with pytest.raises(InputError):
        save(replace(drawing, width_mm=np.nan), file)
    assert file.read_text() == "old" and len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("interruption", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_write_that_breaks_off_leaves_the_old_file_and_no_other(drawing, tmp_path, monkeypatch, interruption):
    file = tmp_path / "a.svg"
    file.write_text("old")

    def fail(*_):
        raise interruption

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(type(interruption)) as error:
        save(drawing, file)
    assert file.read_text() == "old" and len(list(tmp_path.iterdir())) == 1
    if isinstance(interruption, OSError):
        assert error.value.filename == str(file)


def test_a_folder_that_does_not_exist_is_named(drawing, tmp_path):
    with pytest.raises(FileNotFoundError) as error:
        save(drawing, tmp_path / "no" / "a.svg")
    assert error.value.filename == str(tmp_path / "no" / "a.svg")


def test_the_mode_of_a_replaced_file_is_kept_and_a_link_followed(drawing, tmp_path):
    file, link = tmp_path / "a.svg", tmp_path / "link.svg"
    file.write_text("old")
    file.chmod(0o640)
    link.symlink_to(file)
    save(drawing, link)
    assert link.is_symlink() and file.read_bytes() == write(drawing, "svg")
    assert file.stat().st_mode & 0o777 == 0o640


@pytest.mark.slow
def test_writing_svg_does_not_load_cairo_and_writing_ps_not_svgwrite():
    for formats, absent in ((("svg", "json"), "cairo"), (("ps",), "svgwrite")):
        script = f"{BUILD}\nimport sys\nfrom vectorplot.save import write\n"
        script += f"for format in {formats}: write(drawing, format)"
        check = f"{script}\nassert {absent!r} not in sys.modules and 'scipy' not in sys.modules"
        subprocess.run([sys.executable, "-c", check], check=True)


WITHOUT_CAIRO = """
import sys
sys.modules["cairo"] = None
import vectorplot as vp
from vectorplot.cli.main import run
vectors, pictures = ("svg", "json", "dxf", "tex"), ("pdf", "ps", "eps", "png")
for verb in ("draw", "paint"):
    print(*(run([verb, "box", "-o", f"{verb}.{suffix}"]) for suffix in (*vectors, *pictures)))
print(run(["draw", "no such file", "-o", "early.pdf"]))
print(run(["render", "box", "-o", "render.png", "--size", "40x30"]))
print(run(["animate", "cubes", "-a", "cubes", "--frames", "1", "-o", "film.svg"]))
print(run(["animate", "cubes", "-a", "cubes", "-o", "film.pdf"]))
drawing = vp.read("draw.json")
print(*drawing._repr_mimebundle_(), *drawing._repr_mimebundle_(include=["image/png"]))
"""


@pytest.mark.slow
def test_without_cairo_vectors_and_pixels_of_render_are_written_and_the_rest_says_what_it_needs(tmp_path):
    told = subprocess.run(
        [sys.executable, "-c", WITHOUT_CAIRO], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert told.stdout.splitlines() == ["0 0 0 0 1 1 1 1", "0 0 0 0 1 1 1 1", "1", "0", "0", "1", "image/svg+xml"]
    (line,) = set(told.stderr.splitlines())
    assert line.startswith("vectorplot: ") and "needs pycairo: pip install '.[cairo]'" in line
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        [f"{verb}.{suffix}" for verb in ("draw", "paint") for suffix in ("svg", "json", "dxf", "tex")]
        + ["render.png", "film.svg"]
    )


def test_a_drawing_of_several_marks_keeps_them_all():
    n = np.zeros(1, dtype=np.intp)
    one = Paths(np.array([[1.0, 1.0], [2.0, 2.0]]), np.array([0, 2]), n > 0, n, n, n, np.zeros((2, 3)))
    drawing = Drawing(10.0, 10.0, (Layer("a", Pen(), (one, one)), Layer("b", Pen(), ())))
    assert write(drawing, "svg").count(b"<polyline") == 2


def test_a_scene_is_saved_as_a_scene_file_and_read_back(tmp_path):
    scene = vp.read(DATA / "table.scene")
    vp.save(scene, tmp_path / "copy.scene")
    again = vp.read(tmp_path / "copy.scene")
    assert write(again, "scene") == write(scene, "scene") == (tmp_path / "copy.scene").read_bytes()
    assert_drawings_equal(vp.draw(scene), vp.draw(again))


def test_a_drawing_is_saved_as_json_and_read_back(drawing, tmp_path):
    vp.save(drawing, tmp_path / "drawing.json")
    again = vp.read(tmp_path / "drawing.json")
    assert isinstance(again, vp.Drawing)
    assert_drawings_equal(drawing, again)
    vp.save(again, tmp_path / "again.JSON")
    assert isinstance(vp.read(tmp_path / "again.JSON"), vp.Drawing)


def test_scenes_and_drawings_are_not_each_other(drawing, tmp_path):
    scene = vp.read(DATA / "pencil.scene")
    for suffix in FORMATS:
        with pytest.raises(InputError, match="draw, paint or render it first"):
            vp.save(scene, tmp_path / f"x.{suffix}")
    with pytest.raises(InputError, match="only a scene"):
        vp.save(drawing, tmp_path / "x.scene")
    bent = surface_of_function(lambda u, v: (u, v, u * v), Domain(0, 1, 0, 1))
    unwritable = vp.Scene((vp.Item("A", bent),))
    (tmp_path / "old.scene").write_text("old")
    with pytest.raises(InputError, match="A"):
        vp.save(unwritable, tmp_path / "old.scene")
    assert [path.name for path in tmp_path.iterdir()] == ["old.scene"] and (tmp_path / "old.scene").read_text() == "old"
    (tmp_path / "scene.json").write_text("{}")
    with pytest.raises(InputError, match="not a drawing"):
        vp.read(tmp_path / "scene.json")


@pytest.mark.skipif(not os.path.exists("/dev/fd"), reason="no names of open files")
def test_a_pipe_with_a_name_is_written(drawing):
    """What ``-o /dev/stdout`` before a pipe and ``-o >(...)`` name."""
    reader, writer = os.pipe()
    with os.fdopen(reader, "rb") as end:
        small = replace(drawing, layers=(), title="")
        write_whole(f"/dev/fd/{writer}", write(small, "svg"))
        os.close(writer)
        assert end.read() == write(small, "svg")


def test_saving_never_touches_what_new_files_of_others_may_have(drawing, tmp_path, monkeypatch):
    """The mask belongs to the whole process: other threads make files meanwhile."""
    monkeypatch.setattr(os, "umask", lambda _: pytest.fail("the mask was changed"))
    save(drawing, tmp_path / "x.svg")
    (tmp_path / "y").touch()
    assert (tmp_path / "x.svg").stat().st_mode == (tmp_path / "y").stat().st_mode


def test_a_private_file_is_private_while_it_is_replaced(drawing, tmp_path, monkeypatch):
    """What is written beside it has its mode bits from the start."""
    target = tmp_path / "x.svg"
    target.touch(mode=0o600)
    modes, real = [], os.fdopen
    monkeypatch.setattr(os, "fdopen", lambda fd, *how: modes.append(os.fstat(fd).st_mode & 0o777) or real(fd, *how))
    save(drawing, target)
    assert modes == [0o600] and target.stat().st_mode & 0o777 == 0o600


@pytest.mark.parametrize("before", [(), ("a",), ("b",), ("a", "b")])
@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize("error", [KeyboardInterrupt(), OSError(28, "No space left on device"), MemoryError()])
def test_files_that_belong_together_are_all_new_or_all_as_they_were(tmp_path, monkeypatch, before, links, error):
    """Whatever call of the system something stops, before it is done or just after it."""
    names = ["a", "b"]
    contents = {tmp_path / name: f"new {name}".encode() for name in names}
    if not links:
        monkeypatch.setattr(os, "link", lambda *_: (_ for _ in ()).throw(OSError(95, "Operation not supported")))
    calls = ["open", "fdopen", "chmod", "replace"] + (["link"] if links else [])
    stopped = 0
    for where in range(1, 14):
        for after in (False, True):
            for name in names:
                (tmp_path / name).unlink(missing_ok=True)
            for name in before:
                (tmp_path / name).write_text(f"old {name}")
            old = {path.name: path.read_text() for path in tmp_path.iterdir()}
            left = [where]
            with monkeypatch.context() as patch:
                for call in calls:
                    # A file that is open already would be one that nobody closes.
                    done = after and call not in ("open", "fdopen")
                    patch.setattr(os, call, stopping(getattr(os, call), left, done, error))
                try:
                    write_together(contents)
                    new = {name: f"new {name}" for name in names}
                except type(error):
                    new, stopped = old, stopped + 1
            assert {path.name: path.read_text() for path in tmp_path.iterdir()} == new
    assert stopped >= 6


def stopping(real, left, after, error):
    """A function that raises an error at its so many-th call, instead of its work or after it."""

    def called(*given, **named):
        left[0] -= 1
        if left[0] != 0:
            return real(*given, **named)
        if after:
            real(*given, **named)
        raise error

    return called


@pytest.mark.parametrize("bad", ["vd1", "vd2"])
def test_a_movie_of_which_one_file_cannot_be_written_stays_as_it_was(drawing, tmp_path, monkeypatch, bad):
    vp.save_frames([drawing], tmp_path / "m.vd1")
    old = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    real = os.replace

    def replace_others(source, target):
        if str(target).endswith(bad):
            raise PermissionError(13, "no")
        real(source, target)

    monkeypatch.setattr(os, "replace", replace_others)
    with pytest.raises(PermissionError) as error:
        vp.save_frames([drawing, replace(drawing, layers=())], tmp_path / "m.vd1")
    assert error.value.filename == str(tmp_path / f"m.{bad}")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == old


# Into open files.


@pytest.fixture
def lettered(drawing) -> Drawing:
    """A drawing with a title and a text that are not ASCII."""
    one = np.ones(1)
    text = Texts(
        ("Größe α",), np.full((1, 2), 20.0), 5.0 * one, 0.0 * one, 0.0 * one, 30.0 * one, np.zeros(1, dtype=np.intp)
    )
    return replace(drawing, layers=(*drawing.layers, Layer("text", Pen(), (text,))), title="Höhe")


def content_of(made: object, format: str, path: Path) -> bytes:
    """What stands in a file with a name, once it is saved there."""
    vp.save(made, path.with_suffix(f".{format}"))
    return path.with_suffix(f".{format}").read_bytes()


@pytest.mark.parametrize("format", FORMATS)
def test_a_binary_file_gets_the_bytes_of_the_path(lettered, tmp_path, format):
    expected = content_of(lettered, format, tmp_path / "a")
    for word in (format, format.upper()):
        memory = io.BytesIO()
        vp.save(lettered, memory, format=word)
        assert memory.getvalue() == expected and not memory.closed
    with open(tmp_path / "buffered", "wb") as file:
        lettered.save(file, format=format)
    with open(tmp_path / "unbuffered", "wb", buffering=0) as file:
        lettered.save(file, format=format)
    with gzip.open(tmp_path / "packed", "wb") as packed:
        lettered.save(packed, format=format)
    with gzip.open(tmp_path / "packed") as packed:
        found = packed.read()
    assert found == (tmp_path / "buffered").read_bytes() == (tmp_path / "unbuffered").read_bytes() == expected
    vp.save(lettered, tmp_path / "no_suffix", format=format)
    assert (tmp_path / "no_suffix").read_bytes() == expected


@pytest.mark.parametrize("format", FORMATS)
def test_a_text_file_gets_what_is_text(lettered, tmp_path, format):
    memory, file = io.StringIO(), tempfile.NamedTemporaryFile("w+", encoding="utf-8", newline="")
    with file:
        if format in ("pdf", "png"):
            for text in (memory, file):
                with pytest.raises(InputError, match=f"a text file takes svg, .*; {format} needs a binary one"):
                    vp.save(lettered, text, format=format)
            assert not memory.getvalue() and not file.tell()
            return
        expected = content_of(lettered, format, tmp_path / "a").decode("utf-8")
        for text in (memory, file):
            vp.save(lettered, text, format=format)
        file.seek(0)
        assert memory.getvalue() == file.read() == expected


@pytest.mark.parametrize("encoding", ["latin-1", "ascii", "utf-16"])
def test_a_text_file_that_would_change_the_letters_is_refused(lettered, encoding):
    below = io.BytesIO()
    text = io.TextIOWrapper(below, encoding=encoding)
    with pytest.raises(InputError, match=f"a text file in {encoding} cannot hold it: open it with encoding='utf-8'"):
        vp.save(lettered, text, format="svg")
    text.flush()
    assert not below.getvalue()


def test_pixels_scenes_pages_films_and_certificates_go_into_files_too(drawing, tmp_path):
    cube = vp.Item("cube", box((2, 2, 2)))
    film = vp.animate(vp.Animation(lambda time: cube, frames=2), page="40x30")
    made = {
        "png": vp.render(vp.Scene((cube,)), size=(20, 10)),
        "scene": vp.Scene((cube,)),
        "pdf": [drawing, drawing],
        "svg": film,
        "json": certificate(vp.Scene((cube,)), vp.draw(vp.Scene((cube,)))),
    }
    for format, one in made.items():
        memory, path = io.BytesIO(), tmp_path / f"a.{format}"
        told = {} if format == "json" else {"format": format}
        (one.save if hasattr(one, "save") else partial(vp.save, one))(memory, **told)
        (one.save if hasattr(one, "save") else partial(vp.save, one))(path)
        assert memory.getvalue() == path.read_bytes() != b""
    memory = io.BytesIO()
    vp.save(film, memory, format="PDF")
    assert memory.getvalue() == content_of(film, "pdf", tmp_path / "film")


@pytest.mark.parametrize(
    ("target", "format", "cause"),
    [
        (io.BytesIO(), None, "an open file has no suffix: name the format, as in format='svg'"),
        (io.StringIO(), None, "an open file has no suffix"),
        (io.BytesIO(), "gif", "unknown format 'gif'; known are svg"),
        (io.BytesIO(), "hpgl", "unknown format 'hpgl'; .*; vpype writes it from an .svg"),
        (io.BytesIO(), "scene", "only a scene is written as scene"),
        (io.StringIO(), "svgg", "a text file takes svg, .*; svgg needs"),
        (None, None, "expected a path or an open file to save into, not NoneType"),
        (7, "svg", "expected a path or an open file to save into, not int"),
    ],
)
def test_what_cannot_be_written_into_is_told(drawing, target, format, cause):
    with pytest.raises(InputError, match=cause):
        vp.save(drawing, target, format=format)
    assert target in (None, 7) or not target.getvalue()


@pytest.mark.parametrize("format", ["vd1", "vd2", "frames", "dxf"])
def test_films_of_several_files_need_a_path(drawing, format):
    memory = io.BytesIO()
    with pytest.raises(InputError, match=f"{format}: .*; an open file takes pdf, svg, mp4, webm, gif"):
        vp.save_frames([drawing], memory, format=format)
    with pytest.raises(InputError, match="name the format"):
        vp.save_frames([drawing], memory)
    assert not memory.getvalue()


def test_a_file_is_given_nothing_of_a_picture_that_fails(drawing):
    def frames():
        yield drawing
        raise InputError("no second frame")

    for format in ("pdf", "svg"):
        memory = io.BytesIO()
        with pytest.raises(InputError, match="no second frame"):
            vp.save_frames(frames(), memory, format=format)
        with pytest.raises(InputError):
            vp.save(replace(drawing, width_mm=np.nan), memory, format=format)
        assert not memory.getvalue()


class Trickling(io.RawIOBase):
    """A file without a buffer that takes a thousand bytes at once."""

    def __init__(self) -> None:
        self.taken = b""

    def writable(self) -> bool:
        return True

    def write(self, content: memoryview) -> int:
        self.taken += content[:1000]
        return len(content[:1000])


def test_a_file_without_a_buffer_gets_all_of_it(drawing):
    file = Trickling()
    vp.save(drawing, file, format="pdf")
    assert file.taken == write(drawing, "pdf") and len(file.taken) > 1000


# In notebooks.


def many_marks() -> Drawing:
    """A drawing with one mark more than notebooks are given as SVG."""
    ends = np.zeros((2 * MOST_MARKS + 2, 2))
    ends[:, 0] = np.arange(len(ends)) / len(ends) * 90.0
    return Drawing(100.0, 90.0, (Layer("a", Pen(), (Paths.of_polylines(ends.reshape(-1, 2, 2)),)),))


def test_a_notebook_stores_a_drawing_once(drawing):
    assert drawing._repr_mimebundle_() == {"image/svg+xml": write(drawing, "svg").decode()}
    many = many_marks()
    assert drawing._repr_mimebundle_(include=["image/png"]) == {"image/png": b64encode(write(drawing, "png")).decode()}
    assert list(many._repr_mimebundle_()) == ["image/png"]
    assert list(many._repr_mimebundle_(include={"image/svg+xml", "text/plain"})) == ["image/svg+xml"]
    assert list(drawing._repr_mimebundle_(exclude={"image/svg+xml"})) == ["image/png"]
    assert drawing._repr_mimebundle_(include=["text/plain"]) == {}


def test_what_ipython_makes_of_drawings_and_pixels_is_one_picture_and_a_text(drawing):
    formatter = pytest.importorskip("IPython.core.formatters").DisplayFormatter()
    pixels = vp.Image(np.zeros((2, 3, 3), dtype=np.uint8))
    for shown, kind in ((drawing, "image/svg+xml"), (pixels, "image/png")):
        assert set(formatter.format(shown)[0]) == {kind, "text/plain"}
    assert set(formatter.format(drawing, include={"image/png"})[0]) == {"image/png"}
