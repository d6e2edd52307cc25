"""What the page holds: results as plain values, written as JSON.

A case is a row over columns. A column of texts is a list of the different ones and their numbers:
ten thousand cases have few different algorithms, reasons or commands.
"""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterable
from typing import Any

from broadmark.palette import curves_of
from broadmark.report import labels, rerun
from broadmark.results import COLUMNS, Results

#: Columns that the page takes as they are in `Results.cases`; others are of the recording.
OF_CASES = [column for column in COLUMNS if not column["path"].startswith("recording/")]
NUMBERS = [column["key"] for column in OF_CASES if column["kind"] == "number"]
TEXTS = [column["key"] for column in OF_CASES if column["kind"] == "text"] + ["warnings", "file"]

#: The machine's facts: title and key of its environment.
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
    ("Load when it began", "load_average"),
]


def page_data(results: Results) -> dict[str, Any]:
    """The data of the page, but for times frame by frame and pictures.

    Raises no error for odd texts: whatever stands in a results file is only text here.
    """
    cases, details = results.cases, results.details
    machines = [int(number) for number in cases.get("environment", [])]
    files = [str(file) for file in cases.get("file", [])]
    recordings, of_case = _recordings(details, files)
    variants = labels.variant_labels(details, machines)
    columns: dict[str, Any] = {name: _numbers(cases[name]) for name in NUMBERS if name in cases}
    columns |= {name: _texts(cases[name]) for name in TEXTS if name in cases}
    columns["machine"] = machines
    columns["recording"] = of_case
    columns["variant"] = _texts(variants)
    columns["isa"] = _texts(case["isa"] if case.get("vectorised") else "" for case in details)
    columns["checked"] = [int(bool(case["checked"])) for case in details]
    columns["complete"] = [int(one) for one in cases.get("complete", [])]
    columns["frames_run"] = [max(map(len, case["frames"]["total"]), default=0) for case in details]
    columns["counted"] = _texts(map(_counted, details))
    for part, words in (("variant", rerun.variant_words), ("condition", rerun.condition_words)):
        columns[f"{part}_command"] = _texts(shlex.join(words(case)) for case in details)
    columns["again_command"] = _texts(
        shlex.join(rerun.again_words(case, file)) for case, file in zip(details, files)
    )
    return {
        "machines": [_machine(row) for row in results.environments.to_dict("records")],
        "runs": [_run(row) for row in results.files.to_dict("records")],
        "recordings": recordings,
        "fields": COLUMNS,
        "columns": columns,
        "curves": curves_of(map(str, cases.get("family", []))),
        "parameters": _varying_parameters(details),
        "wrong_frames": _wrong_frames(details),
    }


def _recordings(
    details: list[dict[str, Any]], files: list[str]
) -> tuple[list[dict[str, Any]], list[int]]:
    """The different recordings, and the number of each case's."""
    recordings: list[dict[str, Any]] = []
    sources: list[Any] = []
    known: dict[Any, int] = {}
    of_case = []
    for case, file in zip(details, files):
        one = case["recording"]
        source = "" if one["hash"] else str(one["source"])
        key = (one["hash"], source, one["name"], one["object_type"], one["objects"], one["frames"])
        if key not in known:
            known[key] = len(recordings)
            words = rerun.source_words(one, file)
            sources.append(one["source"])
            recordings.append(
                {
                    "scene": str(one["name"]),
                    "object_type": str(one["object_type"]),
                    "objects": int(one["objects"]),
                    "frames": int(one["frames"]),
                    "hash": str(one["hash"]),
                    "file": "" if isinstance(one["source"], dict) else str(one["source"]),
                    "words": words,
                    "command": shlex.join(words),
                }
            )
        of_case.append(known[key])
    labels.add_settings(recordings, sources)
    return recordings, of_case


def _counted(case: dict[str, Any]) -> str:
    """What the algorithm counted, a line each."""
    both = {**case.get("counters", {}), **case.get("setup", {})}
    return "\n".join(f"{name}: {_rounded(value)}" for name, value in both.items())


def _varying_parameters(details: list[dict[str, Any]]) -> dict[str, Any]:
    """Parameters of which an algorithm has several values, as columns; "": it has none."""
    groups = ((case["algorithm"], case["params"]) for case in details)
    names = sorted({name for names in labels.varying(groups).values() for name in names})
    return {name: _texts(case["params"].get(name, "") for case in details) for name in names}


def _wrong_frames(details: list[dict[str, Any]]) -> dict[int, list[int]]:
    """The first frames with a wrong answer of each case that has any."""
    frames = {
        i: sorted({d["frame"] for d in case["differences"]}) for i, case in enumerate(details)
    }
    return {i: numbers[:100] for i, numbers in frames.items() if numbers}


def _machine(environment: dict[str, Any]) -> dict[str, Any]:
    facts = []
    for title, key in FACTS:
        value = environment.get(key)
        if key == "memory_bytes" and isinstance(value, (int, float)) and value > 0:
            value = f"{value / 2**30:.1f} GiB"
        if isinstance(value, list):
            value = ", ".join(map(str, value))
        if value is not None and value == value and str(value).strip():
            facts.append([title, str(_rounded(value)).strip()])
    return {"name": environment["machine"], "facts": facts}


def _run(row: dict[str, Any]) -> dict[str, Any]:
    return {
        "file": row["file"],
        "command": shlex.join(row["command"]),
        "started": row["started"],
        "complete": bool(row["complete"]),
    }


def _texts(values: Iterable[Any]) -> dict[str, Any]:
    different: dict[str, int] = {}
    codes = [different.setdefault(str(value), len(different)) for value in values]
    return {"texts": list(different), "codes": codes}


def _numbers(values: Iterable[Any]) -> list[Any]:
    return [_rounded(value) for value in values]


def _rounded(value: Any) -> Any:
    """Five digits are more than a page shows; what is not known is None."""
    if not isinstance(value, (int, float)):
        return None if value is None else str(value)
    if not math.isfinite(value):
        return None
    if value == int(value):
        return int(value)
    return float(f"{value:.5g}")
