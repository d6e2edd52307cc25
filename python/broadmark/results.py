"""Results files as pandas data frames; docs/results.md describes the files."""

from __future__ import annotations

import functools
import gzip
import html
import json
import os
import pathlib
import re
import warnings
import zlib
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, TextIO

import numpy as np
import pandas as pd

from broadmark.errors import InputError
from broadmark.files import atomic_write

SCHEMAS = ("broadmark-results/2", "broadmark-results/1")

#: The columns of a case, described in docs/results.md. The file is generated from the program's
#: table (tests/engine/case_columns_test.cpp).
COLUMNS: list[dict[str, Any]] = json.loads(
    (pathlib.Path(__file__).parent / "columns.json").read_text("utf-8")
)

#: The family of algorithms that find no pairs: their times are no rivals.
SELF_CHECK_FAMILY = "self-check"

#: The separately timed phases of a frame.
PHASES = ["update_objects", "clean_cache", "update_structures", "search_overlaps"]
TRANSFERS = ["upload", "download"]  #: included in the phases; only for algorithms on a device
COUNTS = ["pairs", "changed_bodies", "missed", "false", "allowed_extra", "invalid"]

#: The columns that identify a frame's case.
CASE_KEYS = ["case", *(column["key"] for column in COLUMNS if column["frames"])]
NUMBERS = [column["key"] for column in COLUMNS if column["kind"] == "number"]

#: The columns of cases in short tables.
SHORT = [
    *("scene", "object_type", "objects", "algorithm", "isa", "threads", "params"),
    *("seconds_per_frame", "pairs_mean", "status"),
]


class FrameColumn(pd.Series):  # type: ignore[misc]
    """A column of a FrameTable."""

    @property
    def _constructor(self) -> type[FrameColumn]:
        return FrameColumn

    def groupby(self, *arguments: Any, observed: bool = True, **options: Any) -> Any:
        return super().groupby(*arguments, observed=observed, **options)

    def value_counts(self, *arguments: Any, **options: Any) -> Any:
        column = self.cat.remove_unused_categories() if self.dtype == "category" else self
        return pd.Series.value_counts(column, *arguments, **options)


class FrameTable(pd.DataFrame):  # type: ignore[misc]
    """A data frame that groups by the texts that occur: a category without a row is no group."""

    @property
    def _constructor(self) -> type[FrameTable]:
        return FrameTable

    @property
    def _constructor_sliced(self) -> type[FrameColumn]:
        return FrameColumn

    def groupby(self, *arguments: Any, observed: bool = True, **options: Any) -> Any:
        return super().groupby(*arguments, observed=observed, **options)

    def pivot_table(self, *arguments: Any, observed: bool = True, **options: Any) -> Any:
        return super().pivot_table(*arguments, observed=observed, **options)


