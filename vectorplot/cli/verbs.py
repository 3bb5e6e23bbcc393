"""The commands, and what is said where a word on the command line is none of theirs."""

from __future__ import annotations

from importlib import import_module

import click

from vectorplot import __version__
from vectorplot.errors import printable
from vectorplot.words import nearest, one_slip

COMMANDS = {
    "draw": "draw",
    "paint": "paint",
    "info": "info",
    "convert": "convert",
    "render": "render",
    "sheet": "sheet",
    "develop": "develop",
    "anamorphosis": "anamorphosis",
    "contact-sheet": "contact_sheet",
    "animate": "animate",
    "replay": "replay",
    "accuracy": "accuracy",
    "speed": "speed",
    "try": "try_",
}
"""The commands by their names, each in a file of its own in `commands`, which is loaded where it is asked for."""


class Verbs(click.Group):
    """The commands; an unknown one is told with the nearest that is known."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names, in the order of the alphabet."""
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of a name; None where there is none."""
        name = COMMANDS.get(cmd_name)
        if name is None:
            return None
        command: click.Command = getattr(import_module(f"vectorplot.cli.commands.{name}"), name)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that is named. Errors: UsageError for an unknown one."""
        if args and args[0] not in COMMANDS and not args[0].startswith("-"):
            near = nearest(args[0].lower(), COMMANDS)
            ctx.fail(f"No such command {args[0]!r}." + (f" Did you mean {near!r}?" if near else ""))
        return super().resolve_command(ctx, args)


@click.group(cls=Verbs, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="vectorplot", message="%(prog)s %(version)s")
def vectorplot() -> None:
    """3-D scenes as exact line drawings: hidden lines by geometry, never by pixels."""


def every_command() -> dict[str, click.Command]:
    """All commands by their names."""
    context = click.Context(vectorplot)
    return {name: command for name in COMMANDS if (command := vectorplot.get_command(context, name)) is not None}


def say_usage(error: click.UsageError, cause: str) -> None:
    """Print how the command is used, and on one line what was wrong."""
    if error.ctx is not None:
        click.echo(f"{error.ctx.get_usage()}\nTry '{error.ctx.command_path} --help' for help.\n", err=True)
    click.echo(f"Error: {printable(cause)}", err=True)


def meant_option(error: click.NoSuchOption) -> str:
    """A hint at the option of the command that an unknown one may have meant, or nothing."""
    if error.ctx is None:
        return ""
    known = [
        name for option in error.ctx.command.get_params(error.ctx) for name in (*option.opts, *option.secondary_opts)
    ]
    meant, long = error.option_name.lstrip("-").lower(), [name[2:] for name in known if name[:2] == "--"]
    begun = [name for name in long if name.startswith(meant)]
    slipped = any(one_slip(meant, name) for name in long)
    near = begun[0] if len(begun) == 1 and not slipped else nearest(meant, long)
    if near:
        return f" Did you mean '--{near}'?"
    others = [
        name
        for name, command in every_command().items()
        if any(error.option_name in (*option.opts, *option.secondary_opts) for option in command.params)
    ]
    return f" It is an option of {', '.join(others)}." if others else ""
