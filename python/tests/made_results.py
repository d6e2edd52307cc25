"""Results files made of given times, for tests of what is drawn of them."""

from __future__ import annotations

import json
import pathlib
from typing import Any

from broadmark.paper.algorithms import table2

FAMILIES = {"b3": "GPU", "gpu": "GPU", "none": "self-check"}

GPU = "A graphics card (Maker, GPU, 10 units, 6.0 GiB, driver 1)"


def environment(cpu: str = "A processor", device: str = GPU) -> dict[str, Any]:
    return {
        **{"cpu": cpu, "logical_cores": 8, "isa": "avx2", "started": "2026-01-02T03:04:05Z"},
        "compute_devices": [device],
    }


def case(
    scene: str, objects: int, algorithm: str, seconds: float = 0.0, **others: Any
) -> dict[str, Any]:
    """A case with one repetition of one frame; `others` replace or add keys, and `limit` and
    `object_type` what their names say."""
    object_type = others.pop("object_type", "Cubes")
    limit = others.pop("limit", 0.5)
    threads = others.get("threads", 4 if algorithm.endswith("-mt") else 1)
    nanoseconds = [[round(seconds * 1e9)]]
    made = {
        "id": f"{scene}/{object_type}/N{objects}/F1/s1/{algorithm}/t{threads}",
        "recording": {
            **{"name": scene, "object_type": object_type, "objects": objects, "frames": 1},
            **{"seed": 1, "hash": "0" * 32, "source": {}},
        },
        **{"algorithm": algorithm, "family": FAMILIES.get(algorithm.split("-")[0], "Any")},
        **{"isa": "scalar", "threads": threads, "params": {}, "status": "ok", "reason": ""},
        **{"checked": True, "missed": 0, "false": 0, "allowed_extra": 0, "invalid": 0},
        **{"pairs": {"mean": 100, "max": 100}, "peak_bytes": 4096 * objects},
        "conditions": {"repetitions": 1, "frame_limit_seconds": limit},
        "summary": {"seconds_per_frame": seconds},
        "initialize_ns": [1],
        "frame_counts": {"pairs": [100], "changed_bodies": [objects]},
        "frames": {
            "total": nanoseconds,
            "search_overlaps": nanoseconds,
            **{name: [[0]] for name in ("update_objects", "clean_cache", "update_structures")},
        },
    }
    return {**made, **others}


def paper_cases() -> list[dict[str, Any]]:
    """Table 2 of the paper as cases."""
    return [
        case(scene, n, id_, seconds, checked=False) for (scene, n, id_), seconds in table2().items()
    ]


def write(path: pathlib.Path, cases: list[dict[str, Any]], **about: str) -> pathlib.Path:
    """A results file; `about` is of its environment."""
    document = {
        **{"schema": "broadmark-results/2", "options": [], "environments": [environment(**about)]},
        **{"complete": True, "cases": cases},
    }
    path.write_text(json.dumps(document))
    return path
