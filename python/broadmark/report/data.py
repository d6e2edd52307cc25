"""The data of the page: results as plain values, written as JSON.

Cases are stored by columns. A column of texts is dictionary-encoded as a list of distinct texts and a
list of indices: ten thousand cases have few distinct algorithms, reasons or commands.
"""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterable
from typing import Any

import numpy as np

from broadmark.palette import look_of
from broadmark.report import labels, rerun
from broadmark.results import COLUMNS, Results, commit_name, is_unknown, without_build

#: The columns of cases, copied from `Results.cases`; the others belong to the recording.
CASE_COLUMNS = [column for column in COLUMNS if not column["path"].startswith("recording/")]
NUMBERS = [column["key"] for column in CASE_COLUMNS if column["kind"] == "number"]
TEXTS = [column["key"] for column in CASE_COLUMNS if column["kind"] == "text"] + [
    "warnings",
    "file",
    "started",
]

#: The least number of frames for times at the end beside those at the start.
MIN_AGEING_FRAMES = 100
#: The least number of frames with a 99.9th percentile.
MIN_PERMILLE_FRAMES = 1000

#: The facts of a machine: title and key in the environment.
FACTS = [
    ("Processor", "cpu"),
    ("Cores", "logical_cores"),
    ("Widest instruction set", "isa"),
    ("Caches", "caches"),
    ("Memory", "memory_bytes"),
    ("Compute devices", "compute_devices"),
    ("System", "os"),
    ("Governor", "governor"),
    ("Compiler", "compiler"),
    ("Compiler flags", "compiler_flags"),
    ("Build type", "build_type"),
    ("Program version", "version"),
    ("Commit", "commit"),
    ("Load at the start", "load_average"),
]


def page_data(results: Results, *, program_page: str = "") -> dict[str, Any]:
    """The data of the page, without times by frame and pictures.

    Accepts any text of a results file. `program_page`: where browsers find the program; "": no links.
    """
    cases, details = results.cases, results.details
    machines = [int(number) for number in cases.get("environment", [])]
    files = [str(file) for file in cases.get("file", [])]
    recordings, recording_indices = _recordings(details, files)
    variants = labels.variant_labels(details, machines)
    columns: dict[str, Any] = {name: _numbers(cases[name]) for name in NUMBERS if name in cases}
    columns |= {name: _texts(cases[name]) for name in TEXTS if name in cases}
    columns["machine"] = machines
    columns["recording"] = recording_indices
    columns["variant"] = _texts(variants)
    columns["isa"] = _texts(case["isa"] if case.get("vectorised") else "" for case in details)
    columns["checked"] = [int(bool(case["checked"])) for case in details]
    columns["complete"] = [int(complete) for complete in cases.get("complete", [])]
    columns["standard_error"] = _numbers(map(_standard_error, details))
    columns["load"] = _numbers(case.get("conditions", {}).get("load_average") for case in details)
    columns |= _worst_frames(details)
    columns["frames_run"] = [max(map(len, case["frames"]["total"]), default=0) for case in details]
    columns["counted"] = _texts(map(_counted, details))
    columns["condition_command"] = _texts(
        shlex.join(rerun.condition_words(case)) for case in details
    )
    if program_page:
        columns["address"] = _texts(map(rerun.address, details))
    for part, words in (("variant", rerun.variant_words), ("again", rerun.again_words)):
        columns[f"{part}_command"] = _texts(
            shlex.join(words(case, file)) for case, file in zip(details, files)
        )
    return {
        "machines": [_machine(row) for row in results.environments.to_dict("records")],
        "runs": [_run(row) for row in results.files.to_dict("records")],
        "recordings": recordings,
        "fields": COLUMNS,
        "columns": columns,
        "looks": {name: look_of(name) for name in map(str, cases.get("algorithm", []))},
        "parameters": _varying_parameters(details),
        "wrong_frames": _wrong_frames(details),
        "program_page": program_page,
    }


def _recordings(
    details: list[dict[str, Any]], files: list[str]
) -> tuple[list[dict[str, Any]], list[int]]:
    """The distinct recordings, and the index of each case's recording."""
    recordings: list[dict[str, Any]] = []
    sources: list[Any] = []
    known: dict[Any, int] = {}
    recording_indices = []
    for case, file in zip(details, files):
        recording = case["recording"]
        source = "" if recording["hash"] else str(recording["source"])
        key = (
            recording["hash"],
            source,
            recording["name"],
            recording["object_type"],
            recording["objects"],
            recording["frames"],
        )
        if key not in known:
            known[key] = len(recordings)
            words = rerun.source_words(recording, file)
            sources.append(recording["source"])
            recordings.append(
                {
                    "scene": str(recording["name"]),
                    "object_type": str(recording["object_type"]),
                    "objects": int(recording["objects"]),
                    "frames": int(recording["frames"]),
                    "hash": str(recording["hash"]),
                    "file": (
                        "" if isinstance(recording["source"], dict) else str(recording["source"])
                    ),
                    "words": words,
                    "command": shlex.join(words),
                }
            )
        recording_indices.append(known[key])
    labels.add_settings(recordings, sources)
    return recordings, recording_indices


