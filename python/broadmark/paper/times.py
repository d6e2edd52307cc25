"""Our times by the paper's scenes, numbers of objects and algorithms, one case each.

Among several numbers of threads and instruction sets, the case with the most threads and then the
widest instruction set is used. Only a complete case without wrong answers has a time; others have
their status.
"""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from broadmark.errors import InputError
from broadmark.paper.algorithms import ALGORITHMS, CAP_SECONDS, SCENES
from broadmark.results import Results, commit_name
from broadmark.selection import best_variants, by_machine

SCENE_NAMES = [scene.name for scene in SCENES]
SELF_CHECK_FAMILY = "self-check"


@dataclass(frozen=True)
class Measurement:
    """The result of an algorithm in a scene of one size."""

    status: str  #: of the case, or "incomplete"
    seconds: float | None  #: per frame, if the status is "ok"
    threads: int
    limit: float  #: the time limit in seconds per frame
    extra_share: float | None  #: false pairs per overlapping pair; None: unknown

    @property
    def exceeds_cap(self) -> bool:
        """Whether a frame takes longer than the paper's cap, so that larger sizes are not shown."""
        if self.seconds is not None:
            return self.seconds > CAP_SECONDS
        return self.status == "timeout" and self.limit >= CAP_SECONDS


class Times:
    """The times of one machine on objects of one type."""

    def __init__(self, machine: str, results: Results, object_type: str = "Cubes") -> None:
        self.machine = machine
        #: The machine's OpenCL devices, the used device first.
        environment = results.environments.set_index("machine").loc[machine].to_dict()
        devices = environment.get("compute_devices")
        self.devices: list[str] = devices if isinstance(devices, list) else []
        #: Commit, compiler and options of the program; "" if the commit is unknown.
        self.build = ", ".join(
            str(text).strip()
            for text in (
                commit_name(environment),
                environment.get("compiler"),
                environment.get("compiler_flags"),
            )
            if commit_name(environment) and isinstance(text, str)
        )
        cases = results.cases
        mask = (
            cases["scene"].isin(SCENE_NAMES)
            & (cases["object_type"] == object_type)
            & (cases["family"] != SELF_CHECK_FAMILY)
        )
        self.measurements: dict[tuple[str, int, str], Measurement] = {}
        self.families: dict[str, str] = {}  #: by algorithm
        for number, row in best_variants(cases[mask]).iterrows():
            conditions = results.details[number].get("conditions", {})
            status = row["status"] if row["complete"] else "incomplete"
            extra = float("nan") if row["allowed_extra"] is None else row["allowed_extra"]
            extra /= row["frames"]
            self.measurements[row["scene"], row["objects"], row["algorithm"]] = Measurement(
                status,
                row["seconds_per_frame"] if status == "ok" else None,
                row["threads"],
                conditions.get("frame_limit_seconds") or CAP_SECONDS,
                None if pd.isna(extra) else extra / max(row["pairs_mean"] - extra, 1),
            )
            self.families[row["algorithm"]] = row["family"]

    @property
    def other_algorithms(self) -> list[str]:
        """The algorithms that are not in the paper."""
        return sorted(self.families.keys() - {algorithm.id for algorithm in ALGORITHMS})

    def sizes(self, scene: str) -> list[int]:
        """The measured numbers of objects."""
        return sorted({objects for name, objects, _ in self.measurements if name == scene})

    def shown(self, scene: str, algorithm: str) -> dict[int, Measurement]:
        """An algorithm's measurements by number of objects, up to the first past the cap."""
        measurements = {}
        for objects in self.sizes(scene):
            measurement = self.measurements.get((scene, objects, algorithm))
            if measurement is not None:
                measurements[objects] = measurement
                if measurement.exceeds_cap:
                    break
        return measurements

    def is_parallel(self, algorithm: str) -> bool:
        """Whether the algorithm uses several threads or a device, by its name and results."""
        return (
            algorithm.endswith("-mt")
            or self.on_device(algorithm)
            or any(p.threads > 1 for (_, _, a), p in self.measurements.items() if a == algorithm)
        )

    def on_device(self, algorithm: str) -> bool:
        """Whether the algorithm runs on an OpenCL device."""
        return self.families[algorithm] == "GPU"

    @property
    def conditions(self) -> list[str]:
        """The conditions of the times besides the machine, a line each."""
        threads = {p.threads for (_, _, a), p in self.measurements.items() if not self.on_device(a)}
        lines = (
            [f"Multi-threaded algorithms: {max(threads)} threads"]
            if max(threads, default=1) > 1
            else []
        )
        lines += [f"Commit {self.build}"] if self.build else []
        return lines + ([f"OpenCL device: {self.device}"] if self.device else [])

    @property
    def device(self) -> str:
        """The short name of the OpenCL device; "" if no algorithm used a device."""
        if not any(family == "GPU" for family in self.families.values()) or not self.devices:
            return ""
        name, _, about = self.devices[0].partition(" (")
        return name + (" (a CPU)" if ", CPU," in about else "")


def times_by_machine(results: Results) -> list[Times]:
    """The times of each machine with cubes in the paper's scenes. InputError if there is none."""
    times = [Times(machine, machine_results) for machine, machine_results in by_machine(results)]
    times = [machine_times for machine_times in times if machine_times.measurements]
    if not times:
        raise InputError(
            f"no case with cubes in {', '.join(SCENE_NAMES)}: the paper's scenes are required"
        )
    return times