@dataclass(repr=False)
class Results:
    """The cases of one or several results files.

    `cases` has a row per case, indexed by the case's number. The columns are those of the program's
    `--csv`, and `machine`, `started` (the start of the run, UTC), `file`, `complete` (all requested
    repetitions ran, or the status ended the case) and `warnings`. Times are in seconds. Unknown values
    are NaN.

    `details` holds the remaining data of each case, by its number: parameters, conditions, counters,
    differences, and times as arrays.
    """

    cases: pd.DataFrame
    details: list[dict[str, Any]]
    environments: pd.DataFrame  #: a row per machine and build
    files: pd.DataFrame  #: a row per file: file, command (its words), started, complete

    @property
    def partial(self) -> list[str]:
        """The files of unfinished runs."""
        return [row.file for row in self.files.itertuples() if not row.complete]

    @functools.cached_property
    def frames(self) -> FrameTable:
        """A row per case, repetition and frame: the columns of the program's `--csv-frames` after
        `case`, the row in `cases`.

        Times are in whole nanoseconds; `repetition` and `frame` count from 1. Texts are categories.
        """
        numbers = [i for i, case in enumerate(self.details) if case["initialize_ns"]]
        tables = [_frame_table(number, self.details[number]) for number in numbers]
        frames = pd.concat(tables or [_frame_table(0, _NO_FRAMES)], ignore_index=True)
        for position, column in enumerate(CASE_KEYS[1:], 1):
            values = self.cases[column]
            if column not in NUMBERS:
                values = values.iloc[numbers].astype("category").reindex(values.index)
            frames.insert(position, column, values.take(frames["case"]).array)
        return FrameTable(frames)

    def select(self, keep: Any) -> Results:
        """The cases of the mask `keep`, for example `results.select(results.cases.status == "ok")`."""
        cases = self.cases[keep]
        return Results(
            cases.reset_index(drop=True).assign(case=range(len(cases))),
            [self.details[i] for i in cases.index],
            self.environments,
            self.files,
        )

    def __add__(self, other: Results) -> Results:
        """The cases of both, numbered from 0."""
        return _combined([*self._documents(), *other._documents()])

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a results file (.json, .json.gz), which the program reads, too."""
        path = pathlib.Path(path)
        if not path.name.endswith((".json", ".json.gz")):
            raise InputError(f"{path}: the extension of a results file must be .json or .json.gz")
        documents = self._documents()
        options = documents[0].options if len(documents) == 1 else ["merge", *self.files["file"]]
        content = {
            "schema": SCHEMAS[0],
            "options": options,
            "environments": [e for document in documents for e in document.environments],
            "complete": all(document.complete for document in documents),
            "cases": [case for document in documents for case in document.cases],
        }
        first = 0
        for document in documents:
            for case in document.cases:
                case["environment"] += first
            first += len(document.environments)
        text = json.dumps(content, separators=(",", ":"), default=np.ndarray.tolist).encode()
        with atomic_write(path) as file:
            file.write(gzip.compress(text, mtime=0) if path.suffix == ".gz" else text)

    def renamed(self, file: str, options: list[str], recording: str | None = None) -> Results:
        """The same cases as if they were from the run with these options in one file. `recording`: the
        name of their recording's file, if another."""
        documents = self._documents()
        for document in documents:
            document.file, document.options = file, options
            for case in document.cases if recording is not None else []:
                case["recording"] = {**case["recording"], "source": recording}
        return _combined(documents)

    def _documents(self) -> list[_Document]:
        """A document per file."""
        facts = self.environments.drop(columns="machine").to_dict("records")
        documents = []
        for row in self.files.drop_duplicates("file").itertuples():
            document = _Document(row.file, [], [], row.complete, list(row.command[1:]))
            for case in self.cases[self.cases["file"] == row.file].itertuples():
                environment = {
                    **{key: v for key, v in facts[case.environment].items() if not is_unknown(v)},
                    "started": case.started,
                }
                if environment not in document.environments:
                    document.environments.append(environment)
                number = document.environments.index(environment)
                document.cases.append({**self.details[case.case], "environment": number})
            documents.append(document)
        return documents

    def summary(self) -> str:
        """Cases, algorithms, recordings, machines and files: a line each."""
        cases = self.cases
        statuses = cases["status"].value_counts()
        algorithms = sorted(cases["algorithm"][cases["family"] != "self-check"].unique())
        sizes = sorted(cases["objects"].unique())
        recordings = cases["recording_hash"].nunique() if len(cases) else 0
        counts = ", ".join(f"{count:,} {status}" for status, count in statuses.items())
        lines = [f"{_plural(len(cases), 'case')}" + (f": {counts}" if counts else "")]
        if len(cases):
            lines += [
                f"{_plural(len(algorithms), 'algorithm')}: {_first_few(algorithms)}",
                f"{_plural(recordings, 'recording')}: {_first_few(sorted(cases['scene'].unique()))}"
                f"; {_first_few([f'{n:,}' for n in sizes])} bodies",
                *self.environments["machine"].loc[sorted(cases["environment"].unique())],
            ]
        unfinished = set(self.partial)
        files = [f"{f} (partial)" if f in unfinished else f for f in self.files.get("file", [])]
        return "\n".join([*lines, *([_first_few(files)] if files else [])])

    def __repr__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        summary = html.escape(self.summary()).replace("\n", "<br>")
        table: str = self.cases[SHORT].to_html(max_rows=20)
        return f"<p>{summary}</p>{table}"


