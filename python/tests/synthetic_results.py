"""Synthetic results files for tests of tables, claims and plots."""

from __future__ import annotations

import json
import pathlib
from typing import Any

from broadmark.paper.algorithms import BY_ID, table2

FAMILIES = {"b3": "GPU", "gpu": "GPU", "none": "self-check"}

GPU = "A graphics card (Maker, GPU, 10 units, 6.0 GiB, driver 1)"
CPU = "A processor as a device (Maker, CPU, 2 units, 6.0 GiB, driver 1)"


def case(
    scene: str, objects: int, algorithm: str, seconds: float = 0.0, **others: Any
) -> dict[str, Any]:
    """A case with a repetition of one frame. `others` replace or add keys, besides `object_type`, the
    parameters `swept` between recordings, the time limit `limit` and the requested repetitions
    `asked`."""
    object_type = others.pop("object_type", "Cubes")
    conditions = {
        "repetitions": others.pop("asked", 1),
        "frame_limit_seconds": others.pop("limit", 0.5),
    }
    threads = others.pop("threads", 4 if algorithm.endswith("-mt") else 1)
    isa = others.pop("isa", "scalar")
    nanoseconds = [[round(seconds * 1e9)]]
    recording = f"{scene}/{object_type}/N{objects}/F1/s1"
    swept = others.pop("swept", {})
    variant = [algorithm, f"t{threads}", isa]
    variant += [f"{name}={value}" for name, value in others.get("params", {}).items()]
    content: dict[str, Any] = {
        "id": "/".join([recording, *map("=".join, swept.items()), *variant]),
        "recording": {
            "name": scene,
            "object_type": object_type,
            "objects": objects,
            "frames": 1,
            "seed": 1,
            "hash": "0" * 32,
            "source": {},
            "swept": swept,
        },
        "algorithm": algorithm,
        "family": FAMILIES.get(algorithm.split("-")[0], "Any"),
        "isa": isa,
        "threads": threads,
        "params": {},
        "environment": 0,
        "conditions": conditions,
        "status": "ok",
        "reason": "",
        "pairs": {"mean": 105, "max": 105},
        "checked": True,
        "missed": 0,
        "false": 0,
        "allowed_extra": 0,
        "invalid": 0,
        "peak_bytes": 4096 * objects,
        "summary": {"seconds_per_frame": seconds},
        "initialize_ns": [1],
        "frame_counts": {"pairs": [105], "changed_bodies": [objects]},
        "frames": {
            "update_objects": [[0]],
            "clean_cache": [[0]],
            "update_structures": [[0]],
            "search_overlaps": nanoseconds,
            "total": nanoseconds,
        },
    }
    return {**content, **others}


def paper_case(
    scene: str, objects: int, algorithm: str, seconds: float = 0.0, **others: Any
) -> dict[str, Any]:
    """A case with the settings of the paper's original."""
    settings = BY_ID[algorithm].settings
    params = dict(setting.split("=") for setting in settings.split())
    return case(scene, objects, algorithm, seconds, params=params, **others)


def paper_cases() -> list[dict[str, Any]]:
    """The paper's Table 2 as cases."""
    return [
        paper_case(scene, n, id_, seconds, checked=False)
        for (scene, n, id_), seconds in table2().items()
    ]


def write(
    path: pathlib.Path, cases: list[dict[str, Any]], *, cpu: str = "A processor", device: str = GPU
) -> pathlib.Path:
    """Writes a results file of one machine."""
    environment = {
        "cpu": cpu,
        "logical_cores": 8,
        "started": "2026-01-02T03:04:05Z",
        "compute_devices": [device],
    }
    document = {
        "schema": "broadmark-results/2",
        "options": [],
        "environments": [environment],
        "complete": True,
        "cases": cases,
    }
    path.write_text(json.dumps(document))
    return path
