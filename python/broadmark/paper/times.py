"""Our times by the paper's scenes, numbers of objects and algorithms, one case each.

Among several numbers of threads and instruction sets, the case with the most threads and then the
widest instruction set is used; cases with parameters, where there is none without. Only a complete case without wrong answers has a time; others have
their status.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pandas as pd

from broadmark.errors import InputError
from broadmark.paper.algorithms import ALGORITHMS, BY_ID, CAP_SECONDS, SCENES
from broadmark.results import SELF_CHECK_FAMILY, Results, commit_name
from broadmark.selection import RECORDING, best_variants, by_machine

SCENE_NAMES = [scene.name for scene in SCENES]

#: Half the width of a time's 95 % interval, relative to it: at least, and if it was measured once.
MIN_NOISE, NOISE_OF_ONE = 0.02, 0.1

#: A frame is a spike if it takes this many times as long as the median frame around it.
SPIKE_FACTOR, SPIKE_WINDOW = 3, 11


@dataclass(frozen=True)
class Measurement:
    """The result of an algorithm in a scene of one size."""

    status: str  #: of the case, or "incomplete"
    seconds: float | None  #: per frame, if the status is "ok"
    threads: int
    limit: float  #: the time limit in seconds per frame
    extra_share: float | None  #: false pairs per overlapping pair; None: unknown
    noise: float  #: half the width of the 95 % interval of `seconds`, relative to it
    repeated: bool  #: so that the interval was measured
    median: float  #: seconds
    spike_share: float  #: of the time, that spikes take longer than the frames around them

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
        cases = cases[mask]
        #: Cases with the settings of the paper's original that are no defaults here.
        self.original_settings = {
            self._cell(row): self._measurement(row, results.details[number])
            for number, row in cases.iterrows()
            if row["algorithm"] in BY_ID
            and BY_ID[row["algorithm"]].settings
            and results.details[number]["params"] == BY_ID[row["algorithm"]].settings
        }
        plain = cases["params"] == ""
        has_plain = plain.groupby([cases[key] for key in [*RECORDING, "algorithm"]]).transform(
            "any"
        )
        for number, row in best_variants(cases[plain | ~has_plain]).iterrows():
            self.measurements[self._cell(row)] = self._measurement(row, results.details[number])
            self.families[row["algorithm"]] = row["family"]

    @staticmethod
    def _cell(row: pd.Series) -> tuple[str, int, str]:
        return row["scene"], row["objects"], row["algorithm"]

    @staticmethod
    def _measurement(row: pd.Series, details: dict[str, Any]) -> Measurement:
        status = row["status"] if row["complete"] else "incomplete"
        extra = row["allowed_extra"] / row["frames"]
        seconds, repeated = row["seconds_per_frame"], not pd.isna(row["ci95_low_seconds"])
        half_width = (row["ci95_high_seconds"] - row["ci95_low_seconds"]) / 2
        return Measurement(
            status,
            seconds if status == "ok" else None,
            row["threads"],
            details.get("conditions", {}).get("frame_limit_seconds") or CAP_SECONDS,
            None if pd.isna(extra) else extra / max(row["pairs_mean"] - extra, 1),
            max(half_width / seconds if seconds else 0, MIN_NOISE) if repeated else NOISE_OF_ONE,
            repeated,
            row["median_seconds"],
            _spike_share(details["frames"]["total"]),
        )

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

    def threads_of(self, algorithm: str) -> int:
        """The most threads of an algorithm; 0 without a result."""
        return max(
            (p.threads for (_, _, id_), p in self.measurements.items() if id_ == algorithm),
            default=0,
        )

    def is_parallel(self, algorithm: str) -> bool:
        """Whether the algorithm uses several threads or a device, by its name and results."""
        return (
            algorithm.endswith("-mt") or self.on_device(algorithm) or self.threads_of(algorithm) > 1
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


def _spike_share(repetitions: list[Any]) -> float:
    total = excess = 0.0
    for repetition in repetitions:
        frames = pd.Series(repetition, dtype=float)
        around = frames.rolling(SPIKE_WINDOW, center=True, min_periods=1).median()
        excess += (frames - around)[frames > SPIKE_FACTOR * around].sum()
        total += frames.sum()
    return excess / total if total else 0.0


def times_by_machine(results: Results) -> list[Times]:
    """The times of each machine with cubes in the paper's scenes. InputError if there is none."""
    times = [Times(machine, machine_results) for machine, machine_results in by_machine(results)]
    times = [machine_times for machine_times in times if machine_times.measurements]
    if not times:
        raise InputError(
            f"no case with cubes in {', '.join(SCENE_NAMES)}: the paper's scenes are required"
        )
    return times