def _plural(count: int, word: str) -> str:
    return f"{count:,} {word}" + ("" if count == 1 else "s")


def _first_few(names: list[str]) -> str:
    return ", ".join(names[:8]) + (f" and {len(names) - 8:,} more" if len(names) > 8 else "")


def is_unknown(value: Any) -> bool:
    return value is None or value is pd.NA or isinstance(value, float) and value != value


#: Exceptions raised by values of an unexpected type or shape.
_SHAPE_ERRORS = (KeyError, TypeError, IndexError, AttributeError, ValueError, OverflowError)


class NotResultsError(InputError):
    """Not a results file; may be a valid file of another kind."""


def read_results(
    *paths: str | os.PathLike[str],
    skip: Callable[[str | os.PathLike[str], NotResultsError], bool] = lambda _path, _error: False,
) -> Results:
    """Reads results files of any version, JSON or JSON Lines.

    Raises InputError for other files, NotResultsError for those of another kind unless `skip` allows
    to leave one out. An incomplete last line means that the run was ended while
    writing it: the lines before are read, and the file is in `partial`.
    """
    documents = []
    for path in paths:
        try:
            documents.append(_document(path))
        except NotResultsError as error:
            if not skip(path, error):
                raise
    return _combined(documents)


def _combined(documents: list[_Document]) -> Results:
    environments: list[dict[str, Any]] = []
    details: list[dict[str, Any]] = []
    rows: list[dict[str, Any]] = []
    files: dict[Any, str] = {}  # by case
    copies: Counter[tuple[str, str]] = Counter()
    for document in documents:
        indices = [
            _environment_index(environments, environment) for environment in document.environments
        ]
        for case in document.cases:
            try:
                _check_lengths(case)
                row = _row(case)
                number = case.get("environment", 0)
                row["environment"] = indices[number]
                row["started"] = str(document.environments[number].get("started") or "")
                identity = (row["environment"], row["started"], _identity(case))
            except _SHAPE_ERRORS as error:
                raise InputError(
                    f"{document.file}: case {case.get('id', len(rows))!r}: does not match "
                    f"docs/results.md: {type(error).__name__} {error}"
                ) from None
            if identity in files:
                copies[document.file, files[identity]] += 1
                continue
            files[identity] = document.file
            known = {key: np.nan if value is None else value for key, value in row.items()}
            rows.append({"case": len(rows), **known, "file": document.file})
            details.append(case)
    for (file, other), count in copies.items():
        warnings.warn(
            f"{file}: repeats {_plural(count, 'case')} of {other}: left out", stacklevel=3
        )
    machines = _machine_names(environments)
    columns = ["case", *(column["key"] for column in COLUMNS)]
    columns += ["complete", "warnings", "environment", "started", "file"]
    try:
        cases = pd.DataFrame(rows, columns=columns)
        cases[NUMBERS] = cases[NUMBERS].apply(pd.to_numeric)
        table = pd.DataFrame(environments, dtype=object).apply(_inferred)
    except (OverflowError, TypeError, ValueError) as error:
        names = ", ".join(document.file for document in documents)
        raise InputError(f"{names}: {error}") from None
    cases["machine"] = [machines[number] for number in cases["environment"]]
    table["machine"] = machines
    file_rows: list[dict[str, Any]] = []
    for document in documents:
        row = _file_row(document)
        file_rows += [row] if row not in file_rows else []
    return Results(cases, details, table, pd.DataFrame(file_rows))


def _inferred(column: pd.Series) -> pd.Series:
    """The column of environments with the type of its values. Integers beside unknown values would
    become floats."""
    if not column.isna().any():
        return column.infer_objects()
    is_flag = pd.api.types.infer_dtype(column, skipna=True) == "boolean"
    return column.astype("boolean") if column.name == "dirty" and is_flag else column


@dataclass
class _Document:
    file: str
    environments: list[dict[str, Any]]
    cases: list[dict[str, Any]]
    complete: bool
    options: list[str]


