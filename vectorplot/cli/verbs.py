"""The commands, and what is said where a word on the command line is none of theirs."""

from __future__ import annotations

import click

from vectorplot import __version__
from vectorplot.cli.commands.accuracy import accuracy
from vectorplot.cli.commands.animate import animate
from vectorplot.cli.commands.contact_sheet import contact_sheet
from vectorplot.cli.commands.draw import draw
from vectorplot.cli.commands.info import info
from vectorplot.cli.commands.paint import paint
from vectorplot.cli.commands.render import render
from vectorplot.cli.commands.replay import replay
from vectorplot.cli.commands.sheet import sheet
from vectorplot.cli.commands.speed import speed
from vectorplot.cli.commands.try_ import try_
from vectorplot.errors import printable
from vectorplot.words import nearest


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
vectorplot.add_command(sheet)
vectorplot.add_command(contact_sheet)
vectorplot.add_command(animate)
vectorplot.add_command(replay)
vectorplot.add_command(accuracy)
vectorplot.add_command(speed)
vectorplot.add_command(try_)


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
    near = nearest(error.option_name.lstrip("-").lower(), (name[2:] for name in known if name[:2] == "--"))
    if near:
        return f" Did you mean '--{near}'?"
    others = [
        name
        for name, command in vectorplot.commands.items()
        if any(error.option_name in (*option.opts, *option.secondary_opts) for option in command.params)
    ]
    return f" It is an option of {', '.join(others)}." if others else ""
