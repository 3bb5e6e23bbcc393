"""What an example needs is one import deep: every room exports its public names, lazily and with their types."""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
from functools import cache

import pytest
from support.paths import DATA, DOCS, EXAMPLES, PACKAGE, ROOT

import vectorplot as vp
from vectorplot.geometry import box

CUBE = box((1, 1, 1))
STUBS = sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.pyi"))
ROOMS = {path.parent.as_posix() for path in STUBS} - {"."}
PAGES = [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]


def room_of(stub):
    return ".".join(("vectorplot", *stub.parts[:-1]))


def stub_exports(stub):
    """(module, name) of every name that a stub takes from its room."""
    tree = ast.parse((PACKAGE / stub).read_text(encoding="utf-8"))
    imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    return [(node.module, alias.name) for node in imports for alias in node.names]


def imports_of_users():
    """(file, module, name) of what examples and pages import from the package."""
    sources = [(path, path.read_text(encoding="utf-8")) for path in sorted(EXAMPLES.glob("*.py"))]
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        sources += [(page, block) for block in re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)]
    for path, source in sources:
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "vectorplot":
                yield from ((path.name, node.module, alias.name) for alias in node.names)
            elif isinstance(node, ast.Import):
                yield from ((path.name, alias.name, "") for alias in node.names if alias.name.startswith("vectorplot."))


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("Sphere", "vectorplot has no 'Sphere': from vectorplot.surfaces import Sphere"),
        ("box", "vectorplot has no 'box': from vectorplot.geometry import box"),
        ("implicit", "vectorplot has no 'implicit'"),
    ],
)
def test_a_name_of_a_room_is_told_where_it_is(name, told):
    with pytest.raises(AttributeError) as error:
        getattr(vp, name)
    assert str(error.value) == told


@pytest.mark.parametrize(
    ("make", "kind", "told"),
    [
        (lambda: vp.Scene(vp.Item("cube", CUBE)), TypeError, r"made of Items, .* not of a Item$"),
        (lambda: vp.Scene((CUBE,)), TypeError, r"made of Items, .* not of a Mesh$"),
        (lambda: vp.exploded([CUBE]), TypeError, r"exploded takes a Scene, .* not list$"),
        (
            lambda: vp.Camera("iso"),
            vp.InputError,
            r"eye must be three numbers; .* vp.Camera.view\('iso'\)$",
        ),
        (lambda: vp.Page("A4"), vp.InputError, r"^page 'A4', 297.0: expected width and height in mm; .* page='A4'$"),
        (lambda: vp.technical_sheet(CUBE, scale=0.5), vp.InputError, r"^scale 0.5: expected two numbers such as 1:2$"),
    ],
)
def test_what_first_scripts_get_wrong_is_told_in_one_sentence(make, kind, told):
    with pytest.raises(kind, match=told):
        make()


def test_whatever_has_a_shape_is_cut():
    assert [item.name for item in vp.cut([CUBE, vp.Item("lid", CUBE)], "y = 0.5", items=["lid"]).items] == [
        "mesh",
        "lid",
    ]


@pytest.mark.parametrize("stub", STUBS, ids=str)
def test_every_name_of_a_stub_is_what_its_module_calls_so(stub):
    room = importlib.import_module(room_of(stub))
    exports = stub_exports(stub)
    names = [name for _, name in exports]
    assert room.__all__ == sorted(set(names)) and len(set(names)) == len(names)
    for module, name in exports:
        if module is None:
            assert getattr(room, name) is importlib.import_module(f"{room.__name__}.{name}")
        else:
            assert getattr(room, name) is getattr(importlib.import_module(f"{room.__name__}.{module}"), name)
    declared = ast.parse((PACKAGE / stub).read_text(encoding="utf-8")).body[-1]
    assert isinstance(declared, ast.Assign) and sorted(ast.literal_eval(declared.value)) == room.__all__


@pytest.mark.parametrize("room", sorted(ROOMS))
def test_no_name_of_a_room_is_also_a_file_or_a_folder_there(room):
    """``vectorplot.geometry.box`` must not mean a module once somebody has imported it."""
    for module, name in stub_exports(next(stub for stub in STUBS if stub.parent.as_posix() == room)):
        folder = PACKAGE / room / name
        assert module is None or not (folder.is_dir() or folder.with_suffix(".py").exists()), f"{room}: {name}"


def test_every_room_with_stages_of_the_walk_has_a_front_door():
    folders = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    # Command and speed are for the shell; verbs, animations, and save, which calls backends, are names of vp.
    assert folders - ROOMS == {"animation", "pictures", "cli", "speed", "backends"}


@pytest.mark.slow
def test_examples_and_pages_import_no_deeper_than_a_room():
    found = list(imports_of_users())
    assert len(found) > 200
    for file, module, name in found:
        assert module == "vectorplot" or module.removeprefix("vectorplot.") in ROOMS, f"{file}: from {module}"
        assert name in importlib.import_module(module).__all__, f"{file}: {module} does not export {name}"


