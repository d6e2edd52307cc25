"""Results files as pandas data frames (docs/results.md describes the files)."""

from __future__ import annotations

import functools
import gzip
import json
import os
import pathlib
import zlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, TextIO

import numpy as np
import pandas as pd

from broadmark.errors import InputError

SCHEMAS = ("broadmark-results/2", "broadmark-results/1")

#: What the program's results have of a case: docs/results.md lists these columns. The file is
#: written from the program's own table (tests/engine/case_columns_test.cpp).
COLUMNS: list[dict[str, Any]] = json.loads(
    (pathlib.Path(__file__).parent / "columns.json").read_text("utf-8")
)

#: The parts of a frame's work that are timed apart, and all of it.
PHASES = ["update_objects", "clean_cache", "update_structures", "search_overlaps"]
TRANSFERS = ["upload", "download"]  #: are in the phases; only of algorithms on a device
COUNTS = ["pairs", "changed_bodies", "missed", "false", "allowed_extra", "invalid"]

#: The columns that tell which case a frame is of.
CASE_KEYS = ["case", *(column["key"] for column in COLUMNS if column["frames"])]


@dataclass
class Results:
    """The cases of one or several results files.

    `cases` has a row per case, its index being the case's number. Columns are those of the
    program's `--csv`, and `machine`, `file`, `complete` (it ran as often as was asked for, or ended
    by its status), `warnings`. Times are in seconds. Cells of what is not known are missing (NaN).

    `details` holds what else the files say of each case, by its number: parameters, conditions,
    counters, differences, and its times as arrays.
    """

    cases: pd.DataFrame
    details: list[dict[str, Any]]
    environments: pd.DataFrame  #: a row per machine and build
    files: pd.DataFrame  #: a row per file: file, command (its words), started, complete

    @property
    def partial(self) -> list[str]:
        """The files of runs that did not come to an end."""
        return [one.file for one in self.files.itertuples() if not one.complete]

    @functools.cached_property
    def frames(self) -> pd.DataFrame:
        """A row per case, repetition and frame; columns are those of the program's `--csv-frames`.

        Times are in whole nanoseconds; `repetition` and `frame` count from 1.
        """
        numbers = [i for i, case in enumerate(self.details) if case["initialize_ns"]]
        if not numbers:
            return pd.DataFrame(columns=[*CASE_KEYS, "repetition", "frame"])
        tables = [_frames_of(number, self.details[number]) for number in numbers]
        frames = pd.concat(tables, ignore_index=True)
        keys = self.cases[CASE_KEYS[1:]].astype("category")
        for column in reversed(CASE_KEYS[1:]):
            frames.insert(1, column, keys[column].take(frames["case"]).values)
        return frames

    def select(self, keep: Any) -> Results:
        """These cases only: `keep` is a mask, as in `results.select(results.cases.status == "ok")`."""
        cases = self.cases[keep]
        return Results(
            cases.reset_index(drop=True).assign(case=range(len(cases))),
            [self.details[i] for i in cases.index],
            self.environments,
            self.files,
        )


#: What it raises to take values for others than they are.
_MISSHAPEN = (KeyError, TypeError, IndexError, AttributeError, ValueError, OverflowError)


def read_results(*paths: str | os.PathLike[str]) -> Results:
    """Reads results files of any version, JSON or JSON Lines.

    Raises InputError for a file that is none. A file whose last line is broken is of a run that was
    ended while it wrote: what is before counts, and the file is in `partial`.
    """
    environments: list[dict[str, Any]] = []
    details: list[dict[str, Any]] = []
    rows: list[dict[str, Any]] = []
    files: list[dict[str, Any]] = []
    for path in paths:
        document = _document(pathlib.Path(path))
        try:
            files.append(_file_row(path, document))
        except TypeError as error:
            raise InputError(f"{path}: its options are not a list: {error}") from None
        known = [_number_in(environments, one) for one in document.environments]
        for case in document.cases:
            try:
                _check_lengths(case)
                row = _row(case)
                row["environment"] = known[case.get("environment", 0)]
            except _MISSHAPEN as error:
                raise InputError(
                    f"{path}: case {case.get('id', len(rows))!r}: not as docs/results.md has it: "
                    f"{type(error).__name__} {error}"
                ) from None
            rows.append({"case": len(rows), **row, "file": os.fspath(path)})
            details.append(case)
    machines = _machine_names(environments)
    try:
        cases = pd.DataFrame(rows, columns=None if rows else ["case", *CASE_KEYS[1:], "status"])
        table = pd.DataFrame(environments)
    except OverflowError as error:
        raise InputError(f"{', '.join(map(str, paths))}: {error}") from None
    if rows:
        cases["machine"] = [machines[number] for number in cases["environment"]]
    table["machine"] = machines
    return Results(cases, details, table, pd.DataFrame(files))


