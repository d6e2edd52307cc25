"""What tells recordings and variants apart, in as few words as will do.

A variant is named as the program prints it, `kd-mt/avx2/t2/margin=0.1`, but for what all cases of
its algorithm share. A recording has a setting, `seed=2`, if there are others of its scene.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Hashable, Iterable
from typing import Any

#: Have columns of their own.
_KNOWN = ("objects", "object_type", "frames", "scene_file")


def varying(groups: Iterable[tuple[Hashable, dict[str, Any]]]) -> dict[Hashable, list[str]]:
    """Of each group of parameters the names of those that have several values."""
    values: dict[Hashable, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for group, parameters in groups:
        for name, value in parameters.items():
            values[group][name].add(str(value))
    return {
        group: [name for name, different in names.items() if len(different) > 1]
        for group, names in values.items()
    }


def variant_labels(cases: list[dict[str, Any]], machines: list[int]) -> list[str]:
    """A name for the variant of each case.

    What differs only between machines, such as the widest instruction set, is not part of it.
    """

    def traits(case: dict[str, Any]) -> dict[str, Any]:
        own = {
            " plugin": case.get("plugin") or "",
            " isa": case["isa"],
            " threads": case["threads"],
            " device": case.get("device") or "",
            " answer": case.get("answer", "pairs"),
        }
        return {**own, **case["params"]}

    names: dict[str, set[str]] = defaultdict(set)
    for machine in set(machines):
        own = [case for case, number in zip(cases, machines) if number == machine]
        for algorithm, keys in varying((case["algorithm"], traits(case)) for case in own).items():
            names[str(algorithm)].update(keys)

    def label(case: dict[str, Any]) -> str:
        told = names[str(case["algorithm"])]
        plugin = os.path.basename(case.get("plugin") or "")
        parts = [
            f"{plugin}:{case['algorithm']}" if " plugin" in told and plugin else case["algorithm"]
        ]
        if " isa" in told:
            parts.append(case["isa"])
        if " threads" in told:
            parts.append(f"t{case['threads']}")
        if " device" in told and case.get("device"):
            parts.append(case["device"])
        if " answer" in told:
            parts.append(case.get("answer", "pairs"))
        parts += [f"{name}={value}" for name, value in case["params"].items() if name in told]
        return "/".join(map(str, parts))

    return [label(case) for case in cases]


def add_settings(recordings: list[dict[str, Any]], sources: list[Any]) -> None:
    """Gives each recording its `parameters`, those that vary within its scene, and its `setting`."""
    scenes = [(one["scene"], one["object_type"]) for one in recordings]
    different = varying(
        (scene, source) for scene, source in zip(scenes, sources) if isinstance(source, dict)
    )
    for one, scene, source in zip(recordings, scenes, sources):
        keys = [key for key in different.get(scene, []) if key not in _KNOWN]
        told = {key: source[key] for key in keys if isinstance(source, dict) and key in source}
        one["parameters"] = told
        one["setting"] = ", ".join(f"{key}={value}" for key, value in told.items())
    clashing = [alike[0] for alike in _alike(recordings)]
    series = {_series(one) for one in clashing}
    frames = varying((_series(one), {"frames": one["frames"]}) for one in recordings)
    for one in [one for one in recordings if _series(one) in series and frames[_series(one)]]:
        _add(one, f"{one['frames']} frames")
    for alike in _alike(recordings):
        for one in alike:
            _add(one, f"recording {one['hash'][:6]}")


def _series(recording: dict[str, Any]) -> tuple[str, str, str]:
    """Recordings of one series differ in the number of bodies."""
    return recording["scene"], recording["object_type"], recording["setting"]


def _alike(recordings: list[dict[str, Any]]) -> list[list[dict[str, Any]]]:
    """Recordings that nothing tells apart yet."""
    groups: dict[Hashable, list[dict[str, Any]]] = defaultdict(list)
    for one in recordings:
        groups[(_series(one), one["objects"])].append(one)
    return [group for group in groups.values() if len(group) > 1]


def _add(recording: dict[str, Any], words: str) -> None:
    recording["setting"] = ", ".join(filter(None, [recording["setting"], words]))
