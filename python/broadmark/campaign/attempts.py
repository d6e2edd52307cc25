"""Attempts: results of single calls of the program, in JSON Lines; `N.part.jsonl` until a call has come
to its end, then `N.jsonl`.

Whatever ended a call, its finished cases count. These do not, and are run again: a case that was
interrupted between two repetitions, and one whose process was ended in the course of ending
everything, which the program cannot tell from an algorithm that crashed.
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

PART = ".part.jsonl"

KILLED = re.compile(r"\bSIG(KILL|TERM)\b")


@dataclass(frozen=True)
class Line:
    """A line of an attempt."""

    kind: str  #: schema, environment, case, end
    content: Any


def whole(path: pathlib.Path) -> pathlib.Path:
    """The name of an attempt whose call has come to its end."""
    return path.with_name(path.name.removesuffix(PART) + ".jsonl")


def parsed(text: str) -> Line | None:
    """A line; None for one that was not written to its end."""
    if not text.endswith("\n"):
        return None
    try:
        kind, content = next(iter(json.loads(text).items()))
    except (ValueError, AttributeError, StopIteration, RecursionError):
        return None
    return Line(kind, content)


def read_attempt(path: pathlib.Path) -> list[Line]:
    """What an attempt has kept: its lines, but only those of cases that are finished."""
    ended = not path.name.endswith(PART)
    return [
        line
        for line in _sound_lines(path)
        if line.kind != "case" or is_finished(line.content, ended)
    ]


def _sound_lines(path: pathlib.Path) -> Iterator[Line]:
    with open(path, encoding="utf-8", errors="replace") as file:
        for text in file:
            line = parsed(text)
            if line is None:
                return
            yield line


def is_finished(case: dict[str, Any], ended: bool) -> bool:
    """Whether a case need not be run again. `ended`: its call came to its end."""
    try:
        killed = case["status"] == "error" and KILLED.search(case["reason"])
        return is_complete(case) and (ended or not killed)
    except (KeyError, TypeError, AttributeError):  # somebody else has written this
        return False


def variant_of(case: dict[str, Any]) -> str:
    """A case's id without what it says of the recording."""
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
    """The cases of an attempt while it is written."""

    def __init__(self, path: pathlib.Path) -> None:
        self._path = path
        self._read = 0

    def new_cases(self) -> Iterator[dict[str, Any]]:
        """Finished cases that were written since the last call."""
        with open(self._path, encoding="utf-8") as file:
            file.seek(self._read)
            while (line := parsed(file.readline())) is not None:
                self._read = file.tell()
                if line.kind == "case" and is_finished(line.content, ended=True):
                    yield line.content
