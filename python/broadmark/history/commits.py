"""The order of results files by the commits that they measure.

The commit of a case is `commit` in its environment or, with a git repository, named in the path of its
file. Without commits each file is a step of its own. The order is that of the repository, else of
`commit_date`, else of the starts of the runs.
"""

from __future__ import annotations

import bisect
import pathlib
import re
import subprocess
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime, timezone
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from broadmark.errors import InputError
from broadmark.results import Results, without_build

#: How a commit looks in a path.
_HASH = re.compile(r"(?<![0-9a-z])[0-9a-f]{7,40}(?![0-9a-z])")

_SHORT = 7  #: digits of a hash that are shown, if they identify it


@dataclass(frozen=True)
class Commit:
    """A step of the history: a commit, or a results file if commits are unknown."""

    name: str  #: the commit as the results name it, or the file
    label: str  #: short: the digits of the hash that identify it, or the date
    date: datetime | None  #: of the commit, or of the first run


@dataclass(frozen=True)
class Order:
    """The commits in their order."""

    commits: list[Commit]
    indices: npt.NDArray[np.int64]  #: the index of each case's commit
    word: str = "commit"  #: what a step is: "commit", or "run" if commits are unknown


def ordered_commits(results: Results, repository: str | None) -> Order:
    """The order of the results. Raises InputError if it is unknown."""
    cases = results.cases
    environments = results.environments.to_dict("records")
    facts = [environments[number] for number in cases["environment"]]
    names = [_text(environment.get("commit")) for environment in facts]
    if repository is not None:
        return _in_repository(repository, names, cases["file"])
    if not any(names) or any(environment.get("dirty") is True for environment in facts):
        return _by_file(cases)  # builds with changes of one commit may differ
    nameless = [file for file, name in zip(cases["file"], names) if not name]
    if nameless:
        raise InputError(
            f"{nameless[0]}: its environment names no commit, those of other files do: "
            "add 'commit' to all or to none"
        )
    dates = [_text(environment.get("commit_date")) for environment in facts]
    if all(dates):
        return _by_date(names, dates, cases["file"])
    return _by_start(names, cases)


def _text(value: Any) -> str:
    return value if isinstance(value, str) else ""


def _time(file: str, key: str, text: str) -> datetime:
    try:
        time = datetime.fromisoformat(text.replace("Z", "+00:00"))
    except ValueError:
        raise InputError(
            f"{file}: {key} '{text}': expected a time such as 2026-01-02T03:04:05Z"
        ) from None
    return (time if time.tzinfo else time.replace(tzinfo=timezone.utc)).astimezone(timezone.utc)


def _starts(cases: pd.DataFrame) -> list[datetime]:
    for file, started in zip(cases["file"], cases["started"]):
        if not started:
            raise InputError(
                f"{file}: its environment says neither when the run began ('started') nor of which "
                "commit it is: the order of the results is unknown"
            )
    return [_time(file, "started", text) for file, text in zip(cases["file"], cases["started"])]


def _by_file(cases: pd.DataFrame) -> Order:
    starts = pd.Series(_starts(cases), cases.index).groupby(cases["file"]).transform("min")
    dates = sorted(set(starts))
    files = {date: file for date, file in zip(starts, cases["file"])}
    days = [date.strftime("%Y-%m-%d") for date in dates]
    labels = days if len(set(days)) == len(days) else [f"{date:%m-%d %H:%M}" for date in dates]
    commits = [Commit(files[date], label, date) for date, label in zip(dates, labels)]
    return Order(commits, np.array([dates.index(start) for start in starts], np.int64), "run")


def _by_date(names: list[str], texts: list[str], files: Iterable[str]) -> Order:
    dates: dict[str, datetime] = {}
    for name, text, file in zip(names, texts, files):
        date = _time(file, "commit_date", text)
        if dates.setdefault(name, date) != date:
            raise InputError(
                f"{file}: commit_date of {name}: is {text}, but {dates[name].isoformat()} in another "
                "file"
            )
    return _indexed(names, dates, "have the same commit_date")


