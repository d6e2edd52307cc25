"""Our times in the paper's places: one case for each scene, number of objects and algorithm.

Where an algorithm ran with several numbers of threads or instruction sets, the paper's place is that
of the case with the most threads and, of these, the widest instruction set. Only a case that ran to
its end with every answer right has a time; any other has its status.
"""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from broadmark.errors import InputError
from broadmark.paper.algorithms import ALGORITHMS, CAP_SECONDS, SCENES
from broadmark.results import Results
from broadmark.selection import best_variants, by_machine

SCENE_NAMES = [scene.name for scene in SCENES]
SELF_CHECKS = "self-check"  #: family


@dataclass(frozen=True)
class Place:
    """What was measured of an algorithm in a scene of one size."""

    status: str  #: of the case, or "incomplete"
    seconds: float | None  #: per frame, if the status is "ok"
    threads: int
    limit: float  #: what a timeout is judged by, in seconds a frame
    extra_share: float | None  #: pairs beyond those there are, as a share of these; None: unknown

    @property
    def past_the_cap(self) -> bool:
        """Whether it takes longer than the paper's cap, so that larger sizes are not shown."""
        if self.seconds is not None:
            return self.seconds > CAP_SECONDS
        return self.status == "timeout" and self.limit >= CAP_SECONDS


class Times:
    """Times of one machine on bodies of one type."""

    def __init__(self, machine: str, results: Results, object_type: str = "Cubes") -> None:
        self.machine = machine
        #: OpenCL's devices of the machine, the one that was used first.
        devices = results.environments.set_index("machine").loc[machine].get("compute_devices")
        self.devices: list[str] = devices if isinstance(devices, list) else []
        cases = results.cases
        wanted = (
            cases["scene"].isin(SCENE_NAMES)
            & (cases["object_type"] == object_type)
            & (cases["family"] != SELF_CHECKS)
        )
        self.places: dict[tuple[str, int, str], Place] = {}
        self.families: dict[str, str] = {}  #: by algorithm
        for number, row in best_variants(cases[wanted]).iterrows():
            conditions = results.details[number].get("conditions", {})
            status = row["status"] if row["complete"] else "incomplete"
            extra = float("nan") if row["allowed_extra"] is None else row["allowed_extra"]
            extra /= row["frames"]
            self.places[row["scene"], row["objects"], row["algorithm"]] = Place(
                status,
                row["seconds_per_frame"] if status == "ok" else None,
                row["threads"],
                conditions.get("frame_limit_seconds") or CAP_SECONDS,
                None if pd.isna(extra) else extra / max(row["pairs_mean"] - extra, 1),
            )
            self.families[row["algorithm"]] = row["family"]

    @property
    def own(self) -> list[str]:
        """Our algorithms that are not in the paper."""
        return sorted(self.families.keys() - {algorithm.id for algorithm in ALGORITHMS})

    def sizes(self, scene: str) -> list[int]:
        """Numbers of objects that anything ran with."""
        return sorted({objects for name, objects, _ in self.places if name == scene})

    def shown(self, scene: str, algorithm: str) -> dict[int, Place]:
        """Its places by the number of objects, up to the first past the cap."""
        places = {}
        for objects in self.sizes(scene):
            place = self.places.get((scene, objects, algorithm))
            if place is not None:
                places[objects] = place
                if place.past_the_cap:
                    break
        return places

    def is_parallel(self, algorithm: str) -> bool:
        """Whether it uses several threads or a device, going by its name and what it ran with."""
        return (
            algorithm.endswith("-mt")
            or self.on_device(algorithm)
            or any(p.threads > 1 for (_, _, a), p in self.places.items() if a == algorithm)
        )

    def on_device(self, algorithm: str) -> bool:
        """Whether it runs on an OpenCL device."""
        return self.families[algorithm] == "GPU"

    @property
    def conditions(self) -> list[str]:
        """What the times depend on beside the machine, a line each."""
        threads = {p.threads for (_, _, a), p in self.places.items() if not self.on_device(a)}
        lines = (
            [f"Multi-threaded algorithms: {max(threads)} threads"]
            if max(threads, default=1) > 1
            else []
        )
        return lines + ([f"OpenCL device: {self.device}"] if self.device else [])

    @property
    def device(self) -> str:
        """The OpenCL device in short; "" if nothing ran on one."""
        if not any(family == "GPU" for family in self.families.values()) or not self.devices:
            return ""
        name, _, about = self.devices[0].partition(" (")
        return name + (" (a CPU)" if ", CPU," in about else "")


def times_by_machine(results: Results) -> list[Times]:
    """The times of each machine that ran cubes in one of the paper's scenes, at least one."""
    times = [Times(machine, of_one) for machine, of_one in by_machine(results)]
    times = [one for one in times if one.places]
    if not times:
        raise InputError(
            f"no case with cubes in {', '.join(SCENE_NAMES)}: the paper's scenes are needed"
        )
    return times
