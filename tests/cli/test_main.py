"""The contract of the command: what it writes, what it says, and how it ends."""

import itertools
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from support.pace import slowness
from support.paths import DATA

import vectorplot
from vectorplot.cli.main import main, run

COMMAND = [sys.executable, "-m", "vectorplot"]


def shell(*arguments, **options):
    return subprocess.run([*COMMAND, *map(str, arguments)], capture_output=True, timeout=600, **options)


def test_version_and_help(capsys):
    assert run(["--version"]) == 0
    assert capsys.readouterr().out == f"vectorplot {vectorplot.__version__}\n"
    assert run(["draw", "--help"]) == 0
    assert "--crease-angle DEG" in capsys.readouterr().out


@pytest.mark.parametrize(("given", "then"), [(None, "1"), ("3", "3")])
def test_matrix_products_have_one_thread_unless_told_otherwise(monkeypatch, capsys, given, then):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", given or "")
    if given is None:
        monkeypatch.delenv("OPENBLAS_NUM_THREADS")
    monkeypatch.setattr(sys, "argv", ["vectorplot", "--version"])
    with pytest.raises(SystemExit) as end:
        main()
    assert (end.value.code, os.environ["OPENBLAS_NUM_THREADS"]) == (0, then)


@pytest.mark.slow
def test_help_loads_neither_numpy_nor_a_backend():
    script = "import sys; from vectorplot.cli.main import run; run(['draw', '--help']); print(*sys.modules)"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    loaded = {name.split(".")[0] for name in result.stdout.splitlines()[-1].split()}
    assert not loaded & {"numpy", "cairo", "scipy", "shapely", "svgwrite", "trimesh", "tqdm"}


@pytest.mark.parametrize(
    "arguments",
    [
        ["draw"],
        ["draw", "x.obj"],
        ["draw", "x.obj", "-o", "x.tiff"],
        ["draw", "x.obj", "-o", "-"],
        ["draw", "x.obj", "-o", "x.svg", "--eye", "1,2"],
        ["draw", "x.obj", "-o", "x.svg", "--fov", "180"],
        ["draw", "x.obj", "-o", "x.svg", "--page", "A99"],
        ["draw", "x.obj", "-o", "x.svg", "--hidden", "maybe"],
        ["draw", "x.obj", "-o", "x.svg", "--lines", "edgy"],
        ["draw", "x.obj", "-o", "x.svg", "--up", "0,0,1", "--twist", "3"],
        ["draw", "x.obj", "-o", "x.svg", "--halo", "-1"],
        ["draw", "x.obj", "-o", "x.svg", "--hallo", "1"],
        ["paint"],
    ],
)
def test_bad_usage_exits_with_2(arguments, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == "" and "Error: " in captured.err
    assert list(tmp_path.iterdir()) == []


BAD_FILES = {
    "nan.obj": "v 0 0 0\nv 1 0 0\nv 0 nan 1\nf 1 2 3\n",
    "index.obj": "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 9\n",
    "short.off": "OFF\n4 1 0\n0 0 0\n",
    "counts.off": "OFF\n100000000000 1 0\n0 0 0\n",
    "empty.stl": "",
    "word.scene": "BOX1 red rubber 1 2 3\n",
    "new\nline.obj": "v 0 0 x\n",
}


@pytest.mark.parametrize("name", BAD_FILES)
def test_bad_input_exits_with_1_and_one_line(name, tmp_path, capsys):
    path = tmp_path / name
    path.write_text(BAD_FILES[name], encoding="utf-8")
    out = tmp_path / "out.svg"
    assert run(["draw", str(path), "-o", str(out)]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert captured.err.startswith("vectorplot: ") and path.suffix in captured.err
    assert list(tmp_path.iterdir()) == [path]


def test_a_line_number_is_named(tmp_path, capsys):
    path = tmp_path / "nan.obj"
    path.write_text(BAD_FILES["nan.obj"], encoding="utf-8")
    run(["draw", str(path), "-o", str(tmp_path / "out.svg")])
    assert f"{path}:3: " in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        ["{missing}", "-o", "{out}"],
        ["{folder}", "-o", "{out}"],
        ["{cube}", "-o", "{folder}/no/such/place.svg"],
        ["{cube}", "-o", "{folder}/taken.svg"],
        ["{cube}", "-o", "{out}", "--eye", "1,1,1", "--target", "1,1,1"],
        ["{cube}", "-o", "{out}", "--eye", "0.5,0.5,9", "--target", "0.5,0.5,0", "--up", "0,0,1"],
    ],
)
def test_unreadable_paths_and_impossible_cameras_exit_with_1(arguments, cube, tmp_path, capsys):
    (tmp_path / "taken.svg").mkdir()
    before = sorted(tmp_path.rglob("*"))
    names = {"missing": tmp_path / "no.obj", "folder": tmp_path, "cube": cube, "out": tmp_path / "out.svg"}
    assert run(["draw", *(argument.format(**names) for argument in arguments)]) == 1
    captured = capsys.readouterr()
    assert captured.err.startswith("vectorplot: ") and captured.err.count("\n") == 1
    assert sorted(tmp_path.rglob("*")) == before