def _standard_error(case: dict[str, Any]) -> float | None:
    """Of the mean over the repetitions, relative to it; None for a single one."""
    means = [float(np.mean(times)) for times in case["frames"]["total"] if len(times)]
    if len(means) < 2 or not all(means):
        return None
    return float(np.std(means, ddof=1) / math.sqrt(len(means)) / np.mean(means))


def _worst_frames(details: list[dict[str, Any]]) -> dict[str, list[Any]]:
    """Columns: the slowest frame's time and number, from 1, the 99.9th percentile, and the median of
    the last tenth of the frames over that of the first; None without frames, or too few."""
    worst: list[Any] = []
    numbers: list[Any] = []
    nearly_worst: list[Any] = []
    ageing: list[Any] = []
    for case in details:
        repetitions = [times for times in case["frames"]["total"] if len(times)]
        count = min(map(len, repetitions), default=0)
        times = (
            np.min([np.asarray(r[:count]) for r in repetitions], axis=0) if count else np.empty(0)
        )
        worst.append(float(times.max()) / 1e9 if count else None)
        numbers.append(int(times.argmax()) + 1 if count else None)
        many = count >= MIN_PERMILLE_FRAMES
        nearly_worst.append(float(np.percentile(times, 99.9)) / 1e9 if many else None)
        tenth = count // 10
        early = float(np.median(times[:tenth])) if count >= MIN_AGEING_FRAMES else 0.0
        ageing.append(float(np.median(times[-tenth:])) / early if early else None)
    columns = {
        "worst_seconds": worst,
        "worst_frame": numbers,
        "p999_seconds": nearly_worst,
        "late_over_early": ageing,
        "memory_late_over_early": [_late_over_early(case, "private_bytes") for case in details],
        "tests_late_over_early": [_late_over_early(case, "test") for case in details],
    }
    return {name: _numbers(values) for name, values in columns.items()}


def _late_over_early(case: dict[str, Any], count: str) -> float | None:
    """The mean of the first count whose name contains `count` in the last tenth of the frames over
    that in the first tenth."""
    early, late = (case.get("ageing", {}).get(when, {}) for when in ("early", "late"))
    name = next((name for name in early if count in name), None)
    return late.get(name, 0) / early[name] if name and early[name] else None


def _counted(case: dict[str, Any]) -> str:
    """The algorithm's counters, a line each."""
    counters = {**case.get("counters", {}), **case.get("setup", {})}
    return "\n".join(f"{name}: {_rounded(value)}" for name, value in counters.items())


def _varying_parameters(details: list[dict[str, Any]]) -> dict[str, Any]:
    """The parameters with several values for an algorithm, as columns; "": not set."""
    groups = ((case["algorithm"], case["params"]) for case in details)
    names = sorted({name for names in labels.varying(groups).values() for name in names})
    return {name: _texts(case["params"].get(name, "") for case in details) for name in names}


def _wrong_frames(details: list[dict[str, Any]]) -> dict[int, list[int]]:
    """The first frames with wrong answers, by case."""
    frames = {
        i: sorted({difference["frame"] for difference in case["differences"]})
        for i, case in enumerate(details)
    }
    return {i: numbers[:100] for i, numbers in frames.items() if numbers}


def _machine(environment: dict[str, Any]) -> dict[str, Any]:
    facts = []
    for title, key in FACTS:
        value = commit_name(environment) if key == "commit" else environment.get(key)
        if key == "memory_bytes" and isinstance(value, (int, float)) and value > 0:
            value = f"{value / 2**30:.1f} GiB"
        if isinstance(value, list):
            value = ", ".join(map(str, value))
        if value is not None and value == value and str(value).strip():
            facts.append([title, str(_rounded(value)).strip()])
    name = environment["machine"]
    return {"name": name, "computer": without_build(name), "facts": facts}


def _run(row: dict[str, Any]) -> dict[str, Any]:
    return {
        "file": row["file"],
        "command": shlex.join(row["command"]),
        "started": row["started"],
        "complete": bool(row["complete"]),
    }


def _texts(values: Iterable[Any]) -> dict[str, Any]:
    indices: dict[str, int] = {}
    texts = ("" if is_unknown(value) else str(value) for value in values)
    codes = [indices.setdefault(text, len(indices)) for text in texts]
    return {"texts": list(indices), "codes": codes}


def _numbers(values: Iterable[Any]) -> list[Any]:
    return [_rounded(value) for value in values]


def _rounded(value: Any) -> Any:
    """The value with five significant digits, more than the page shows; None if unknown."""
    if not isinstance(value, (int, float)):
        return None if value is None else str(value)
    if not math.isfinite(value):
        return None
    if value == int(value):
        return int(value)
    return float(f"{value:.5g}")
