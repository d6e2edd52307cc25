"""Calls of the program `broadmark`."""

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
from broadmark.recording2 import ChangingRecording, write_copy
from broadmark.recordings import PoseRecording, Recording, write_recording
from broadmark.results import Results, read_results

#: The environment variable with the program's path.
VARIABLE = "BROADMARK"

#: Stands for the file of a recording that was passed as boxes.
BOXES = "boxes from Python"

#: The schema of a run request.
RUN_SCHEMA = "broadmark-run/1"

#: Exit statuses of runs that have results: success, a wrong answer, a time limit.
WITH_RESULTS = (0, 1, 4)


def find_program() -> str:
    """The program's path: $BROADMARK, else built or installed with this package, else on PATH."""
    named = os.environ.get(VARIABLE)
    if named:
        if not os.access(named, os.X_OK):
            raise InputError(f"${VARIABLE} is '{named}', which is not an executable file")
        return named
    package = pathlib.Path(__file__).resolve().parent
    for folder in (package.parents[1] / "build/release", *(p / "bin" for p in package.parents)):
        if os.access(folder / "broadmark", os.X_OK):
            return str(folder / "broadmark")
    found = shutil.which("broadmark")
    if found:
        return found
    raise InputError(
        f"the program broadmark was not found: build it, or set ${VARIABLE} to its path"
    )


def call(*arguments: str, accept: tuple[int, ...] = (0,), show: bool = False) -> str:
    """Runs the program and returns what it prints; with `show` it prints to the terminal instead.

    Raises InputError with the program's message if its exit status is not in `accept`.
    """
    stream = None if show else subprocess.PIPE
    completed = subprocess.run(
        [find_program(), *arguments], stdout=stream, stderr=stream, text=True, check=False
    )
    if completed.returncode in (-signal.SIGINT, 130):
        raise KeyboardInterrupt
    if completed.returncode not in accept:
        raise _error_from(completed.returncode, completed.stderr or "")
    return completed.stdout or ""


def follow(
    *arguments: str,
    tick: Callable[[], None],
    accept: tuple[int, ...] = (0,),
    keep_open: tuple[int, ...] = (),
) -> None:
    """Runs the program and calls `tick` ten times a second until it ends.

    An interruption is passed on to the program, which then saves the finished cases. The program
    inherits the file descriptors `keep_open`. Raises InputError as `call` does.
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
            raise _error_from(process.returncode, errors.read())


def _interrupt(process: subprocess.Popen[bytes]) -> None:
    """Asks the program to end and waits for it; a second interruption kills it."""
    try:
        process.send_signal(signal.SIGINT)
        process.wait()
    except KeyboardInterrupt:
        process.kill()
        process.wait()


def _error_from(status: int, stderr: str) -> InputError:
    lines = stderr.strip().splitlines()
    message = lines[-1] if lines else f"broadmark ended with status {status}"
    return InputError(message.removeprefix("broadmark: "))


def as_options(**options: Any) -> list[str]:
    """Command-line options: threads=[1, 2] gives --threads 1,2; allow_timeout=True gives
    --allow-timeout; param={"margin": 0.1} gives --param margin=0.1; None and False give nothing."""
    arguments = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            arguments.append(option)
        elif isinstance(value, dict):
            for key, item in value.items():
                arguments += [option, f"{key}={_text(item)}"]
        else:
            arguments += [option, _text(value)]
    return arguments


def _text(value: Any) -> str:
    if isinstance(value, str) or not isinstance(value, Iterable):
        return str(value)
    return ",".join(str(item) for item in value)


@contextlib.contextmanager
def request_file(**options: Any) -> Iterator[str]:
    """The path of a run request (docs/run-requests.md) with these options, for --request."""
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        path = pathlib.Path(folder, "request.json")
        path.write_text(json.dumps({"schema": RUN_SCHEMA, **options}, default=_json_value), "utf-8")
        yield str(path)


def _json_value(value: Any) -> Any:
    """Converts values that JSON has no type for: numpy arrays and numbers, sequences, paths."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return list(value) if isinstance(value, Iterable) else str(value)


#: Options of `run` for scenes only.
SCENE_OPTIONS = ("objects", "object_type", "frames", "seed", "density", "engine", "input")

Names = str | Iterable[str]
Numbers = float | Iterable[float]
Path = str | os.PathLike[str]


