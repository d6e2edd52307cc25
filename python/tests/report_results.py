"""Synthetic results files for tests of the report."""

from __future__ import annotations

import copy
import json
import pathlib
from typing import Any

#: Seconds per frame by algorithm and number of bodies; None: a timeout.
SECONDS = {
    ("bf", 100): 1e-5,
    ("bf", 200): 4e-5,
    ("bf", 400): None,
    ("sap", 100): 2e-5,
    ("sap", 200): 4e-5,
    ("sap", 400): 8e-5,
    ("kd", 100): 3e-5,
    ("kd", 200): 2e-5,
    ("kd", 400): 4e-5,
}


def environment(cpu: str = "A processor") -> dict[str, Any]:
    return {
        "cpu": cpu,
        "logical_cores": 2,
        "isa": "avx2",
        "build_type": "Release",
        "version": "1.0.0",
        "started": "2026-01-02T03:04:05Z",
    }


def case(algorithm: str, objects: int, seconds: float | None, **changes: Any) -> dict[str, Any]:
    """A case of two repetitions of four frames; a timeout if `seconds` is None."""
    frames = 4 if seconds else 0
    ns = int((seconds or 0) * 1e9)
    content = {
        "id": f"Brownian/Cubes/N{objects}/F4/s1/{algorithm}",
        "recording": {
            "name": "Brownian",
            "object_type": "Cubes",
            "objects": objects,
            "frames": 4,
            "seed": 1,
            "hash": f"{objects:032x}",
            "source": {"objects": str(objects), "frames": "4", "seed": "1", "mass": "1"},
        },
        "algorithm": algorithm,
        "family": algorithm.upper(),
        "isa": "scalar",
        "vectorised": False,
        "threads": 1,
        "plugin": "",
        "params": {},
        "environment": 0,
        "conditions": {"check": "full", "warmup": 0, "repetitions": 2, "warnings": []},
        "status": "ok" if seconds else "timeout",
        "reason": "" if seconds else "0.6 s/frame after frame 3: over the limit of 0.5 s",
        "pairs": {"mean": 12.5, "max": 14},
        "checked": True,
        "missed": 0,
        "false": 0,
        "allowed_extra": 0,
        "invalid": 0,
        "differences": [],
        "peak_bytes": objects * 1000,
        "counters": {},
        "setup": {},
        "summary": {
            "seconds_per_frame": seconds or 0,
            "median": seconds or 0,
            "p95": seconds or 0,
            "p99": seconds or 0,
            "min": seconds or 0,
            "stddev": 0,
            "outliers": 0,
            "ci95": [seconds * 0.9, seconds * 1.1] if seconds else None,
        },
        "initialize_ns": [900, 900] if seconds else [],
        "frame_counts": {"pairs": [10, 12, 14, 14][:frames], "changed_bodies": [objects] * frames},
        "frames": {
            "update_objects": [[ns // 4] * frames] * 2 if seconds else [],
            "clean_cache": [[0] * frames] * 2 if seconds else [],
            "update_structures": [[ns // 4] * frames] * 2 if seconds else [],
            "search_overlaps": [[ns // 2] * frames] * 2 if seconds else [],
            "total": [[ns] * frames] * 2 if seconds else [],
        },
    }
    content.update(copy.deepcopy(changes))
    return content


def standard_cases() -> list[dict[str, Any]]:
    """The cases of SECONDS, a mismatch, an error and an unsupported case."""
    wrong = {"repetition": 1, "frame": 3, "missed_count": 1, "missed": [[0, 1]]}
    return [
        *(case(algorithm, objects, seconds) for (algorithm, objects), seconds in SECONDS.items()),
        case(
            "faulty", 100, 5e-6, status="mismatch", reason="frame 3: 1 missed", differences=[wrong]
        ),
        case("tracy", 100, None, status="error", reason="frame 2: crashed with SIGSEGV"),
        case("cgal", 100, None, status="unsupported", reason="this processor has no avx512"),
    ]


def write_results(
    path: pathlib.Path,
    cases: list[dict[str, Any]],
    *,
    complete: bool = True,
    cpu: str = "A processor",
) -> pathlib.Path:
    """Writes a results file as JSON Lines."""
    lines: list[dict[str, Any]] = [
        {"schema": "broadmark-results/2", "options": ["--headless", "brownian"]},
        {"environment": environment(cpu)},
        *({"case": entry} for entry in cases),
    ]
    if complete:
        lines.append({"end": {"complete": True, "cases": len(cases)}})
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    return path
