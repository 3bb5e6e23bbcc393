"""Warnings about a picture come before its file."""

from vectorplot.cli import picture
from vectorplot.cli.main import run


def test_what_is_wrong_with_a_picture_is_said_before_the_file_is_written(tmp_path, monkeypatch):
    nothing = 'B gray surface implicit "x^2+y^2+z^2+1" box -2 2 -2 2 -2 2'
    (tmp_path / "a.scene").write_text(f"A gray box 1 1 1\n{nothing}\n")
    order = []
    monkeypatch.setattr(picture, "write_out", lambda *_: order.append("file"))
    monkeypatch.setattr("vectorplot.cli.picture.click.echo", lambda text, **_: order.append(str(text)))
    run(["paint", str(tmp_path / "a.scene"), "-o", str(tmp_path / "a.svg")])
    assert len(order) > 1
    assert "warning" in order[0]
    assert order[-1] == "file"
