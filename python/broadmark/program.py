"""The program `broadmark`, called from Python."""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from broadmark.errors import InputError
from broadmark.recordings import write_recording
from broadmark.results import Results, read_results

#: The environment variable that names the program.
VARIABLE = "BROADMARK"

#: The kind of JSON file that a run request is.
RUN_SCHEMA = "broadmark-run/1"

#: Exit statuses with which a run has results all the same: fine, a wrong answer, a time limit.
WITH_RESULTS = (0, 1, 4)


def find_program() -> str:
    """The program: what $BROADMARK names, the one built or installed with this package, or on PATH."""
    named = os.environ.get(VARIABLE)
    if named:
        if not os.access(named, os.X_OK):
            raise InputError(f"${VARIABLE} is '{named}', which is no program")
        return named
    package = pathlib.Path(__file__).resolve().parent
    for beside in (package.parents[1] / "build/release", *(p / "bin" for p in package.parents)):
        if os.access(beside / "broadmark", os.X_OK):
            return str(beside / "broadmark")
    found = shutil.which("broadmark")
    if found:
        return found
    raise InputError(f"the program broadmark is not there: build it, or name it in ${VARIABLE}")


def call(*arguments: str, accept: tuple[int, ...] = (0,), show: bool = False) -> str:
    """Runs the program and returns what it prints; with `show` it prints to the terminal instead.

    Raises InputError with its own message when it ends with a status that is not in `accept`.
    """
    keep = None if show else subprocess.PIPE
    done = subprocess.run(
        [find_program(), *arguments], stdout=keep, stderr=keep, text=True, check=False
    )
    if done.returncode in (-signal.SIGINT, 130):
        raise KeyboardInterrupt
    if done.returncode not in accept:
        raise _refusal(done.returncode, done.stderr or "")
    return done.stdout or ""


def follow(
    *arguments: str,
    tick: Callable[[], None],
    accept: tuple[int, ...] = (0,),
    keep_open: tuple[int, ...] = (),
) -> None:
    """Runs the program and calls `tick` a few times a second meanwhile.

    An interruption is passed on to the program, which then keeps what is finished. `keep_open` are
    files that the program holds, too. Raises InputError as `call` does.
    """
    with tempfile.TemporaryFile("w+", errors="replace") as errors:
        process = subprocess.Popen(
            [find_program(), *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=errors,
            pass_fds=keep_open,
        )
        try:
            while process.poll() is None:
                tick()
                time.sleep(0.1)
        except BaseException:
            _interrupt(process)
            raise
        tick()
        if process.returncode in (-signal.SIGINT, 130):
            raise KeyboardInterrupt
        if process.returncode not in accept:
            errors.seek(0)
            raise _refusal(process.returncode, errors.read())


def _interrupt(process: subprocess.Popen[bytes]) -> None:
    """Ends the program: by itself, or at once when that is wished again."""
    try:
        process.send_signal(signal.SIGINT)
        process.wait()
    except KeyboardInterrupt:
        process.kill()
        process.wait()


def _refusal(status: int, stderr: str) -> InputError:
    lines = stderr.strip().splitlines()
    message = lines[-1] if lines else f"broadmark ended with status {status}"
    return InputError(message.removeprefix("broadmark: "))


def as_options(**options: Any) -> list[str]:
    """Options of the command line: threads=[1, 2] is --threads 1,2; allow_timeout=True is
    --allow-timeout; param={"margin": 0.1} is --param margin=0.1; None is nothing."""
    arguments = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            arguments.append(option)
        elif isinstance(value, dict):
            for key, one in value.items():
                arguments += [option, f"{key}={_text(one)}"]
        else:
            arguments += [option, _text(value)]
    return arguments


def _text(value: Any) -> str:
    if isinstance(value, str) or not isinstance(value, Iterable):
        return str(value)
    return ",".join(str(one) for one in value)


@contextlib.contextmanager
def request_file(**options: Any) -> Iterator[str]:
    """The path of a run request (docs/run-requests.md) with these options, for --request."""
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        path = pathlib.Path(folder, "request.json")
        path.write_text(json.dumps({"schema": RUN_SCHEMA, **options}, default=_plain), "utf-8")
        yield str(path)


def _plain(value: Any) -> Any:
    """What JSON has no type for: arrays and their numbers, other sequences, paths."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return list(value) if isinstance(value, Iterable) else str(value)


def run(source: Any, *, algorithm: Any = "all", show: bool = False, **options: Any) -> Results:
    """Runs algorithms, and returns their results; a case that failed says so in its `status`.

    `source` is whatever the command line takes (a scene's name, a file), or boxes as
    `write_recording` takes them. Other arguments are the program's options, as a run request
    (docs/run-requests.md) has them:

        run("brownian", algorithm="sap*", objects=[1000, 8000], threads=[1, 2], repetitions=5)

    With `show`, progress and the program's own table go to the terminal. Raises InputError for
    what the program refuses.
    """
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        if not isinstance(source, (str, os.PathLike)):
            boxes, source = source, os.path.join(folder, "boxes.aabbs")
            write_recording(source, boxes)
        lines = os.path.join(folder, "results.jsonl")
        request = {"source": source, "algorithm": algorithm, **options, "jsonl": lines}
        with request_file(**request) as path:
            quiet = [] if show else ["--quiet"]
            call("--headless", "--request", path, *quiet, accept=WITH_RESULTS, show=show)
        return read_results(lines)