def _by_start(names: list[str], cases: pd.DataFrame) -> Order:
    table = pd.DataFrame(
        {"name": names, "start": _starts(cases), "machine": cases["machine"].values}
    )
    first = table.groupby("name")["start"].min()
    order = {name: i for i, name in enumerate(first.sort_values().index)}
    for machine, runs in table.groupby(table["machine"].map(without_build)):
        sequence = list(runs.groupby("name")["start"].min().sort_values().index)
        for earlier, later in zip(sequence, sequence[1:]):
            if order[earlier] > order[later]:
                raise InputError(
                    f"the order of the commits {later} and {earlier} is unknown: they ran in the "
                    f"reverse order on '{machine}': give --git, or 'commit_date' in the environments"
                )
    dates = {str(name): date.to_pydatetime() for name, date in first.items()}
    return _indexed(names, dates, "began at the same time")


def _indexed(names: list[str], dates: dict[str, datetime], conflict: str) -> Order:
    order = sorted(dates, key=dates.__getitem__)
    for earlier, later in zip(order, order[1:]):
        if dates[earlier] == dates[later]:
            raise InputError(
                f"the order of the commits {earlier} and {later} is unknown: they {conflict}: "
                "give --git DIR"
            )
    labels = _short(order)
    index = {name: i for i, name in enumerate(order)}
    return Order(
        [Commit(name, labels[name], dates[name]) for name in order],
        np.array([index[name] for name in names], np.int64),
    )


def _short(names: list[str]) -> dict[str, str]:
    """Hashes by their first digits, as many as identify each; other names as they are."""
    length = _SHORT
    while len({name[:length] for name in names}) < len(names):
        length += 1
    return {name: name[:length] if _HASH.fullmatch(name) else name for name in names}


def _in_repository(repository: str, names: list[str], files: pd.Series) -> Order:
    known = _log(repository)
    hashes = sorted(known)
    found: dict[tuple[str, str], str] = {}
    for name, file in dict.fromkeys(zip(names, files)):
        found[name, file] = _resolved(repository, hashes, name, file)
    order = sorted(set(found.values()), key=lambda name: known[name][0])
    labels = _short(order)
    index = {name: i for i, name in enumerate(order)}
    return Order(
        [Commit(name, labels[name], known[name][1]) for name in order],
        np.array([index[found[key]] for key in zip(names, files)], np.int64),
    )


def _log(repository: str) -> dict[str, tuple[int, datetime]]:
    """The place in the history and the date of each commit of any branch, by its hash."""
    command = ["git", "-C", repository, "log", "--all", "--topo-order", "--reverse"]
    try:
        done = subprocess.run(
            [*command, "--format=%H %cI"], capture_output=True, text=True, check=False
        )
    except OSError as error:
        raise InputError(f"--git {repository}: git cannot be run: {error.strerror}") from None
    if done.returncode:
        lines = done.stderr.strip().splitlines() or ["git failed"]
        reason = next((line for line in lines if line.startswith("fatal: ")), lines[-1])
        raise InputError(f"--git {repository}: {reason}")
    commits = [line.split() for line in done.stdout.splitlines()]
    return {name: (i, datetime.fromisoformat(date)) for i, (name, date) in enumerate(commits)}


def _resolved(repository: str, hashes: list[str], name: str, file: str) -> str:
    """The commit of the repository that a file is of."""
    if name:
        candidates = [name.lower()]
    else:  # the file name first, then the folders, the nearest first
        parts = reversed(pathlib.PurePath(file).parts)
        candidates = [word for part in parts for word in _HASH.findall(part.lower())]
    for candidate in candidates:
        i = bisect.bisect_left(hashes, candidate)
        if i < len(hashes) and hashes[i].startswith(candidate):
            if i + 1 < len(hashes) and hashes[i + 1].startswith(candidate):
                raise InputError(f"{file}: commit {candidate} is ambiguous in {repository}")
            return hashes[i]
    if candidates:
        raise InputError(f"{file}: commit {candidates[0]} is not in {repository}")
    raise InputError(
        f"{file}: names no commit: expected one in its path, such as results/1a2b3c4.json, or "
        "'commit' in its environment"
    )
