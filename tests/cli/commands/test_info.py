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
    assert last.startswith("1 item, 8 vertices, 12 edges, 6 faces, 1 light, ")


def test_info_tells_which_surfaces_there_are_and_what_is_drawn_on_them(tmp_path, capsys):
    scene = tmp_path / "smooth.scene"
    scene.write_text(
        "RING surface torus 3 1 parameter_lines 24 12 isophotes 9 sections x 3\n"
        'BLOB surface implicit "x^2 + y^2 + z^2 - 1" box -2 2 -2 2 -2 2\nSHEET surface quadric 1 0 0 0 0 0 0 0 1 0\n'
        "box -1 1 -1 1 -1 1 CUBE box 1 1 1\n",
        encoding="utf-8",
    )
    assert run(["info", str(scene)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "RING: surface (torus), closed in u and v, 24 + 12 parameter lines, 9 isophotes, 3 sections, "
        "size 8 x 8 x 2, from -4,-4,-1 to 4,4,1",
        "BLOB: implicit surface, box of size 4 x 4 x 4, from -2,-2,-2 to 2,2,2",
        "SHEET: implicit surface (quadric), box of size 2 x 2 x 2, from -1,-1,-1 to 1,1,1",
        "CUBE: 8 vertices, 12 edges, 6 faces, closed, convex, size 1 x 1 x 1, from 0,0,0 to 1,1,1",
        "4 items, 3 surfaces, 8 vertices, 12 edges, 6 faces, 0 lights, size 8 x 8 x 4, from -4,-4,-2 to 4,4,2",
    ]
