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
from vectorplot.errors import InputError, printable
from vectorplot.words import nearest

BAD_INPUT = 1
INTERRUPTED = 130


class Verbs(click.Group):
    """The commands; an unknown one is told with the nearest that is known."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that is named. Errors: UsageError for an unknown one."""
        if args and self.get_command(ctx, args[0]) is None and not args[0].startswith("-"):
            near = nearest(args[0].lower(), self.commands)
            ctx.fail(f"No such command {args[0]!r}." + (f" Did you mean {near!r}?" if near else ""))
        return super().resolve_command(ctx, args)


@click.group(cls=Verbs, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
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
    except click.NoSuchOption as error:
        say_usage(error, f"No such option {error.option_name!r}.{meant_option(error)}")
        return error.exit_code
    except click.UsageError as error:
        say_usage(error, error.format_message())
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


def meant_option(error: click.NoSuchOption) -> str:
    """A hint at the option of the command that an unknown one may have meant, or nothing."""
    if error.ctx is None:
        return ""
    known = [name for option in error.ctx.command.get_params(error.ctx) for name in option.opts if name[:2] == "--"]
    near = nearest(error.option_name.lstrip("-").lower(), (name[2:] for name in known))
    return f" Did you mean '--{near}'?" if near else ""


def say_usage(error: click.UsageError, cause: str) -> None:
    """Print how the command is used, and on one line what was wrong."""
    if error.ctx is not None:
        click.echo(f"{error.ctx.get_usage()}\nTry '{error.ctx.command_path} --help' for help.\n", err=True)
    click.echo(f"Error: {printable(cause)}", err=True)


def say(text: str) -> None:
    """Print one line on stderr, whatever the text holds."""
    click.echo(f"vectorplot: {printable(text)}", err=True)


if __name__ == "__main__":
    main()
