"""What stands left never imports what stands right, and nothing heavy loads before it is called."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import pytest
from support.pace import slowness
from support.sources import statements_of, tree_of

import vectorplot
from vectorplot.cli.verbs import COMMANDS
from vectorplot.save import _BACKENDS

PACKAGE = Path(vectorplot.__file__).parent

ORDER = [
    *("errors", "words", "arrays", "tolerances"),
    *("geometry", "curves", "surfaces", "features", "scene", "io", "visibility", "shading"),
    *("drawing", "effects", "animation", "textbook", "backends", "pictures"),
    *("testing", "accuracy", "speed", "viewer", "cli"),
]
WITH_PICTURES = {"read", "save", "save_frames", "batch"}
"""What reads, saves and makes many of them stands with the verbs."""

# Pictures show themselves in a notebook and save themselves; the import happens when they are asked to.
ALLOWED = {("drawing/drawing.py", "backends"), ("drawing/drawing.py", "pictures"), ("shading/image.py", "pictures")}

FOR_PROGRAMS = {
    "surfaces/algebraic.py",
}
"""Files that programs of one's own call for, and no verb."""


HEAVY = {
    "cairo",
    "ezdxf",
    "scipy",
    "shapely",
    "svgwrite",
    "trimesh",
    "click",
    "distributed",
    "tqdm",
    "HersheyFonts",
    "embreex",
    "skimage",
}