STARTS = {
    "svg": b"<?xml",
    "ps": b"%!PS-Adobe-3.0\n",
    "eps": b"%!PS-Adobe-3.0 EPSF-3.0",
    "pdf": b"%PDF",
    "png": b"\x89PNG",
    "json": b"{",
}


@pytest.mark.parametrize("word", STARTS)
def test_every_format_is_written_the_same_to_a_file_and_to_stdout(word, cube, tmp_path, capfdbinary):
    out = tmp_path / f"out.{word}"
    assert run(["draw", str(cube), "-o", str(out)]) == 0
    content = out.read_bytes()
    assert content.startswith(STARTS[word])
    capfdbinary.readouterr()
    assert run(["draw", str(cube), "-o", "-", "--format", word]) == 0
    assert capfdbinary.readouterr().out == content
    assert sorted(path.name for path in tmp_path.iterdir()) == ["cube.obj", out.name]


@pytest.mark.slow
def test_through_a_pipe_come_the_same_bytes_and_no_word(cube):
    out = cube.parent / "out.pdf"
    assert run(["draw", str(cube), "-o", str(out)]) == 0
    piped = shell("draw", cube, "-o", "-", "--format", "pdf")
    assert (piped.returncode, piped.stderr) == (0, b"")
    assert piped.stdout == out.read_bytes()


def drawn(cube, *arguments):
    out = cube.parent / "out.json"
    assert run(["draw", str(cube), "-o", str(out), *arguments]) == 0
    return json.loads(out.read_text(encoding="utf-8"))


def lengths(document, kind=None):
    """Length in the world of each side of the strokes."""
    found = []
    for stroke in document["strokes"]:
        points = [*stroke["points3d"], *(stroke["points3d"][:1] if stroke["closed"] else [])]
        if kind in (None, stroke["kind"]):
            pairs = itertools.pairwise(points)
            found += [sum((a - b) ** 2 for a, b in zip(p, q, strict=True)) ** 0.5 for p, q in pairs]
    return found


def test_negative_numbers_are_numbers(cube):
    document = drawn(cube, "--eye", "-3,4,5", "--target", "-.5,0,0", "--twist", "-20")
    assert sum(lengths(document)) == pytest.approx(9.0)  # three faces of a cube have nine edges


def test_views_pages_and_hidden_lines(cube):
    document = drawn(cube, "--view", "front", "--page", "100x60", "--margin", "5")
    assert document["page_mm"] == [100.0, 60.0]
    points = [point for stroke in document["strokes"] for point in stroke["points"]]
    assert min(y for _, y in points) == pytest.approx(5.0) and max(y for _, y in points) == pytest.approx(55.0)
    assert sum(lengths(document)) == pytest.approx(4.0)
    assert drawn(cube, "--page", "A5", "--landscape")["page_mm"] == [210.0, 148.0]
    seen = drawn(cube, "--hidden", "solid", "--eye", "5,-6,4")
    assert sum(lengths(seen)) == pytest.approx(12.0)
    assert {stroke["hidden_by"] for stroke in seen["strokes"]} == {0, 1}


def test_kinds_and_crease_angle(cube):
    assert {stroke["kind"] for stroke in drawn(cube)["strokes"]} == {"contour", "crease"}
    assert sum(lengths(drawn(cube, "--lines", "contour"))) == pytest.approx(6.0)
    assert sum(lengths(drawn(cube, "--crease-angle", "95"))) == pytest.approx(6.0)


