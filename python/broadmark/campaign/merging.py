"""Merges all finished cases of a campaign into one file, each once.

The program runs a recording file and does not know its seed or its other settings in the campaign;
this module adds them to the cases. Paths become relative to the campaign's folder, which may be
moved.
"""

from __future__ import annotations

import json
import os
import pathlib
import tempfile
from collections.abc import Hashable, Iterator
from typing import Any

from broadmark.campaign.attempts import AttemptLine, read_attempt, variant_of
from broadmark.campaign.folder import Folder
from broadmark.campaign.ledger import Ledger
from broadmark.campaign.plan import Recording, as_text, span_text
from broadmark.errors import InputError
from broadmark.program import call
from broadmark.report.labels import varying
from broadmark.results import SCHEMAS


def merge(folder: Folder, ledger: Ledger) -> bool:
    """Writes the results of the campaign. Returns False if there are none."""
    try:
        with tempfile.TemporaryDirectory(dir=folder.path, prefix=".merge-") as parts:
            paths = list(_write_parts(pathlib.Path(parts), folder, ledger))
            if paths:
                call("merge", *map(str, paths), "--json", str(folder.results))
    except OSError as error:
        raise InputError(f"{folder.results}: cannot be written: {error.strerror}") from None
    return bool(paths)


def _write_parts(parts: pathlib.Path, folder: Folder, ledger: Ledger) -> Iterator[pathlib.Path]:
    varying_names = _varying_settings(ledger.recordings)
    for recording in ledger.recordings:
        source = folder.file(recording).relative_to(folder.path)
        merged_variants: set[str] = set()
        for attempt in folder.attempts(recording):
            lines = []
            for line in read_attempt(attempt):
                if line.kind == "case":
                    variant = variant_of(line.content)
                    if variant in merged_variants:
                        continue
                    merged_variants.add(variant)
                    _identify(line.content, recording, variant, varying_names, source)
                lines.append(line)
            if any(line.kind == "case" for line in lines):
                path = parts / f"{len(list(parts.iterdir()))}.jsonl"
                _write_attempt(path, lines, complete=ledger.to_run == 0)
                yield path


def _varying_settings(recordings: list[Recording]) -> dict[Hashable, list[str]]:
    """The settings that vary between the recordings of a scene, by scene, besides object type, size
    and seed."""
    names = {name for recording in recordings for name in _settings(recording)}
    return varying(
        (recording.series.scene, {name: _settings(recording).get(name) for name in names})
        for recording in recordings
    )


def _settings(recording: Recording) -> dict[str, Any]:
    engine = recording.series.engine  # "": the scene has none
    return {
        **({"engine": engine} if engine else {}),
        **({"span": span_text(recording.span)} if recording.span else {}),
        **dict(recording.series.parameters),
    }


def _identify(
    case: dict[str, Any],
    recording: Recording,
    variant: str,
    varying_names: dict[Hashable, list[str]],
    source: pathlib.Path,
) -> None:
    """Adds the campaign's recording to a case; the program knew only the file."""
    settings = {name: as_text(value) for name, value in _settings(recording).items()}
    description = case["recording"]
    description["source"] = os.fspath(source)
    description["seed"] = recording.series.seed
    parts = [
        description["name"],
        description["object_type"],
        f"N{description['objects']}",
        f"F{description['frames']}",
    ]
    parts.append(f"s{description['seed']}")
    names = settings.keys() & varying_names[recording.series.scene]
    differing = {name: settings[name] for name in sorted(names)}
    if differing:
        description["swept"] = differing
        parts += [f"{name}={value}" for name, value in differing.items()]
    case["id"] = "/".join([*parts, variant])


def _write_attempt(path: pathlib.Path, lines: list[AttemptLine], complete: bool) -> None:
    cases = sum(line.kind == "case" for line in lines)
    with open(path, "w", encoding="utf-8") as file:
        for line in lines:
            if line.kind == "schema":
                file.write(json.dumps({"schema": SCHEMAS[0], "options": []}) + "\n")
            elif line.kind != "end":
                file.write(json.dumps({line.kind: line.content}) + "\n")
        file.write(json.dumps({"end": {"complete": complete, "cases": cases}}) + "\n")
