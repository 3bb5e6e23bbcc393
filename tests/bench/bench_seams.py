"""Seams between painted neighbours in many readers: run with ``pytest tests/bench/bench_seams.py -s``.

Dark polygons that cover a disc or all of the page on white paper, at 96 dots per inch: a number says by how many steps
of 255 the brightest pixel amid them is too bright. Readers that are not installed are left out; pypdfium2 is a package
of Python, the others are commands (Debian: chromium, librsvg2-bin, poppler-utils, ghostscript, mupdf-tools).
"""

from __future__ import annotations

import io
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.save import save

pytestmark = pytest.mark.bench

DPI = 96
WIDTH, HEIGHT = 60.0, 40.0
BRIGHTEST = 40
CHROMIUM = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--hide-scrollbars"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
)

Picture = np.ndarray


def fills_of(triangles: np.ndarray, colours: np.ndarray) -> Fills:
    """Triangles (t,3,2) with colours (t,3,3)."""
    count = len(triangles)
    flat = Fills.flat(triangles.reshape(-1, 2), np.arange(0, 3 * count + 1, 3), np.zeros((count, 3), dtype=np.uint8))
    columns = {name: getattr(flat, name) for name in ("points", "offsets", "opacity", "item", "points3d", "kind")}
    return Fills(**columns, colours=colours.reshape(-1, 3).astype(np.uint8))


def net(cells: int) -> np.ndarray:
    """(t,3,2) triangles of a slanted, wavy grid that covers the whole page."""
    u, v = np.meshgrid(np.linspace(-35, 75, cells + 1), np.linspace(-10, 50, cells + 1))
    places = np.stack((u + 0.3 * v + np.sin(v), v + 0.4 * np.sin(u / 3)), axis=-1).reshape(-1, 2)
    corner = np.arange(cells * (cells + 1)).reshape(cells, cells + 1)[:, :-1].ravel()
    above = corner + cells + 1
    order = np.random.default_rng(1).permutation(2 * len(corner))
    return places[np.stack((corner, corner + 1, above + 1, corner, above + 1, above), axis=1).reshape(-1, 3)][order]


def alternating(triangles: np.ndarray) -> np.ndarray:
    """Flat colours that differ, so that no two neighbours are one area."""
    return np.repeat(np.array((16, 20, 24)) + (np.arange(len(triangles)) % 3)[:, None], 3, axis=0)


def graded(triangles: np.ndarray) -> np.ndarray:
    """Shades of one palette that run over the page."""
    shade = 8.0 + 24.0 * (0.5 + 0.5 * np.sin(triangles[..., 0] / 6.0 + triangles[..., 1] / 9.0))
    return np.repeat(shade[..., None], 3, axis=2)


def mixed(triangles: np.ndarray) -> np.ndarray:
    """Shaded triangles and flat ones in turn."""
    flat, shaded = alternating(triangles).reshape(-1, 3, 3), graded(triangles)
    return np.where((np.arange(len(triangles)) % 2 == 0)[:, None, None], flat, shaded)


SAMPLES: dict[str, Fills] = {
    f"{name}, {size}": fills_of(net(cells), colours(net(cells)))
    for name, colours in (("flat", alternating), ("shaded", graded), ("in turn", mixed))
    for size, cells in (("4 mm", 25), ("1 mm", 90))
}


def shown(command: list[object], **how: object) -> Picture:
    """What a command writes to its standard output."""
    return picture_of(subprocess.run([str(part) for part in command], check=True, capture_output=True).stdout)


def picture_of(data: bytes) -> Picture:
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB")).astype(int)


def in_chromium(folder: Path) -> Picture:
    size = f"--window-size={round(WIDTH / 25.4 * DPI)},{round(HEIGHT / 25.4 * DPI)}"
    # Chromium has margins around pages, and none around a picture on one.
    (folder / "a.html").write_text('<body style="margin:0"><img src="a.svg" style="display:block">')
    profile = folder / "profile"
    command = ["chromium", *CHROMIUM, f"--user-data-dir={profile}", size, f"--screenshot={folder / 'c.png'}"]
    subprocess.run([*command, f"file://{folder / 'a.html'}"], check=True, capture_output=True, timeout=600)
    shutil.rmtree(profile, ignore_errors=True)
    return picture_of((folder / "c.png").read_bytes())


def in_rsvg(folder: Path) -> Picture:
    return shown(["rsvg-convert", "-d", DPI, "-p", DPI, "-b", "white", folder / "a.svg"])


def in_splash(folder: Path) -> Picture:
    return shown(["pdftoppm", "-r", DPI, "-png", folder / "a.pdf"])


def in_poppler_with_cairo(folder: Path) -> Picture:
    return shown(["pdftocairo", "-r", DPI, "-png", "-singlefile", folder / "a.pdf", "-"])


def in_ghostscript(file: str) -> Callable[[Path], Picture]:
    options = ("-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dGraphicsAlphaBits=4", "-sDEVICE=png16m", f"-r{DPI}")
    return lambda folder: shown(["gs", *options, "-sOutputFile=%stdout", folder / file])


def in_mupdf(folder: Path) -> Picture:
    return shown(["mutool", "draw", "-q", "-r", DPI, "-F", "png", "-o", "-", folder / "a.pdf"])


def in_pdfium(folder: Path) -> Picture:
    import pypdfium2

    page = pypdfium2.PdfDocument(folder / "a.pdf")[0]
    return np.asarray(page.render(scale=DPI / 72).to_pil().convert("RGB")).astype(int)


READERS: dict[str, tuple[str, Callable[[Path], Picture]]] = {
    "SVG in Chromium": ("chromium", in_chromium),
    "SVG in librsvg": ("rsvg-convert", in_rsvg),
    "PDF in Poppler (Splash)": ("pdftoppm", in_splash),
    "PDF in Poppler (cairo)": ("pdftocairo", in_poppler_with_cairo),
    "PDF in Ghostscript": ("gs", in_ghostscript("a.pdf")),
    "PS in Ghostscript": ("gs", in_ghostscript("a.ps")),
    "PDF in MuPDF": ("mutool", in_mupdf),
    "PDF in PDFium": ("", in_pdfium),
}


def installed(command: str) -> bool:
    if command:
        return shutil.which(command) is not None
    try:
        import pypdfium2  # noqa: F401
    except ImportError:
        return False
    return True


def seams(folder: Path) -> dict[str, list[int]]:
    """For every reader that is installed, how much too bright the brightest pixel of each sample is."""
    found: dict[str, list[int]] = {name: [] for name, (command, _) in READERS.items() if installed(command)}
    for fills in SAMPLES.values():
        for suffix in ("svg", "pdf", "ps"):
            save(Drawing(WIDTH, HEIGHT, (Layer("faces", Pen(), (fills,)),)), folder / f"a.{suffix}")
        limit = int(fills.colours.max())
        for name, worst in found.items():
            inner = READERS[name][1](folder)[6:-8, 6:-8]
            worst.append(max(0, int(inner.max()) - limit))
    return found


def report(found: dict[str, list[int]]) -> str:
    """The seams as a table of Markdown."""
    rows = [["", *SAMPLES], ["---"] * (len(SAMPLES) + 1)]
    rows += [[name, *(str(number) for number in worst)] for name, worst in found.items()]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def test_seams_in_readers(tmp_path):
    found = seams(tmp_path)
    print("\n" + report(found))
    assert max(max(worst) for worst in found.values()) <= 10


if __name__ == "__main__":
    import tempfile

    with tempfile.TemporaryDirectory() as place:
        print(report(seams(Path(place))))
