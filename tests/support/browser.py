"""The browser in which tests open pages."""

import shutil

CHROMIUM = shutil.which("chromium-headless-shell") or shutil.which("chromium")
"""Without a window it needs a third of the time."""


def launched(playwright):
    """A browser, to be closed."""
    return playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
