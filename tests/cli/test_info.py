from vectorplot.cli.main import run


def test_info_says_counts_closedness_convexity_and_size(cube, capsys):
    assert run(["info", str(cube)]) == 0
    captured = capsys.readouterr()
    for words in ("8 vertices", "12 edges", "6 faces", "closed", "convex", "size 1 x 1 x 1"):
        assert words in captured.out
    assert captured.err == ""


def test_info_of_an_open_mesh_says_so_and_warns_of_what_was_mended(cube, capsys):
    lines = cube.read_text(encoding="utf-8").splitlines()
    cube.write_text("\n".join([*lines[:-1], "f 1 1 2", ""]), encoding="utf-8")
    assert run(["info", str(cube)]) == 0
    captured = capsys.readouterr()
    assert "open (4 boundary edges)" in captured.out
    assert captured.err.startswith("vectorplot: warning: ") and captured.err.count("\n") == 1
    assert run(["info", "--quiet", str(cube)]) == 0
    assert capsys.readouterr().err == ""


def test_info_of_a_bad_file_is_one_line(cube, capsys):
    cube.write_text("v 1 2\n", encoding="utf-8")
    assert run(["info", str(cube)]) == 1
    captured = capsys.readouterr()
    assert captured.out == "" and captured.err.count("\n") == 1


def test_info_counts_the_faces_that_were_taken_away(tmp_path, capsys):
    scene = tmp_path / "tray.scene"
    scene.write_text("TRAY gray box hollow 3 3 1 +bottom\nlight SUN direction 0 0 1\n", encoding="utf-8")
    assert run(["info", str(scene)]) == 0
    first, last = capsys.readouterr().out.splitlines()
    assert "6 faces (1 of them removed), closed" in first
    assert last.startswith("1 item, 6 faces, 1 light, ")
