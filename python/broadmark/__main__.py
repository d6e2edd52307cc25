"""The command line: `python3 -m broadmark COMMAND …`."""

from __future__ import annotations

import argparse
import errno
import importlib
import os
import sys
import warnings

import broadmark
from broadmark.commands import COMMANDS
from broadmark.program import find_program

EXIT_STATUSES = """\
exit status:
  0    success
  1    a wrong answer or a failed algorithm
  2    bad usage or bad input
  130  interrupted (Ctrl-C)"""


def _version() -> str:
    try:
        program = find_program()
    except broadmark.InputError:
        program = "not found"
    return f"broadmark {broadmark.__version__}; the program: {program}"


def parser(names: list[str]) -> argparse.ArgumentParser:
    """The parser of the named commands."""
    summary, _, rest = (broadmark.__doc__ or "").partition("\n")
    top = argparse.ArgumentParser(
        "python3 -m broadmark",
        description=summary,
        epilog=EXIT_STATUSES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="version", version=_version())
    commands = top.add_subparsers(metavar="COMMAND", required=True)
    for name in names:
        module = importlib.import_module(f"broadmark.commands.{name}")
        doc = (module.__doc__ or "").strip()
        command = commands.add_parser(
            name,
            help=doc.splitlines()[0],
            description=doc,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        module.add_options(command)
        command.set_defaults(main=module.main)
    return top


def main(arguments: list[str] | None = None) -> int:
    """Runs a command. Bad input prints a line on standard error and returns status 2."""
    if sys.stdout is None:  # closed
        return _output_failed(OSError(errno.EBADF, os.strerror(errno.EBADF)))
    try:
        try:
            return _run(sys.argv[1:] if arguments is None else arguments)
        finally:
            sys.stdout.flush()
    except OSError as error:
        if error.filename is not None:
            raise
        # What is left of the output cannot be written at exit, either.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return _output_failed(error)


def _run(arguments: list[str]) -> int:
    # Import only the called command's module: other commands load large libraries.
    names = [name for name in COMMANDS if name in arguments[:1]] or COMMANDS
    options = parser(names).parse_args(arguments)
    try:
        return options.main(options) or 0
    except broadmark.InputError as error:
        print(f"broadmark: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("broadmark: interrupted", file=sys.stderr)
        return 130


def _output_failed(error: OSError) -> int:
    """The exit status after an error of standard output."""
    if isinstance(error, BrokenPipeError):  # `… | head`
        return 0
    print(f"broadmark: standard output: cannot be written: {error.strerror}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    warnings.formatwarning = lambda message, *_, **__: f"broadmark: warning: {message}\n"
    sys.exit(main())