@dataclass
class _Document:
    environments: list[dict[str, Any]]
    cases: list[dict[str, Any]]
    complete: bool
    options: list[str]


def _file_row(path: str | os.PathLike[str], document: _Document) -> dict[str, Any]:
    started = [str(one["started"]) for one in document.environments if one.get("started")]
    return {
        "file": os.fspath(path),
        "command": ["broadmark", *map(str, document.options)],
        "started": min(started, default=""),
        "complete": document.complete,
    }


def _opened(path: pathlib.Path) -> TextIO:
    if path.suffix == ".gz":
        return gzip.open(path, "rt", encoding="utf-8")
    return open(path, encoding="utf-8")


def _document(path: pathlib.Path) -> _Document:
    try:
        with _opened(path) as file:
            first = file.readline()
            try:
                head = _parsed(first)
            except json.JSONDecodeError:  # a document of many lines
                head = _parsed(first + file.read())
            if not isinstance(head, dict) or head.get("schema") not in SCHEMAS:
                raise InputError(f"{path}: is no results file: its schema is not {SCHEMAS[0]}")
            if "cases" not in head:
                return _from_lines(path, file, head.get("options", []))
    except (OSError, EOFError, zlib.error, RecursionError, *_MISSHAPEN) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
    environments = head.get("environments", [head.get("environment")])
    if not all(
        isinstance(some, list) and all(isinstance(one, dict) for one in some)
        for some in (environments, head["cases"])
    ):
        raise InputError(f"{path}: an environment or a case is not an object")
    complete = head.get("complete", True)
    return _Document(environments, head["cases"], complete, head.get("options", []))


def _from_lines(path: pathlib.Path, lines: Iterable[str], options: list[str]) -> _Document:
    document = _Document([], [], False, options)
    for number, line in enumerate(lines, 2):
        try:
            kind, content = next(iter(_parsed(line).items()))
        except (json.JSONDecodeError, AttributeError, StopIteration):
            if line.endswith("\n"):
                raise InputError(f"{path}: line {number}: is no JSON object") from None
            break  # the run ended while it wrote this line
        if kind == "end":
            document.complete = content["complete"]
        elif kind == "environment":
            document.environments.append(content)
        elif kind == "case":
            document.cases.append(content)
    return document


def _parsed(text: str) -> Any:
    """JSON whose times and counts of frames are arrays: a tenth of the memory of lists."""
    return json.loads(text, object_hook=_with_arrays)


def _with_arrays(members: dict[str, Any]) -> dict[str, Any]:
    if "total" in members and "search_overlaps" in members:  # times: a list per repetition
        return {
            phase: [np.array(times, np.int64) for times in repetitions]
            for phase, repetitions in members.items()
        }
    if "changed_bodies" in members:  # counts
        return {name: np.array(counts, np.int64) for name, counts in members.items()}
    return members


def _number_in(environments: list[dict[str, Any]], one: dict[str, Any]) -> int:
    """The number of the machine and build; runs that began at another time are of the same."""
    changing = ("started", "load_average")
    lasting = {key: value for key, value in one.items() if key not in changing}
    for number, known in enumerate(environments):
        if all(known.get(key) == value for key, value in lasting.items()):
            return number
    environments.append(one)
    return len(environments) - 1


def _machine_names(environments: list[dict[str, Any]]) -> list[str]:
    """A short name for each environment, no two alike."""
    names: list[str] = []
    for one in environments:
        host = f"{one['host']}: " if one.get("host") else ""
        name = f"{host}{one.get('cpu') or 'unknown'}, {one.get('logical_cores', '?')} cores"
        alike = sum(other.split(" #")[0] == name for other in names)
        names.append(f"{name} #{alike + 1}" if alike else name)
    return names


