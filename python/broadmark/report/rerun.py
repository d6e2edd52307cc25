"""Commands that run a case again, quoted for the shell.

A command has three parts that many cases share: the source (`source_words`), the variant
(`variant_words`) and the measuring conditions (`condition_words`).
"""

from __future__ import annotations

import os
import pathlib
import urllib.parse
from typing import Any

from broadmark.program import BOXES, as_options

#: Parameters of a simulation that have their own options; others are passed with --param.
OPTIONS = ("objects", "object_type", "frames", "seed", "density", "engine")


def stated_path(results_file: str, stated: str) -> str:
    """The path of a file named in a results file: as stated, or relative to the results file."""
    relative = pathlib.Path(results_file).parent / stated
    return str(relative) if not pathlib.Path(stated).exists() and relative.exists() else stated


def source_words(recording: dict[str, Any], results_file: str) -> list[str]:
    """The recording file of a case, or its simulation with all parameters; none for BOXES."""
    source = recording["source"]
    if source == BOXES:
        return []
    if not isinstance(source, dict):
        return [stated_path(results_file, str(source))]
    parameters = dict(source)
    scene = parameters.pop("scene_file", None)
    name = stated_path(results_file, scene) if scene else str(recording["name"]).lower()
    options = {key: parameters.pop(key) for key in OPTIONS if key in parameters}
    return [name, *as_options(**options), *as_options(param=parameters)]


def _plugin(case: dict[str, Any], results_file: str) -> str | None:
    """The file of a case's plug-in, as stated_path(); it may be a log of pairs."""
    plugin = str(case.get("plugin") or "")
    prefix = "pairs:" if plugin.startswith("pairs:") else ""
    stated = plugin.removeprefix(prefix)
    return prefix + stated_path(results_file, stated) if stated else None


def variant_words(case: dict[str, Any], results_file: str) -> list[str]:
    """The options for algorithm, threads, instruction set, answer and parameters of a case."""
    algorithm = case["algorithm"]
    answer = case.get("answer", "pairs")
    return as_options(
        plugin=_plugin(case, results_file),
        algorithm=algorithm,
        threads=case["threads"],
        isa=case["isa"] if case.get("vectorised") else None,
        device=case.get("device") or None,
        answer="events" if answer == "events" else None,
        queries=answer if ":" in answer else None,
        param={f"{algorithm}:{name}": value for name, value in case["params"].items()},
    )


def condition_words(case: dict[str, Any]) -> list[str]:
    """The options for check, repetitions and limits of a case."""
    conditions = case.get("conditions", {})
    in_process = conditions.get("in_process", False)
    return as_options(
        check=conditions.get("check"),
        warmup=conditions.get("warmup"),
        repetitions=conditions.get("repetitions"),
        time_limit=conditions.get("frame_limit_seconds"),
        hard_limit=None if in_process else conditions.get("call_limit_seconds"),
        in_process=in_process,
        pin=conditions.get("pinned", False),
    )


def address(case: dict[str, Any]) -> str:
    """The part after # of an address that opens a case in a browser (docs/browser.md), at its first
    wrong frame; "" if it needs a file, a plug-in or a device."""
    source = case["recording"]["source"]
    needs_files = not isinstance(source, dict) or "scene_file" in source or "input" in source
    if needs_files or case.get("plugin") or case.get("device") or case.get("family") == "Python":
        return ""
    algorithm = case["algorithm"]
    words = source_words(case["recording"], "") + as_options(
        algorithm=algorithm,
        param={f"{algorithm}:{name}": value for name, value in case["params"].items()},
        frame=min((difference["frame"] for difference in case["differences"]), default=None),
    )
    return "&".join(urllib.parse.quote(word, safe="-_.~=,:/") for word in words)


def again_words(case: dict[str, Any], results_file: str) -> list[str]:
    """Arguments that run a case again from its results file, which verifies the recording; none without
    a file."""
    if case["recording"]["source"] == BOXES or not os.path.exists(results_file):
        return []
    plugin = as_options(plugin=_plugin(case, results_file))
    return [results_file, "--case", str(case["id"]), *plugin]
