#!/bin/sh
# Installs what is missing to run vectorplot from this checkout, and nothing when nothing is missing.
#
#   sh setup.sh             system packages, the virtual environment .venv, the package
#   sh setup.sh test        the same with what the tests need; then ruff, mypy and pytest
#   sh setup.sh test ARGS   the same, ARGS go to pytest
#
# PYTHON=/path/to/python3 chooses the interpreter (3.11 or newer).
set -eu

fail() {
    echo "setup.sh: $*" >&2
    exit 1
}

cd -- "$(dirname -- "$0")" || exit 1
here=$(pwd -P)
goal=run
if [ $# -gt 0 ]; then
    [ "$1" = test ] || fail "unknown word '$1'; usage: sh setup.sh [test [pytest arguments]]"
    goal=test
    shift
fi

# The stamp lies inside the environment, so it vanishes with it; it names the checkout's path because
# an environment that was moved does not work.
key="$(cat setup.sh pyproject.toml | cksum) $here"
stamp=.venv/vectorplot-setup

is_installed() {
    [ -x .venv/bin/python ] && [ -x .venv/bin/vectorplot ] && [ -f "$stamp" ] || return 1
    case $(cat "$stamp") in
        "test $key") return 0 ;;
        "run $key") [ "$goal" = run ] ;;
        *) return 1 ;;
    esac
}

is_new_enough() {
    "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null
}

find_python() {
    for candidate in ${PYTHON:+"$PYTHON"} python3 python3.11 python3.12 python3.13 python3.14; do
        if is_new_enough "$candidate"; then
            echo "$candidate"
            return 0
        fi
    done
    return 1
}

# What is missing to install and run the package, as names of Debian packages.
missing() {
    if python=$(find_python); then
        dev=python3
        case $python in python3.*) dev=$python ;; esac
        "$python" -c 'import ensurepip, venv' 2>/dev/null || printf '%s ' "$dev-venv"
        headers=$("$python" -c 'import sysconfig; print(sysconfig.get_path("include"))')
        [ -f "$headers/Python.h" ] || printf '%s ' "$dev-dev"
    else
        printf 'python3 python3-venv python3-dev '
    fi
    command -v cc >/dev/null || command -v gcc >/dev/null || printf 'gcc '
    if ! command -v pkg-config >/dev/null; then
        printf 'pkg-config libcairo2-dev '
    elif ! pkg-config --exists cairo; then
        printf 'libcairo2-dev '
    fi
}

# What the tests open files with and is missing.
missing_readers() {
    [ "$goal" = test ] || return 0
    command -v gs >/dev/null || printf 'ghostscript '
    command -v pdftoppm >/dev/null || printf 'poppler-utils '
    command -v rsvg-convert >/dev/null || printf 'librsvg2-bin '
    command -v chromium-headless-shell >/dev/null || command -v chromium >/dev/null || printf 'chromium-headless-shell '
    command -v pdflatex >/dev/null || printf 'texlive-latex-base texlive-pictures '
}

please_install() {
    if [ "$(uname)" = Darwin ]; then
        # The same things under the names that Homebrew gives them.
        packages=$(echo "$*" | sed -e 's/python3[^ ]*/python@3.12/g' -e 's/libcairo2-dev/cairo/' \
            -e 's/chromium-headless-shell/chromium/' -e 's/poppler-utils/poppler/' -e 's/librsvg2-bin/librsvg/' -e 's/texlive-latex-base texlive-pictures/texlive/' | tr ' ' '\n' | sort -u | tr '\n' ' ')
        fail "please install (brew install ${packages% }) and run this again"
    fi
    fail "please install (as root: apt-get install $*) or their like on your system, and run this again"
}

# How packages are installed: root is what stands before a command. Who cannot install any is told which.
find_installer() {
    command -v apt-get >/dev/null || please_install "$@"
    if [ "$(id -u)" = 0 ]; then
        root=
    elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
        root='sudo -n'
    else
        please_install "$@"
    fi
    # A package list that could not be renewed need not matter, a package that cannot be installed does.
    $root apt-get update >/dev/null 2>&1 || true
}