def _check_lengths(case: dict[str, Any]) -> None:
    """Raises ValueError unless every phase has the same frames, in as many repetitions."""
    lengths = [len(repetition) for repetition in case["frames"]["total"]]
    if len(lengths) != len(case["initialize_ns"]):
        raise ValueError("as many repetitions as initialisations are expected")
    for phase, repetitions in case["frames"].items():
        if [len(repetition) for repetition in repetitions] != lengths:
            raise ValueError(f"{phase}: the same number of frames in all phases is expected")


def is_complete(case: dict[str, Any]) -> bool:
    """Whether a case ran as often as was asked for, or ended by its status."""
    asked = case.get("conditions", {}).get("repetitions")
    return case["status"] != "ok" or asked is None or len(case["frames"]["total"]) >= asked


def _row(case: dict[str, Any]) -> dict[str, Any]:
    """What the table of cases says of one."""
    known = {"always": True, "timed": bool(case["initialize_ns"]), "checked": case["checked"]}
    return {
        **{
            column["key"]: _FORMS[column["form"]](_found(column, case), case)
            if known[column["known"]]
            else None
            for column in COLUMNS
        },
        "complete": is_complete(case),
        "warnings": "; ".join(case.get("conditions", {}).get("warnings", [])),
    }


def _found(column: dict[str, Any], case: dict[str, Any]) -> Any:
    """What stands at a column's place; files of earlier versions lack some of those optional."""
    value: Any = case
    for name in column["path"].split("/"):
        if isinstance(value, list):
            value = value[int(name)]
        elif column["optional"] and (value is None or name not in value):
            return column["if_missing"]
        else:
            value = value[name]
    return value


def _joined(parameters: Any, _: dict[str, Any]) -> str:
    if not isinstance(parameters, dict):
        return ""
    return ";".join(f"{name}={value}" for name, value in parameters.items())


def _seconds(nanoseconds: Any, case: dict[str, Any]) -> float | None:
    """The mean; without a device there are no times of one."""
    if nanoseconds is None:
        return 0.0 if any(map(len, case["frames"]["total"])) else None
    all_of_them = np.hstack(nanoseconds) if nanoseconds else np.empty(0)
    return float(all_of_them.mean()) * 1e-9 if len(all_of_them) else None


def _per_frame(sums: Any, case: dict[str, Any]) -> float | None:
    """Over the repetitions of which the sum is known."""
    known = [
        (total, len(times))
        for total, times in zip(sums or [], case["frames"]["total"])
        if total is not None
    ]
    frames = sum(length for _, length in known)
    return sum(total for total, _ in known) / frames if frames else None


#: How a column follows from what stands at its place in a case.
_FORMS: dict[str, Callable[[Any, dict[str, Any]], Any]] = {
    "value": lambda value, _: value,
    "text": lambda value, _: value if isinstance(value, str) else "",
    "joined": _joined,
    "count": lambda values, _: len(values),
    "seconds": _seconds,
    "per_frame": _per_frame,
}


def _frames_of(number: int, case: dict[str, Any]) -> pd.DataFrame:
    tables = []
    counts = case.get("frame_counts", {})
    for repetition in range(len(case["frames"]["total"])):
        length = len(case["frames"]["total"][repetition])
        columns: dict[str, Any] = {
            "case": number,
            "repetition": repetition + 1,
            "frame": np.arange(1, length + 1),
        }
        for phase in [*PHASES, *TRANSFERS, "total"]:
            times = case["frames"].get(phase)
            columns[f"{phase}_ns"] = times[repetition] if times else 0
        for count in COUNTS:
            # Kinds of wrong pairs that there are none of are left out of the file.
            none = 0 if case["checked"] and count not in ("pairs", "changed_bodies") else np.nan
            values = counts.get(count, [])[:length]
            columns[count] = values if len(values) == length else none
        tables.append(pd.DataFrame(columns, index=range(length)))
    return pd.concat(tables, ignore_index=True)
