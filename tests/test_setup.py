"""The set-up script installs what is missing, once, and says in one line what it cannot install."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys

import pytest
from support.paths import ROOT


def set_up(folder, *arguments, path):
    """The set-up script run in a copy of the project's frame, with nothing but the given programs on the path."""
    for name in {"setup.sh", "pyproject.toml"} - {path.name for path in folder.iterdir()}:
        shutil.copy(ROOT / name, folder)
    environment = {"PATH": str(path), "HOME": str(folder)}
    command = [shutil.which("sh"), str(folder / "setup.sh"), *arguments]
    return subprocess.run(command, cwd="/", env=environment, capture_output=True, text=True, timeout=600)


def programs(folder, *names, **scripts):
    """A folder with links to real programs and with small scripts in place of others."""
    place = folder / "programs"
    place.mkdir()
    for name in ("sh", "cat", "cksum", "dirname", "sed", "tr", "sort", "rm", "mktemp", "tail", "env", *names):
        place.joinpath(name).symlink_to(shutil.which(name))
    for name, text in scripts.items():
        path = place / name.replace("_", "-")
        path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        path.chmod(0o755)
    return place


REAL_PYTHON = f'exec "{os.path.realpath(sys.executable)}" "$@"'


@pytest.mark.slow
@pytest.mark.parametrize(
    ("system", "word"),
    [("Linux", "apt-get install .*libcairo2-dev"), ("Darwin", "brew install .*cairo")],
)
def test_without_a_way_to_install_the_script_says_what_is_missing(tmp_path, system, word):
    folder = tmp_path / "a folder"
    folder.mkdir()
    path = programs(tmp_path, uname=f"echo {system}", id="echo 1000", cc="", python3=REAL_PYTHON)
    result = set_up(folder, path=path)
    assert result.returncode == 1
    assert result.stderr.count("\n") == 1
    assert re.search(word, result.stderr), result.stderr
    assert not (folder / ".venv").exists()


def test_an_old_python_is_named(tmp_path):
    old = 'case $1 in -V) echo "Python 3.9.2" ;; *) exit 1 ;; esac'
    result = set_up(tmp_path, path=programs(tmp_path, python3=old))
    assert result.returncode == 1
    assert result.stderr == (
        "setup.sh: Python 3.11 or newer is needed, python3 is Python 3.9.2; set PYTHON=/path/to/another\n"
    )


def test_an_unknown_word_is_refused(tmp_path):
    result = set_up(tmp_path, "tset", path=programs(tmp_path))
    assert result.returncode == 1
    assert "unknown word 'tset'" in result.stderr


def test_the_second_time_nothing_is_installed(tmp_path):
    """With a stamp that fits, no installer, no interpreter and no network is called."""
    folder = tmp_path / "with blanks in it"
    folder.mkdir()
    real = programs(
        tmp_path,
        "mkdir",
        "chmod",
        id="echo 0",
        cc="",
        gs="",
        pdftoppm="",
        rsvg_convert="",
        chromium_headless_shell="",
        pdflatex="",
        pkg_config="exit 0",
        python3="case $* in *-m\\ venv*) mkdir -p .venv/bin; for name in python vectorplot; do "
        'printf "#!/bin/sh\\necho pip \\"\\$@\\" >>calls\\n" >.venv/bin/$name; chmod +x .venv/bin/$name; done ;;'
        " *sysconfig*) echo . ;; esac",
    )
    (folder / "Python.h").touch()
    first = set_up(folder, path=real)
    assert first.returncode == 0, first.stderr
    calls = (folder / "calls").read_text(encoding="utf-8")
    assert calls.count("install") == 1
    second = set_up(folder, path=real)
    assert (second.returncode, second.stdout, second.stderr) == (0, "", "")
    assert (folder / "calls").read_text(encoding="utf-8") == calls
    with (folder / "pyproject.toml").open("a", encoding="utf-8") as file:
        file.write("\n# changed\n")
    assert set_up(folder, path=real).returncode == 0
    assert (folder / "calls").read_text(encoding="utf-8").count("install") == 2
    assert set_up(folder, "test", path=real).returncode != 0  # the stub installs no ruff, but it is asked to
    assert ".[test]" in (folder / "calls").read_text(encoding="utf-8")


def test_what_is_missing_is_installed_by_apt_with_the_right_names(tmp_path):
    """The stand-in of apt-get brings the programs; what pip does comes after those that it needs, beside the others."""
    path = programs(
        tmp_path,
        "mkdir",
        "chmod",
        "touch",
        id="echo 0",
        python3="case $* in *-m\\ venv*) exit 7 ;; *ensurepip*) [ -f venv ] ;; *sysconfig*) echo . ;; esac",
        apt_get=f'echo "$@" >>"{tmp_path}/calls"; case $1 in install) touch venv Python.h; '
        "for name in cc gs pdftoppm rsvg-convert chromium-headless-shell pdflatex pkg-config; do "
        f'printf "#!/bin/sh\n" >"{tmp_path}/programs/$name"; '
        f'chmod +x "{tmp_path}/programs/$name"; done ;; esac',
    )
    result = set_up(tmp_path, "test", path=path)
    assert result.returncode != 0  # the stand-in of Python makes no environment
    assert (tmp_path / "calls").read_text(encoding="utf-8").splitlines() == [
        "update",
        "install -y --no-install-recommends python3-venv python3-dev gcc pkg-config libcairo2-dev",
        "install -y --no-install-recommends "
        "ghostscript poppler-utils librsvg2-bin chromium-headless-shell texlive-latex-base texlive-pictures",
    ]


@pytest.mark.slow
@pytest.mark.parametrize("pip", ["exit 0", "exit 1"])
def test_a_reader_that_cannot_be_installed_is_named_and_nothing_counts_as_installed(tmp_path, pip):
    """Whatever pip does meanwhile, the script ends after apt-get, which is not left at work."""
    path = programs(
        tmp_path,
        "mkdir",
        "chmod",
        "sleep",
        "touch",
        id="echo 0",
        uname="echo Linux",
        cc="",
        gs="",
        rsvg_convert="",
        chromium_headless_shell="",
        pdflatex="",
        pkg_config="exit 0",
        apt_get=f'case $1 in install) sleep 0.3; touch "{tmp_path}/done"; exit 100 ;; esac',
        python3="case $* in *-m\\ venv*) mkdir -p .venv/bin; for name in python vectorplot; do "
        f'printf "#!/bin/sh\n{pip}\n" >.venv/bin/$name; chmod +x .venv/bin/$name; done ;;'
        " *sysconfig*) echo . ;; esac",
    )
    (tmp_path / "Python.h").touch()
    result = set_up(tmp_path, "test", path=path)
    assert result.returncode == 1
    assert "apt-get install poppler-utils)" in result.stderr
    assert (tmp_path / "done").exists()
    assert not (tmp_path / ".venv" / "vectorplot-setup").exists()
