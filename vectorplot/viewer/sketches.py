"""Sketches: Python files of users with a function of parameters, run again and again by processes of their own."""

from __future__ import annotations

import base64
import inspect
import json
import os
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal, get_args, get_origin, get_type_hints

from vectorplot.errors import InputError

# What runs in the process of a sketch: its function, with the values that the page has, and what comes of it.

FUNCTION = "sketch"
"""What the function of a sketch is called."""

MOST_TOLD = 4000
"""So many characters at the end of what a sketch prints, or of its error, are shown."""


@dataclass(frozen=True)
class Parameter:
    """A parameter of a sketch: its kind (float, int, bool, text or choice), its value, the range of numbers, and the
    choices."""

    name: str
    kind: str
    value: Any
    low: float = 0.0
    high: float = 1.0
    choices: tuple[str, ...] = ()


def parameters(function: Callable[..., Any]) -> list[Parameter]:
    """Those of a function, by its annotations and its defaults. Errors: InputError for one that says too little."""
    try:
        hints = get_type_hints(function, include_extras=True)
    except NameError as error:
        raise InputError(f"{FUNCTION}: {error}") from None
    found = []
    for name, told in inspect.signature(function).parameters.items():
        if told.default is inspect.Parameter.empty:
            raise InputError(f"{FUNCTION}: {name} has no default, such as {name}=1.0")
        found.append(_parameter(name, hints.get(name, type(told.default)), told.default))
    return found


def _parameter(name: str, hint: Any, value: Any) -> Parameter:
    """A parameter with its annotation: float, int, bool, str, Literal["a", "b"] or Annotated[float, low, high]."""
    limits = [one for one in getattr(hint, "__metadata__", ()) if isinstance(one, int | float)]
    kind = getattr(hint, "__origin__", hint) if limits or hasattr(hint, "__metadata__") else hint
    if get_origin(kind) is Literal:
        return Parameter(name, "choice", str(value), choices=tuple(map(str, get_args(kind))))
    if kind is bool:
        return Parameter(name, "bool", bool(value))
    if kind in (int, float):
        low, high = limits if len(limits) == 2 else sorted((0.0, 2.0 * value)) if value else (0.0, 10.0)
        return Parameter(name, kind.__name__, kind(value), float(min(low, value)), float(max(high, value)))
    if kind is str:
        return Parameter(name, "text", str(value))
    raise InputError(
        f"{FUNCTION}: {name} is of no type that the page has a control for: float, int, bool, str, Literal"
    )


def _given(told: Parameter, values: Mapping[str, Any]) -> Any:
    """The value that the page has for a parameter, or its default where that does not fit it."""
    value = values.get(told.name, told.value)
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if told.kind == "float":
        return float(value) if number else told.value
    if told.kind == "int":
        return int(value) if number else told.value
    if told.kind == "bool":
        return value if isinstance(value, bool) else told.value
    fits = isinstance(value, str) and (told.kind == "text" or value in told.choices)
    return value if fits else told.value


def made_by(path: Path, values: Mapping[str, Any]) -> dict[str, Any]:
    """The picture that a sketch makes of values, and its parameters. Errors: whatever the sketch raises."""
    from importlib.util import module_from_spec, spec_from_file_location

    spec = spec_from_file_location("sketch", path)
    if spec is None or spec.loader is None:
        raise InputError("is no Python file", file=str(path))
    module = module_from_spec(spec)
    sys.modules["sketch"] = module
    sys.path.insert(0, str(path.parent))
    spec.loader.exec_module(module)
    function = getattr(module, FUNCTION, None)
    if not callable(function):
        raise InputError(f"has no function {FUNCTION}", file=str(path))
    known = parameters(function)
    made = function(**{one.name: _given(one, values) for one in known})
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.pictures.draw import draw
    from vectorplot.shading.image import Image
    from vectorplot.viewer.pictures import for_browser

    content, kind = for_browser(made if isinstance(made, Drawing | Image) else draw(made))
    return {
        "parameters": [asdict(one) for one in known],
        "picture": base64.b64encode(content).decode("ascii"),
        "kind": kind,
    }


