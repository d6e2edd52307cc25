"""Attempts: the results of a call of the program in JSON Lines. The file is `N.part.jsonl` while the
call runs, then `N.jsonl`.

Finished cases of an interrupted call count. Two kinds of cases do not and are run again: a case
interrupted between two repetitions, and a case whose process was killed together with the program,
which looks like a crash of the algorithm.
"""

from __future__ import annotations

import json
import pathlib
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from broadmark.campaign.ledger import Outcome
from broadmark.results import is_complete

PARTIAL_SUFFIX = ".part.jsonl"

KILLED = re.compile(r"\bSIG(KILL|TERM)\b")


@dataclass(frozen=True)
class AttemptLine:
    """A line of an attempt."""

    kind: str  #: schema, environment, case, end
    content: Any


def completed_path(path: pathlib.Path) -> pathlib.Path:
    """The path of an attempt after its call has ended."""
    return path.with_name(path.name.removesuffix(PARTIAL_SUFFIX) + ".jsonl")


def parse_line(text: str) -> AttemptLine | None:
    """The parsed line; None if it is incomplete or invalid."""
    if not text.endswith("\n"):
        return None
    try:
        kind, content = next(iter(json.loads(text).items()))
    except (ValueError, AttributeError, StopIteration, RecursionError):
        return None
    return AttemptLine(kind, content)


def read_attempt(path: pathlib.Path) -> list[AttemptLine]:
    """The lines of an attempt, without unfinished cases."""
    ended = not path.name.endswith(PARTIAL_SUFFIX)
    return [
        line
        for line in _valid_lines(path)
        if line.kind != "case" or is_finished(line.content, ended)
    ]


def _valid_lines(path: pathlib.Path) -> Iterator[AttemptLine]:
    with open(path, encoding="utf-8", errors="replace") as file:
        for text in file:
            line = parse_line(text)
            if line is None:
                return
            yield line


def is_finished(case: dict[str, Any], ended: bool) -> bool:
    """Whether a case need not be run again. `ended`: its call ended normally."""
    try:
        killed = case["status"] == "error" and KILLED.search(case["reason"])
        return is_complete(case) and (ended or not killed)
    except (KeyError, TypeError, AttributeError):  # written by another program
        return False


def variant_of(case: dict[str, Any]) -> str:
    """A case's id without the recording's part."""
    recording = case["recording"]
    prefix = (
        f"{recording['name']}/{recording['object_type']}"
        f"/N{recording['objects']}/F{recording['frames']}/"
    )
    return str(case["id"]).removeprefix(prefix)


def outcome_of(case: dict[str, Any]) -> Outcome:
    seconds = case["summary"]["seconds_per_frame"] if case["frames"]["total"] else None
    return Outcome(case["status"], seconds)


class Tail:
    """Reads the cases of an attempt while the program writes it."""

    def __init__(self, path: pathlib.Path) -> None:
        self._path = path
        self._offset = 0

    def new_cases(self) -> Iterator[dict[str, Any]]:
        """The finished cases written since the previous call."""
        with open(self._path, encoding="utf-8") as file:
            file.seek(self._offset)
            while (line := parse_line(file.readline())) is not None:
                self._offset = file.tell()
                if line.kind == "case" and is_finished(line.content, ended=True):
                    yield line.content
