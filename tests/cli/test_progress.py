import io
import sys
import warnings

from vectorplot.cli import picture as progress
from vectorplot.errors import InputWarning
from vectorplot.pictures.pipeline import StageReport


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_there_is_no_bar_without_a_terminal_or_in_silence(monkeypatch):
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    with progress.progress_bar(quiet=False) as bar:
        assert bar is None
    monkeypatch.setattr(sys, "stderr", Terminal())
    with progress.progress_bar(quiet=True) as bar:
        assert bar is None


def test_short_work_shows_no_bar(monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal())
    with progress.progress_bar(quiet=False) as bar:
        bar("edges", 0.5)
    assert sys.stderr.getvalue() == ""


def test_long_work_shows_the_stage_and_takes_the_bar_away(monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal())
    monkeypatch.setattr(progress, "PATIENCE_S", 0.0)
    monkeypatch.setattr(progress, "INTERVAL_S", 0.0)
    with progress.progress_bar(quiet=False) as bar:
        bar("edges", 0.25)
        bar("ink", 2.0)
    text = sys.stderr.getvalue()
    assert "edges" in text and " 25%" in text and "100%" in text
    assert text.rpartition("\r")[2].strip() == ""


def test_warnings_are_told_once_and_only_those_about_input(capsys):
    with progress.reported_warnings(quiet=False):
        for _ in range(2):
            warnings.warn("a.obj: one\nthing", InputWarning, stacklevel=1)
        warnings.simplefilter("ignore", RuntimeWarning)
        warnings.warn("another thing", RuntimeWarning, stacklevel=1)
    assert capsys.readouterr().err == "vectorplot: warning: a.obj: one thing\n"


def test_the_table_has_a_line_a_stage_and_a_total():
    reports = [StageReport("read", "a.obj", 0.25, 1, 50.0), StageReport("ink", "strokes", 0.5, 1234, 80.0)]
    lines = progress.table(reports).splitlines()
    assert [line.split()[0] for line in lines] == ["stage", "read", "ink", "total"]
    assert lines[2].split()[1:4] == ["500.0", "1234", "80.0"]
    assert lines[3].split()[1:] == ["750.0", "80.0"]


def test_what_was_measured_of_a_stage_later_on_stands_beside_it():
    ink = StageReport("ink", "strokes", 0.5, 1234, 80.0)
    off = StageReport("ink", "strokes", 0.25, 0, 90.0, 0.0123, "mm")
    lines = progress.table([ink, StageReport("write", "as svg", 0.5, 7, 90.0), off]).splitlines()
    assert [line.split()[0] for line in lines] == ["stage", "ink", "write", "total"]
    assert lines[1].split()[1:] == ["500.0", "1234", "80.0", "0.012", "mm", "strokes"]
    assert lines[3].split()[1:] == ["1000.0", "90.0"]
