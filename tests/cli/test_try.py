"""``vectorplot try`` prints one line with the address, and ends when it is told to."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import urllib.request

from vectorplot.cli.main import run


def test_it_stops_by_a_signal_and_leaves_with_status_0(cube):
    command = [sys.executable, "-m", "vectorplot", "try", str(cube), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            address = process.stdout.readline().strip()
            with urllib.request.urlopen(address, timeout=20) as answer:
                assert b"<title>vectorplot</title>" in answer.read()
            os.kill(process.pid, signal.SIGTERM)
            out, said = process.communicate(timeout=20)
        finally:
            process.kill()
    assert (process.returncode, out, said) == (0, "", "")


def test_it_stops_when_its_time_is_over(cube, capsys):
    assert run(["try", str(cube), "--no-browser", "--timeout", "0.05"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("http://127.0.0.1:") and out.count("\n") == 1


def test_what_is_wrong_is_one_line_before_anything_is_served(cube, capsys, monkeypatch):
    assert run(["try", "no-such-scene", "--no-browser"]) == 1
    cube.write_text("f 1 2 3\n", encoding="utf-8")
    assert run(["try", str(cube), "--no-browser"]) == 1
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    cube.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    assert run(["try", str(cube), "--no-browser"]) == 1
    told = capsys.readouterr()
    assert told.out == ""
    assert len(told.err.splitlines()) == 3 and "pip install 'vectorplot[viewer]'" in told.err
