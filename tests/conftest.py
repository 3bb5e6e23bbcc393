"""Settings all tests share."""

import gc
import os
import signal
from collections.abc import Generator

# Before numpy comes: the workers have a core each, and threads that wait for work would take it from the other one.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import settings
from support.effort import register_profiles, rows_to_try

register_profiles()
# --hypothesis-profile=long loads the other one after this.
settings.load_profile("ci")

# Nothing that is imported and collected is garbage: looking for some meanwhile takes a tenth of the time.
gc.disable()

# Who runs the tests in the background, or under nohup, hands on signals that are ignored; the command would keep them
# so, and tests of what stops it would wait for ever.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP"):
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


LONGEST = {"test_examples.py", "test_site.py", "test_smooth_surfaces.py", "test_docs.py", "test_surfaces_that_end.py"}
"""Files that take longest: begun first, none of them is waited for by the other workers at the end."""


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Every other worker begins with the last file: what pytest makes of a file's assertions takes as long as many
    tests, and is kept for who comes next, so that in a fresh checkout two workers do half of it each."""
    report = yield
    if isinstance(collector, pytest.Directory) and int(os.environ.get("PYTEST_XDIST_WORKER", "gw0")[2:]) % 2:
        report.result.reverse()
    return report


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Of tables a few rows, as the profile says; a row that is named runs, here or with -k."""
    if not (config.option.keyword or any("[" in argument for argument in config.args)):
        kept = rows_to_try(items)
        config.hook.pytest_deselected(items=list(set(items).difference(kept)))
        items[:] = kept
    items.sort(key=lambda item: (item.path.name not in LONGEST, item.path.parts))


def pytest_collection_finish() -> None:
    """What was imported and collected stays until the end: garbage is no longer looked for in it, and in what comes
    later less often than programs need it that run for days."""
    gc.collect()
    gc.freeze()
    gc.enable()
    gc.set_threshold(50_000, 20, 20)
