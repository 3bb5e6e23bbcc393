"""The entry point: runs the command, and turns what went wrong into one line and an exit status."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence

import click

from vectorplot import __version__
from vectorplot.cli.draw import draw
from vectorplot.cli.info import info
from vectorplot.cli.paint import paint
from vectorplot.cli.render import render
from vectorplot.errors import InputError

BAD_INPUT = 1
INTERRUPTED = 130


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="vectorplot", message="%(prog)s %(version)s")
def vectorplot() -> None:
    """3-D scenes as exact line drawings: hidden lines by geometry, never by pixels."""


vectorplot.add_command(draw)
vectorplot.add_command(paint)
vectorplot.add_command(info)
vectorplot.add_command(render)


def main() -> None:
    """What the shell starts."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: Sequence[str]) -> int:
    """The exit status after running the command: 0, 1 for bad input, 2 for bad usage, 130 after Ctrl-C."""
    try:
        with warnings.catch_warnings():
            if not sys.warnoptions:
                warnings.simplefilter("ignore")
            with vectorplot.make_context("vectorplot", list(arguments)) as context:
                vectorplot.invoke(context)
    except click.exceptions.Exit as error:
        return error.exit_code
    except click.exceptions.NoArgsIsHelpError as error:
        error.show()
        return error.exit_code
    except click.UsageError as error:
        error.show()
        return error.exit_code
    except KeyboardInterrupt:
        if sys.stderr.isatty():
            click.echo(err=True)  # the terminal has written ^C
        say("interrupted")
        return INTERRUPTED
    except InputError as error:
        say(str(error))
        return BAD_INPUT
    except BrokenPipeError:
        # The reader has gone; without this the interpreter complains once more when it flushes at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return BAD_INPUT
    except OSError as error:
        name = "" if error.filename is None else f"{os.fsdecode(error.filename)}: "
        say(name + (error.strerror or str(error)))
        return BAD_INPUT
    except MemoryError:
        say("there is not enough memory for this")
        return BAD_INPUT
    return 0


def say(text: str) -> None:
    """Print one line on stderr, whatever the text holds."""
    line = "".join(letter if letter.isprintable() else " " for letter in " ".join(text.split()))
    click.echo(f"vectorplot: {line}", err=True)


if __name__ == "__main__":
    main()
