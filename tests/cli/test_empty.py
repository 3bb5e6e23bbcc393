"""A picture with nothing on it is said to be empty."""

from click.testing import CliRunner

from vectorplot.cli.verbs import vectorplot


def test_an_empty_picture_is_said(tmp_path):
    (tmp_path / "none.scene").write_text("# nothing stands here\n")
    command = ["draw", str(tmp_path / "none.scene"), "-o", str(tmp_path / "none.svg")]
    result = CliRunner().invoke(vectorplot, command)
    assert result.exit_code == 0
    assert result.stderr.count("\n") == 1 and "the picture is empty" in result.stderr
    assert (tmp_path / "none.svg").exists()
    assert CliRunner().invoke(vectorplot, [*command, "--quiet"]).stderr == ""