def test_without_fit_the_page_height_spans_the_height_at_the_target(cube):
    look = [
        "--parallel",
        "--height",
        "4",
        "--eye",
        "0.5,-9,0.5",
        "--target",
        "0.5,0,0.5",
        "--no-fit",
        "--page",
        "80x40",
    ]
    points = [point for stroke in drawn(cube, *look)["strokes"] for point in stroke["points"]]
    assert [min(x for x, _ in points), max(x for x, _ in points)] == pytest.approx([35.0, 45.0])
    assert [min(y for _, y in points), max(y for _, y in points)] == pytest.approx([15.0, 25.0])


def test_explain_prints_the_stages_on_stderr(cube, tmp_path, capsys):
    assert run(["draw", str(cube), "-o", str(tmp_path / "a.svg"), "--explain"]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    stages = [line.split()[0] for line in captured.err.splitlines()]
    assert stages[:2] == ["stage", "read"] and stages[-2:] == ["write", "total"]
    assert len(stages) > 5


def test_what_was_mended_is_said_in_one_line_unless_quiet(cube, tmp_path, capsys):
    with cube.open("a", encoding="utf-8") as file:
        file.write("f 1 1 2\n")
    assert run(["draw", str(cube), "-o", str(tmp_path / "a.svg")]) == 0
    captured = capsys.readouterr()
    assert captured.err.startswith("vectorplot: warning: ") and captured.err.count("\n") == 1
    assert run(["draw", str(cube), "-o", str(tmp_path / "a.svg"), "--quiet"]) == 0
    assert capsys.readouterr().err == ""


def test_a_file_that_is_replaced_stays_until_the_new_one_is_complete(cube, tmp_path, monkeypatch, capsys):
    out = tmp_path / "out.svg"
    out.write_text("old", encoding="utf-8")

    def full(*_):
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(os, "replace", full)
    assert run(["draw", str(cube), "-o", str(out)]) == 1
    assert capsys.readouterr().err == f"vectorplot: {out}: {os.strerror(28)}\n"
    assert out.read_text(encoding="utf-8") == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["cube.obj", "out.svg"]


@pytest.mark.slow
def test_a_full_disk_under_stdout_exits_with_1(cube):
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    with Path("/dev/full").open("wb") as full:
        result = subprocess.run(
            [*COMMAND, "draw", str(cube), "-o", "-", "--format", "svg"], stdout=full, stderr=subprocess.PIPE, timeout=60
        )
    assert result.returncode == 1
    assert result.stderr.count(b"\n") == 1


@pytest.mark.slow
def test_a_reader_that_went_away_is_no_traceback(cube):
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "wb") as pipe:
        result = subprocess.run(
            [*COMMAND, "draw", str(cube), "-o", "-", "--format", "svg"], stdout=pipe, stderr=subprocess.PIPE, timeout=60
        )
    assert (result.returncode, result.stderr) == (1, b"")


SLOW = """
import sys, time
import vectorplot.pictures.pipeline as walk
from vectorplot.cli.main import main, run
real = walk.Pipeline.run
def slow(self, name, function, *args, **kwargs):
    if name == "write":
        print("working", flush=True)
        time.sleep(30)
    return real(self, name, function, *args, **kwargs)
walk.Pipeline.run = slow
sys.exit(run(sys.argv[1:]))
"""


@pytest.mark.slow
def test_ctrl_c_leaves_no_file_and_says_one_line(cube, tmp_path):
    out = tmp_path / "out.svg"
    command = [sys.executable, "-c", SLOW, "draw", str(cube), "-o", str(out)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout.readline() == b"working\n"
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=600)
    assert process.returncode == 130
    assert errors == b"vectorplot: interrupted\n"
    assert [path.name for path in tmp_path.iterdir()] == ["cube.obj"]


def test_help_is_fast():
    def children() -> float:
        """Seconds of processors that other processes took, however many run at once."""
        spent = os.times()
        return spent.children_user + spent.children_system

    def seconds() -> float:
        start = children()
        shell("--help")
        return children() - start

    assert any(seconds() < 0.5 * slowness() for _ in range(3))


@pytest.mark.parametrize(
    ("closed", "words"),
    [(">&-", "draw {scene} -o - --format svg"), ("<&-", "draw - -o {out}")],
)
def test_closed_streams_are_told_in_one_line(tmp_path, closed, words):
    scene = DATA / "pencil.scene"
    line = words.format(scene=scene, out=tmp_path / "x.svg")
    run = subprocess.run(
        ["sh", "-c", f"{sys.executable} -m vectorplot {line} {closed}"], capture_output=True, text=True, check=False
    )
    assert run.returncode == 1
    assert run.stderr.count("\n") == 1 and "closed" in run.stderr