def _file_row(document: _Document) -> dict[str, Any]:
    started = [
        str(environment["started"])
        for environment in document.environments
        if environment.get("started")
    ]
    return {
        "file": document.file,
        "command": ["broadmark", *document.options],
        "started": min(started, default=""),
        "complete": document.complete,
    }


def _open(path: pathlib.Path) -> TextIO:
    if path.suffix == ".gz":
        return gzip.open(path, "rt", encoding="utf-8")
    return open(path, encoding="utf-8")


def _document(path: str | os.PathLike[str]) -> _Document:
    try:
        with _open(pathlib.Path(path)) as file:
            first = file.readline()
            try:
                head = _parsed(first)
            except json.JSONDecodeError:  # a JSON document of many lines
                head = _parsed(first + file.read())
            if not isinstance(head, dict) or head.get("schema") not in SCHEMAS:
                raise NotResultsError(f"{path}: not a results file: the schema is not {SCHEMAS[0]}")
            if "cases" not in head:
                return _from_lines(path, file, _options(path, head))
    except InputError:
        raise
    except (OSError, EOFError, zlib.error, RecursionError, *_SHAPE_ERRORS) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
    return _from_document(path, head)


def _from_document(path: str | os.PathLike[str], document: dict[str, Any]) -> _Document:
    environments = document.get("environments", [document.get("environment")])
    if not all(
        isinstance(values, list) and all(isinstance(value, dict) for value in values)
        for values in (environments, document["cases"])
    ):
        raise InputError(f"{path}: an environment or a case is not an object")
    return _Document(
        os.fspath(path),
        environments,
        document["cases"],
        document.get("complete", True),
        _options(path, document),
    )


def _options(path: str | os.PathLike[str], head: dict[str, Any]) -> list[str]:
    options = head.get("options", [])
    if not isinstance(options, list):
        raise InputError(f"{path}: the options are not a list: {options!r}")
    return list(map(str, options))


def _from_lines(
    path: str | os.PathLike[str], lines: Iterable[str], options: list[str]
) -> _Document:
    document = _Document(os.fspath(path), [], [], False, options)
    for number, line in enumerate(lines, 2):
        try:
            kind, content = next(iter(_parsed(line).items()))
        except (json.JSONDecodeError, AttributeError, StopIteration):
            if line.endswith("\n"):
                raise InputError(f"{path}: line {number}: not a JSON object") from None
            break  # the run was ended while writing this line
        if kind == "end":
            document.complete = content["complete"]
        elif kind == "environment":
            document.environments.append(content)
        elif kind == "case":
            document.cases.append(content)
    return document


def _parsed(text: str) -> Any:
    """Parses JSON with the times and counts of frames as arrays: a tenth of the memory of lists."""
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


def _environment_index(environments: list[dict[str, Any]], environment: dict[str, Any]) -> int:
    """The index of an environment, added if new. Start time and load are ignored."""
    ignored = ("started", "load_average")
    identity = {key: value for key, value in environment.items() if key not in ignored}
    for number, known in enumerate(environments):
        if all(known.get(key) == value for key, value in identity.items()):
            return number
    environments.append(environment)
    return len(environments) - 1


def _machine_names(environments: list[dict[str, Any]]) -> list[str]:
    """A short unique name for each environment: machine, and build if a machine has several."""
    machines = []
    for environment in environments:
        host = f"{environment['host']}: " if environment.get("host") else ""
        cores = environment.get("logical_cores", "?")
        machines.append(f"{host}{environment.get('cpu') or 'unknown'}, {cores} cores")
    names: list[str] = []
    for machine, environment in zip(machines, environments):
        commit = commit_name(environment)
        name = f"{machine}, commit {commit}" if commit and machines.count(machine) > 1 else machine
        duplicates = sum(other.split(" #")[0] == name for other in names)
        names.append(f"{name} #{duplicates + 1}" if duplicates else name)
    return names


def without_build(machine: str) -> str:
    """The name of an environment without what tells it from others of the same machine."""
    return re.sub(r"(, commit [^,#]+)?( #\d+)?$", "", machine)