def main() -> None:
    """Run the sketch of the command line with the values on standard input, and write what comes of it, as JSON, to a
    file; what it prints goes to the error channel."""
    path, out = Path(sys.argv[1]), Path(sys.argv[2])
    sys.dont_write_bytecode = True
    values = json.load(sys.stdin)
    os.dup2(2, 1)
    try:
        answer = made_by(path, values)
    except InputError as error:
        answer = {"error": str(error)}
    except BaseException as error:
        # Of the frames those of the sketch count, from the first that is in its file.
        frames = traceback.extract_tb(error.__traceback__)
        first = next((k for k, frame in enumerate(frames) if Path(frame.filename) == path), len(frames))
        lines = traceback.format_list(frames[first:]) + traceback.format_exception_only(error)
        answer = {"error": "".join(lines)[-MOST_TOLD:]}
    out.write_text(json.dumps(answer), encoding="utf-8")


# What the program asks of it.

LOOK_S = 0.05
"""So often it is asked whether a sketch is done, and whether anybody waits for it."""


@dataclass(frozen=True)
class Sketch:
    """A Python file with a function ``sketch`` of parameters with defaults, which gives a drawing, a picture, or what
    has a shape; timeout_s: how long it may take each time."""

    path: Path
    timeout_s: float = 30.0

    def by_name(self, name: str) -> Callable[[Mapping[str, Any], Any], Any] | None:
        """The answer to a question; None where there is no such question."""
        known: dict[str, Callable[[Mapping[str, Any], Any], Any]] = {"sketch": self.drawn, "changed": self.changed}
        return known.get(name)

    def changed(self, asked: Mapping[str, Any], job: Any) -> dict[str, Any]:
        """When the file was changed last."""
        return {"stamp": self._stamp()}

    def drawn(self, asked: Mapping[str, Any], job: Any) -> dict[str, Any]:
        """What the sketch draws with the values that the page has, or its error; what it prints. A process that nobody
        waits for any more ends."""
        values = asked.get("values")
        told = json.dumps(values if isinstance(values, Mapping) else {})
        stamp = self._stamp()
        with tempfile.TemporaryDirectory() as desk:
            out = Path(desk, "answer.json")
            words = [sys.executable, "-m", "vectorplot.viewer.sketches", str(self.path.resolve()), str(out)]
            with open(Path(desk, "printed"), "wb+") as printed:
                running = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=printed, stderr=printed)
                try:
                    found = self._waited(running, told, job)
                finally:
                    running.kill()
                    running.wait()
                printed.seek(0)
                lines = printed.read().decode(errors="replace")[-MOST_TOLD:]
            if found and not out.is_file():
                return {"stamp": stamp, "printed": lines, "error": f"the sketch ended with status {running.returncode}"}
            answer = json.loads(out.read_text(encoding="utf-8")) if found else self._stopped()
        return {**answer, "stamp": stamp, "printed": lines}

    def _waited(self, running: subprocess.Popen[bytes], told: str, job: Any) -> bool:
        """Whether the process ended within its time. Errors: SupersededError where nobody waits for it."""
        given: bytes | None = told.encode()
        for _ in range(max(1, int(self.timeout_s / LOOK_S))):
            try:
                running.communicate(given, timeout=LOOK_S)
                return True
            except subprocess.TimeoutExpired:
                given = None
                job.go_on()
        return False

    def _stopped(self) -> dict[str, Any]:
        return {"error": f"stopped after {self.timeout_s:g} seconds (--sketch-timeout)"}

    def _stamp(self) -> str:
        return str(self.path.stat().st_mtime_ns)


if __name__ == "__main__":
    main()