install_packages() {
    echo "setup.sh: installing $*" >&2
    log=$(mktemp)
    if ! $root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@" >"$log" 2>&1; then
        tail -n 20 "$log" >&2
        rm -f "$log"
        please_install "$@"
    fi
    rm -f "$log"
}

# The lists of packages are one word a package.
# shellcheck disable=SC2086
install_all() {
    if command -v python3 >/dev/null && ! find_python >/dev/null; then
        fail "Python 3.11 or newer is needed, python3 is $(python3 -V 2>&1); set PYTHON=/path/to/another"
    fi
    packages=$(missing)
    readers=$(missing_readers)
    [ -z "$packages$readers" ] || find_installer $packages $readers
    if [ -n "$packages" ]; then
        install_packages $packages
        packages=$(missing)
        [ -z "$packages" ] || please_install $packages
    fi
    python=$(find_python) || fail "Python 3.11 or newer is needed; set PYTHON=/path/to/python3 if it has another name"
    # Readers come while pip works, which needs none; whatever ends this script, they are not left half installed.
    trap wait EXIT
    [ -z "$readers" ] || install_packages $readers &
    installed=$!
    if ! is_new_enough .venv/bin/python || [ ! -f "$stamp" ] || [ "$(sed 's/^[a-z]* [0-9]* [0-9]* //' "$stamp")" != "$here" ]; then
        echo "setup.sh: making the virtual environment .venv" >&2
        "$python" -m venv --clear .venv
    fi
    rm -f "$stamp"
    echo "setup.sh: installing vectorplot and what it needs" >&2
    # For tests nothing is compiled before it is imported: of what they bring, most never is.
    what='.[cairo]'
    now=1
    [ "$goal" = run ] || { what='.[test]'; now=0; }
    PIP_COMPILE=$now .venv/bin/python -m pip install --quiet --disable-pip-version-check -e "$what" ||
        fail "pip could not install the Python packages; is there a way to the package index?"
    # Compiled now, the package starts a tenth of a second sooner, also where Python may not write beside it later.
    .venv/bin/python -m compileall -q -j 0 vectorplot || true
    wait "$installed"
    trap - EXIT
    readers=$(missing_readers)
    [ -z "$readers" ] || please_install $readers
    echo "$goal $key" >"$stamp"
}

is_installed || install_all

if [ "$goal" = test ]; then
    PATH="$here/.venv/bin:$PATH"
    export PATH
    # What pytest makes of the tests' assertions is kept for the next time, and for the next worker.
    unset PYTHONDONTWRITEBYTECODE
    # Arrays come and go by the thousand: where glibc gives memory back late, they come a little faster.
    export MALLOC_TRIM_THRESHOLD_=268435456 MALLOC_MMAP_THRESHOLD_=33554432 MALLOC_TOP_PAD_=16777216
    # All of them run, whatever the others found; pytest has the last line. The types wait for no test: they come beside.
    status=0
    ruff check --quiet . || status=1
    ruff format --check --quiet . || { echo "setup.sh: not formatted; run: .venv/bin/ruff format ." >&2; status=1; }
    found=$(mktemp)
    # With three gigabytes to itself mypy need not look for garbage, which takes it a quarter of its time.
    python -c 'import gc; gc.enable = gc.disable; from mypy.__main__ import console_entry; console_entry()' >"$found" 2>&1 &
    types=$!
    tests=0
    # Files stay whole: their tests share what they look at. The longest ones come first, as tests/conftest.py says.
    python -m pytest --numprocesses auto --dist loadfile --no-loadscope-reorder "$@" || tests=$?
    wait "$types" || { cat "$found" >&2; status=1; }
    rm -f "$found"
    [ "$tests" = 0 ] || status=$tests
    exit "$status"
fi