@cache
def declared(module):
    """The names that a type checker finds in a room or a module, by its stub or by what stands at its top level."""
    path = PACKAGE.joinpath(*module.split(".")[1:])
    if (path / "__init__.pyi").is_file():
        # mypy checks the stubs; that __all__ is what they import is a test above.
        return set(ast.literal_eval(ast.parse((path / "__init__.pyi").read_text(encoding="utf-8")).body[-1].value))
    tree = ast.parse(path.with_suffix(".py").read_text(encoding="utf-8"))
    return {node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}


@pytest.mark.slow
def test_type_checkers_know_what_examples_import():
    taken = {(module, name) for _, module, name in imports_of_users() if name}
    assert not [(module, name) for module, name in sorted(taken) if name not in declared(module)]


def loaded_after(statement):
    script = f"import sys\n{statement}\nprint(*sys.modules)"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(result.stdout.split())


@cache
def loaded_by_rooms():
    """By each room the modules of the package, and numpy where it came. The package is loaded anew for each."""
    script = f"import sys\nfor room in {sorted(ROOMS)}:\n"
    script += "    before = [name for name in sys.modules if name.startswith('vectorplot')]\n"
    script += "    for name in before: del sys.modules[name]\n"
    script += "    __import__(f'vectorplot.{room}')\n"
    script += "    print(room, *(name for name in sys.modules if name.startswith(('vectorplot', 'numpy'))))\n"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return {room: set(loaded) for room, *loaded in map(str.split, result.stdout.splitlines())}


@pytest.mark.parametrize("room", sorted(ROOMS))
def test_a_room_loads_nothing_before_a_name_is_used(room):
    assert loaded_by_rooms()[room] == {"vectorplot", f"vectorplot.{room}"}


@pytest.mark.slow
def test_a_name_of_a_room_loads_its_own_modules_only():
    loaded = loaded_after("from vectorplot.surfaces import Torus")
    assert "vectorplot.surfaces.tori" in loaded
    assert not {"scipy", "cairo", "shapely", "vectorplot.surfaces.minimal"} & loaded


def test_drawing_the_pencil_loads_few_modules_of_ours(tmp_path):
    source, picture = str(DATA / "pencil.scene"), str(tmp_path / "pencil.svg")
    drawn = f"import vectorplot as vp; vp.save(vp.draw(vp.read({source!r})), {picture!r})"
    assert sum(name.startswith("vectorplot") for name in loaded_after(drawn)) <= 120


def test_what_no_room_exports_is_an_attribute_error():
    with pytest.raises(AttributeError, match="rubber"):
        _ = vp.rubber
    with pytest.raises(ImportError, match="rubber"):
        exec("from vectorplot.surfaces import rubber")


VERBS = ["draw", "paint", "read", "render", "save"]
HOMES = {verb: f"vectorplot.pictures.{verb}" for verb in ("draw", "paint", "render")}


def home(verb):
    """The module of a verb."""
    return HOMES.get(verb, f"vectorplot.{verb}")


@cache
def verbs_that_stay():
    """Those that the package gives after their modules were imported; and after they were taken from their modules.
    For the latter package and module are loaded anew for each verb, all others once."""
    script = "import sys\nimport vectorplot as vp\n" + "".join(f"import {home(verb)}\n" for verb in VERBS)
    script += f"import vectorplot.cli.main\nprint(*(verb for verb in {VERBS} if callable(getattr(vp, verb))))\n"
    script += f"for verb, home in {[(verb, home(verb)) for verb in VERBS]}:\n"
    script += "    for name in ('vectorplot', home): sys.modules.pop(name, None)\n"
    script += "    exec(f'from {home} import {verb} as taken; import vectorplot as vp')\n"
    script += "    if getattr(vp, verb) is taken: print(verb, end=' ')\n"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    imported, taken = result.stdout.splitlines()
    return imported.split(), taken.split()


@pytest.mark.slow
def test_verbs_stay_verbs_when_their_modules_were_imported_first():
    assert verbs_that_stay()[0] == VERBS


@pytest.mark.slow
@pytest.mark.parametrize("verb", VERBS)
def test_a_verb_stays_a_verb_when_it_was_taken_from_its_module(verb):
    assert verb in verbs_that_stay()[1]


@pytest.mark.slow
def test_all_may_be_loaded_at_once():
    """As programs are built that cannot wait: the environment asks lazy_loader to load every name at import."""
    script = "import os; os.environ['EAGER_IMPORT'] = '1'\n"
    script += "\n".join(f"import vectorplot.{room.replace('/', '.')}" for room in sorted(ROOMS))
    subprocess.run([sys.executable, "-c", script], check=True)
