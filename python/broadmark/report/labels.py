"""Short unique labels of recordings and variants.

A variant's label is its name in the program, `kd-mt/avx2/t2/margin=0.1`, without the parts that all
cases of its algorithm share. A recording has a setting, `seed=2`, if its scene has several recordings.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Hashable, Iterable
from typing import Any

#: Parameters with their own columns.
_COLUMN_PARAMETERS = ("objects", "object_type", "frames", "scene_file")


def varying(groups: Iterable[tuple[Hashable, dict[str, Any]]]) -> dict[Hashable, list[str]]:
    """The names of the parameters with several values, by group."""
    values: dict[Hashable, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for group, parameters in groups:
        own = values[group]  # also without parameters
        for name, value in parameters.items():
            own[name].add(str(value))
    return {
        group: [name for name, distinct in names.items() if len(distinct) > 1]
        for group, names in values.items()
    }


def variant_labels(cases: list[dict[str, Any]], machines: list[int]) -> list[str]:
    """The label of each case's variant.

    Traits that differ only between machines, such as the widest instruction set, are omitted.
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
        varying_traits = names[str(case["algorithm"])]
        plugin = os.path.basename(case.get("plugin") or "")
        parts = [
            (
                f"{plugin}:{case['algorithm']}"
                if " plugin" in varying_traits and plugin
                else case["algorithm"]
            )
        ]
        if " isa" in varying_traits:
            parts.append(case["isa"])
        if " threads" in varying_traits:
            parts.append(f"t{case['threads']}")
        if " device" in varying_traits and case.get("device"):
            parts.append(case["device"])
        if " answer" in varying_traits:
            parts.append(case.get("answer", "pairs"))
        parts += [
            f"{name}={value}" for name, value in case["params"].items() if name in varying_traits
        ]
        return "/".join(map(str, parts))

    return [label(case) for case in cases]


def add_settings(recordings: list[dict[str, Any]], sources: list[Any]) -> None:
    """Adds `parameters`, those that vary within the scene, and `setting` to each recording."""
    scenes = [(recording["scene"], recording["object_type"]) for recording in recordings]
    varying_names = varying(
        (scene, source) for scene, source in zip(scenes, sources) if isinstance(source, dict)
    )
    for recording, scene, source in zip(recordings, scenes, sources):
        keys = [key for key in varying_names.get(scene, []) if key not in _COLUMN_PARAMETERS]
        parameters = {
            key: source[key] for key in keys if isinstance(source, dict) and key in source
        }
        recording["parameters"] = parameters
        recording["setting"] = ", ".join(f"{key}={value}" for key, value in parameters.items())
    ambiguous = [group[0] for group in _ambiguous_groups(recordings)]
    series = {_series(recording) for recording in ambiguous}
    frames = varying(
        (_series(recording), {"frames": recording["frames"]}) for recording in recordings
    )
    for recording in [
        recording
        for recording in recordings
        if _series(recording) in series and frames[_series(recording)]
    ]:
        _append_setting(recording, f"{recording['frames']} frames")
    for group in _ambiguous_groups(recordings):
        for recording in group:
            _append_setting(recording, f"recording {recording['hash'][:6]}")


def _series(recording: dict[str, Any]) -> tuple[str, str, str]:
    """The key of a series: recordings that differ only in the number of bodies."""
    return recording["scene"], recording["object_type"], recording["setting"]


def _ambiguous_groups(recordings: list[dict[str, Any]]) -> list[list[dict[str, Any]]]:
    """Groups of recordings with the same label."""
    groups: dict[Hashable, list[dict[str, Any]]] = defaultdict(list)
    for recording in recordings:
        groups[(_series(recording), recording["objects"])].append(recording)
    return [group for group in groups.values() if len(group) > 1]


def _append_setting(recording: dict[str, Any], text: str) -> None:
    recording["setting"] = ", ".join(filter(None, [recording["setting"], text]))