def commit_name(environment: dict[str, Any]) -> str:
    """The commit of a build, as by `broadmark --version --verbose`; "" if unknown."""
    commit = environment.get("commit")
    if not isinstance(commit, str) or not commit:
        return ""
    return commit[:10] + (" with changes" if environment.get("dirty") is True else "")


def _identity(case: dict[str, Any]) -> tuple[str, int]:
    """What is equal in copies of a case."""
    large = ("environment", "frames", "frame_counts")
    facts = {name: value for name, value in case.items() if name not in large}
    times = b"".join(np.asarray(times).tobytes() for times in case["frames"]["total"])
    return json.dumps(facts, sort_keys=True, default=np.ndarray.tolist), hash(times)


def _check_lengths(case: dict[str, Any]) -> None:
    """Raises ValueError unless all phases have the same numbers of repetitions and frames."""
    lengths = [len(repetition) for repetition in case["frames"]["total"]]
    if len(lengths) != len(case["initialize_ns"]):
        raise ValueError("expected equal numbers of repetitions and initialisations")
    for phase, repetitions in case["frames"].items():
        if [len(repetition) for repetition in repetitions] != lengths:
            raise ValueError(f"{phase}: expected the same number of frames in all phases")


def is_complete(case: dict[str, Any]) -> bool:
    """Whether all requested repetitions of a case ran, or its status ended it."""
    requested = case.get("conditions", {}).get("repetitions")
    return case["status"] != "ok" or requested is None or len(case["frames"]["total"]) >= requested


def _row(case: dict[str, Any]) -> dict[str, Any]:
    """A case's row in the table of cases."""
    known = {"always": True, "timed": bool(case["initialize_ns"]), "checked": case["checked"]}
    return {
        **{
            column["key"]: (
                _FORMS[column["form"]](_value_at(column, case), case)
                if known[column["known"]]
                else None
            )
            for column in COLUMNS
        },
        "complete": is_complete(case),
        "warnings": "; ".join(case.get("conditions", {}).get("warnings", [])),
    }


def _value_at(column: dict[str, Any], case: dict[str, Any]) -> Any:
    """The value at a column's path; files of earlier versions lack some optional values."""
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
    """The mean of all frames; 0 for the transfer times of a case without a device."""
    if nanoseconds is None:
        return 0.0 if any(map(len, case["frames"]["total"])) else None
    # None: instructions were counted, not times.
    known = [times for times in nanoseconds if times is not None]
    times = np.hstack(known) if known else np.empty(0)
    return float(times.mean()) * 1e-9 if len(times) else None


def _per_frame(sums: Any, case: dict[str, Any]) -> float | None:
    """The mean per frame over the repetitions with a known sum."""
    counted = case.get("conditions", {}).get("counted_by")  # instead of times
    known = [
        (total, len(case["frame_counts"]["pairs"]) if counted else len(times))
        for total, times in zip(sums or [], case["frames"]["total"])
        if total is not None
    ]
    frames = sum(length for _, length in known)
    return sum(total for total, _ in known) / frames if frames else None


#: A repetition without a frame, for the columns of an empty table.
_NO_FRAMES: dict[str, Any] = {"checked": True, "frames": {"total": [[]]}}

#: The conversion from the value at a column's path to the column, by the column's form.
_FORMS: dict[str, Callable[[Any, dict[str, Any]], Any]] = {
    "value": lambda value, _: value,
    "text": lambda value, _: value if isinstance(value, str) else "",
    "joined": _joined,
    "count": lambda values, _: len(values),
    "seconds": _seconds,
    "per_frame": _per_frame,
}


def _frame_table(number: int, case: dict[str, Any]) -> pd.DataFrame:
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
            # The file omits the counts of kinds of wrong pairs that did not occur.
            default = 0 if case["checked"] and count not in ("pairs", "changed_bodies") else np.nan
            values = counts.get(count, [])[:length]
            columns[count] = values if len(values) == length else default
        # While the inspector drew, which results files don't hold.
        columns |= {"checked": bool(case["checked"]), "disturbed": False}
        tables.append(pd.DataFrame(columns, index=range(length)))
    return pd.concat(tables, ignore_index=True)
