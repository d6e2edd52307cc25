"""One file of all finished cases of a campaign: each once, and with what the attempts do not know.

The program is given a file and knows neither its seed nor what else tells it from the campaign's
other recordings; both become part of a case here. Paths become relative to the campaign's folder,
which may be moved.
"""

from __future__ import annotations

import json
import os
import pathlib
import tempfile
from collections.abc import Iterator
from typing import Any

from broadmark.campaign.attempts import Line, read_attempt, variant_of
from broadmark.campaign.folder import Folder
from broadmark.campaign.ledger import Ledger
from broadmark.campaign.plan import Recording, as_text
from broadmark.errors import InputError
from broadmark.program import call
from broadmark.results import SCHEMAS


def merge(folder: Folder, ledger: Ledger) -> bool:
    """Writes the results of the campaign. False if there are none."""
    try:
        with tempfile.TemporaryDirectory(dir=folder.path, prefix=".merge-") as parts:
            paths = list(_write_parts(pathlib.Path(parts), folder, ledger))
            if paths:
                call("merge", *map(str, paths), "--json", str(folder.results))
    except OSError as error:
        raise InputError(f"{folder.results}: cannot be written: {error.strerror}") from None
    return bool(paths)


def _write_parts(parts: pathlib.Path, folder: Folder, ledger: Ledger) -> Iterator[pathlib.Path]:
    swept = _swept(ledger.recordings)
    for recording in ledger.recordings:
        source = folder.file(recording).relative_to(folder.path)
        seen: set[str] = set()
        for attempt in folder.attempts(recording):
            lines = []
            for line in read_attempt(attempt):
                if line.kind == "case":
                    variant = variant_of(line.content)
                    if variant in seen:
                        continue
                    seen.add(variant)
                    _identify(line.content, recording, variant, swept, source)
                lines.append(line)
            if any(line.kind == "case" for line in lines):
                path = parts / f"{len(list(parts.iterdir()))}.jsonl"
                _write(path, lines, complete=ledger.to_run == 0)
                yield path


def _swept(recordings: list[Recording]) -> set[str]:
    """What the campaign's recordings differ in, beside scene, object type, size and seed."""
    values: dict[str, set[Any]] = {}
    for recording in recordings:
        for name, value in _settings(recording).items():
            values.setdefault(name, set()).add(value)
    return {
        name
        for name, several in values.items()
        if len(several) > 1 or any(name not in _settings(one) for one in recordings)
    }


def _settings(recording: Recording) -> dict[str, Any]:
    return {"engine": recording.series.engine, **dict(recording.series.parameters)}


def _identify(
    case: dict[str, Any],
    recording: Recording,
    variant: str,
    swept: set[str],
    source: pathlib.Path,
) -> None:
    """Says which recording of the campaign a case ran on: the program only knew a file."""
    settings = {name: as_text(value) for name, value in _settings(recording).items()}
    told = case["recording"]
    told["source"] = os.fspath(source)
    told["seed"] = recording.series.seed
    parts = [told["name"], told["object_type"], f"N{told['objects']}", f"F{told['frames']}"]
    parts.append(f"s{told['seed']}")
    differing = {name: settings[name] for name in sorted(swept & settings.keys())}
    if differing:
        told["swept"] = differing
        parts += [f"{name}={value}" for name, value in differing.items()]
    case["id"] = "/".join([*parts, variant])


def _write(path: pathlib.Path, lines: list[Line], complete: bool) -> None:
    cases = sum(line.kind == "case" for line in lines)
    with open(path, "w", encoding="utf-8") as file:
        for line in lines:
            if line.kind == "schema":
                file.write(json.dumps({"schema": SCHEMAS[0], "options": []}) + "\n")
            elif line.kind != "end":
                file.write(json.dumps({line.kind: line.content}) + "\n")
        file.write(json.dumps({"end": {"complete": complete, "cases": cases}}) + "\n")