FILES = sorted(path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py"))


def room(parts: tuple[str, ...]) -> str:
    name = parts[0].removesuffix(".py")
    return "pictures" if name in WITH_PICTURES else "cli" if name == "__main__" else name


def imported_modules(tree: ast.Module, package: tuple[str, ...]) -> set[tuple[str, ...]]:
    """The modules of vectorplot a file imports, at the top or inside a function."""
    found: set[tuple[str, ...]] = set()
    for node in statements_of(tree):
        if isinstance(node, ast.Import):
            found |= {tuple(alias.name.split(".")) for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            base += tuple((node.module or "").split(".")) if node.module else ()
            found |= {(*base, alias.name) for alias in node.names}
    return {module[1:] for module in found if module[0] == "vectorplot" and len(module) > 1}


def wrong_imports(file: str) -> list[str]:
    """What a file imports from where it must not."""
    path = Path(file)
    home = room(path.parts)
    if home not in ORDER:
        return [f"{file}: {home} has no place in the import order"]
    wrong = []
    for module in imported_modules(tree_of(PACKAGE / path), ("vectorplot", *path.parts[:-1])):
        target = room(module)
        if target not in ORDER:  # a name of the package itself, such as __version__
            if (PACKAGE / target).exists() or (PACKAGE / f"{target}.py").exists():
                wrong.append(f"{file} imports {target}, which has no place in the import order")
        elif ORDER.index(target) > ORDER.index(home) and (file, target) not in ALLOWED:
            wrong.append(f"{file} imports {'.'.join(module)}, which stands right of it")
    return wrong


@pytest.mark.slow
def test_rooms_import_only_what_stands_left_of_them():
    """One test for all files: pytest takes longer to hold a test than this takes for a file."""
    files = [file for file in FILES if file != "__init__.py"]
    assert len(files) > 100
    assert not [line for file in files for line in wrong_imports(file)]


@cache
def modules_imported_by(file: str) -> set[str]:
    """The files of the package that a file imports anywhere, for types alone too; names are taken for their module."""
    path = Path(file)
    tree = tree_of(PACKAGE / path)
    found = set()
    for module in imported_modules(tree, ("vectorplot", *path.parts[:-1])):
        for parts in (module, module[:-1]):
            candidates = ["/".join(parts) + ".py", "/".join((*parts, "__init__.py"))]
            hit = next((name for name in candidates if name in FILES), None)
            if parts and hit:
                found.add(hit)
                break
    return found - {file}


@pytest.mark.slow
def test_no_files_import_each_other_in_a_circle():
    """Not even inside functions, and not for types alone; but for a drawing that shows itself."""
    hooks = {home for home, _ in ALLOWED}
    waiting = {file: set() if file in hooks else modules_imported_by(file) for file in FILES}
    while free := [file for file, needs in waiting.items() if not needs & waiting.keys()]:
        for file in free:
            del waiting[file]
    assert not waiting, f"in circles, or behind one: {sorted(waiting)}"


def exported(stub: Path) -> set[str]:
    """The files that a room's stub takes names from."""
    tree = tree_of(stub)
    room = stub.parent.relative_to(PACKAGE)
    imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    modules = {node.module or alias.name for node in imports for alias in node.names}
    return {(room / (module.replace(".", "/") + ".py")).as_posix() for module in modules}


# Backends are found by the suffix of a file's name, commands by theirs, the plugin by its entry point.
STARTS = {
    "__main__.py",
    "cli/vpype_plugin.py",
    *(f"backends/{module}.py" for module, _ in _BACKENDS.values()),
    *(f"cli/commands/{module}.py" for module in COMMANDS.values()),
}


def unreached_from(stubs: Iterable[Path]) -> set[str]:
    """The files that neither the command nor what the stubs export needs."""
    waiting = STARTS.union(*(exported(stub) for stub in stubs))
    reached: set[str] = set()
    while waiting:
        reached |= waiting
        waiting = set().union(*(modules_imported_by(file) for file in waiting)) - reached
    return {file for file in FILES if not file.endswith("__init__.py")} - reached


@pytest.mark.slow
def test_every_file_serves_the_command_or_what_a_room_exports():
    """What nobody can reach is not finished, or forgotten."""
    assert unreached_from(PACKAGE.rglob("*.pyi")) == set()


def test_what_verbs_and_command_do_not_reach_is_few_and_known():
    """A file that only a room's exports hold has a place in the textbook, or is for programs of one's own."""
    left = unreached_from((PACKAGE / "__init__.pyi", PACKAGE / "testing" / "__init__.pyi"))
    assert {file for file in left if not file.startswith("textbook/")} == FOR_PROGRAMS


@pytest.mark.slow
def test_no_file_takes_what_another_keeps_to_itself():
    """Names with an underscore in front are a file's own."""
    taken = []
    for file in FILES:
        for node in statements_of(tree_of(PACKAGE / file)):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("vectorplot"):
                taken += [
                    f"{file}: {alias.name}"
                    for alias in node.names
                    if alias.name.startswith("_") and alias.name != "__version__"
                ]
    assert not taken


def heavy_imports(file: str) -> list[str]:
    """The heavy packages that a file imports at the top."""
    found = []
    for node in tree_of(PACKAGE / file).body:
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        if {name.split(".")[0] for name in names} & HEAVY:
            found.append(f"{file}:{node.lineno} imports {names} at the top")
    return found


def test_heavy_packages_are_imported_inside_functions():
    files = [file for file in FILES if not file.startswith(("backends/", "cli/"))]
    assert len(files) > 100
    assert not [line for file in files for line in heavy_imports(file)]


def loaded_after(statement: str) -> set[str]:
    script = f"import sys\n{statement}\nprint(*(name.split('.')[0] for name in sys.modules))"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(result.stdout.split())


def test_import_of_the_package_loads_nothing_heavy():
    assert not loaded_after("import vectorplot") & (HEAVY | {"numpy"})


@pytest.mark.slow
def test_the_types_load_numpy_and_nothing_heavier():
    loaded = loaded_after("import vectorplot as vp\nvp.Scene, vp.Camera, vp.Mesh, vp.Drawing, vp.InputError")
    assert "numpy" in loaded
    assert not loaded & HEAVY


def test_import_of_the_package_takes_less_than_a_tenth_of_a_second():
    script = "import time; t = time.process_time(); import vectorplot; print(time.process_time() - t)"
    run = [sys.executable, "-c", script]
    times = [float(subprocess.run(run, capture_output=True, text=True, check=True).stdout) for _ in range(3)]
    assert min(times) < 0.1 * slowness()