def run(
    source: Any,
    *,
    algorithm: Names = "all",
    show: bool = False,
    # Sources
    objects: Numbers | None = None,
    object_type: Names | None = None,
    frames: Numbers | None = None,
    seed: Numbers | None = None,
    density: Numbers | None = None,
    engine: Names | None = None,
    input: Path | None = None,
    param: dict[str, Any] | None = None,
    plugin: Path | Iterable[Path] | None = None,
    # Algorithms
    threads: Numbers | None = None,
    isa: Names | None = None,
    answer: str | None = None,
    queries: str | None = None,
    device: str | None = None,
    filter: str | None = None,
    shard: str | None = None,
    # Measuring
    repetitions: int | str | None = None,
    precision: float | str | None = None,
    max_seconds: float | None = None,
    order_seed: int | None = None,
    warmup: int | None = None,
    count: str | None = None,
    time_limit: float | None = None,
    allow_timeout: bool = False,
    check: str | None = None,
    in_process: bool = False,
    pin: bool = False,
    hard_limit: float | None = None,
    memory_limit: float | None = None,
    # Output
    json: Path | None = None,
    csv: Path | None = None,
    csv_frames: Path | None = None,
    print_pairs: bool = False,
    record: Path | None = None,
    recorder: Names | None = None,
    screenshot: Path | None = None,
    frame: int | None = None,
    size: str | None = None,
    gl: str | None = None,
    # Reading
    swept: bool = False,
    widen: float | None = None,
    periodic: bool | str = False,
    body_order: str | None = None,
    format: str | None = None,
    strict: bool = False,
    elements: str | None = None,
    keep: float | None = None,
    radius: float | None = None,
    frame_rate: float | None = None,
    animation: str | None = None,
) -> Results:
    """Runs algorithms and returns their results; the `status` of a case shows whether it failed.

    `source` is a source as on the command line (the name of a scene, a file) or several, a recording
    of `read_recording`, or boxes as in `write_recording`; absent bodies have EMPTY_BOX. The other
    arguments are the program's options, as in a run request (docs/run-requests.md); `broadmark --help`
    describes them:

        run("brownian", algorithm="sap*", objects=[1000, 8000], threads=[1, 2], repetitions=5)

    With `show`, the terminal shows the program's progress and table. Raises InputError if the
    program rejects the request.
    """
    options = {key: value for key, value in locals().items() if key not in ("source", "show")}
    for name in ("json", "csv", "csv_frames"):
        if options[name] == "-" and not show:
            raise InputError(f"{name}: '-', standard output, needs show=True")
    scene = {name: options[name] for name in SCENE_OPTIONS}
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        lines = os.path.join(folder, "results.jsonl")
        opened = as_source(source, folder, **scene)
        with request_file(**options, source=opened, jsonl=lines) as path:
            quiet = [] if show else ["--quiet"]
            call("--headless", "--request", path, *quiet, accept=WITH_RESULTS, show=show)
        results = read_results(lines)
    recording = None if opened is source else BOXES
    # Without the temporary files.
    words = results.files["command"][0][1:]
    command = [word for word in words if folder not in word and word not in ("--request", path)]
    return results.renamed(f"run({recording or _text(source)})", command, recording)


def as_source(source: Any, folder: str, **scene: Any) -> Any:
    """A source for the program: boxes are written as a recording in `folder`. The options `scene` are
    for scenes only."""
    if isinstance(source, (str, os.PathLike)):
        return source
    if isinstance(source, (list, tuple)) and source and isinstance(source[0], (str, os.PathLike)):
        return source
    if isinstance(source, PoseRecording):
        raise InputError("source: a recording of poses: pass the path of its file instead")
    for name, value in scene.items():
        if value is not None:
            raise InputError(f"{name}: for scenes, but the source is boxes")
    if isinstance(source, Recording):
        path = os.path.join(folder, "boxes.aabbs")
        name, object_type, world = source.name, source.object_type, source.world
        write_recording(path, source.boxes, name=name, object_type=object_type, world=world)
        return path
    path = os.path.join(folder, "boxes.broadmark")  # holds absent bodies, unlike .aabbs
    if isinstance(source, ChangingRecording):
        write_copy(path, source)
    else:
        write_recording(path, source)
    return path
