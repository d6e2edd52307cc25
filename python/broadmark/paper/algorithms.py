"""The paper's scenes and algorithms with our ids, and its Table 2."""

from __future__ import annotations

import csv
import functools
import pathlib
from dataclasses import dataclass

#: The time per frame up to which larger sizes are shown.
CAP_SECONDS = 0.5

#: The number of threads of multi-threaded algorithms.
THREADS = 4

#: The ends of the figures' axes: thousands of objects, seconds.
MAX_THOUSANDS, MAX_SECONDS = 1024, 0.55


@dataclass(frozen=True)
class Scene:
    """A scene of the paper's evaluation."""

    name: str  #: in recordings and in Table 2
    title: str
    figure: int  #: the number of the figure with its times


SCENES = [
    Scene("Brownian", "Brownian", 5),
    Scene("FreeFall", "Free Fall", 6),
    Scene("Gravity", "Gravity", 7),
]
TITLES = {scene.name: scene.title for scene in SCENES}


@dataclass(frozen=True)
class Algorithm:
    """A column of Table 2 and a line of the figures."""

    name: str
    id: str  #: our id
    panel: str  #: SINGLE or PARALLEL
    settings: str = ""  #: the original's parameters that have another default here


SINGLE, PARALLEL = "single-threaded", "multi-threaded and GPU"

#: In the order of Table 2.
ALGORITHMS = [
    Algorithm("BF ST", "bf", SINGLE),
    Algorithm("BF MT", "bf-simd-mt", PARALLEL),
    Algorithm("SAP ST", "sap", SINGLE),
    Algorithm("SAP MT", "sap-simd-mt", PARALLEL),
    Algorithm("Grid BF ST", "grid-bf", SINGLE),
    Algorithm("Grid BF MT", "grid-bf-mt", PARALLEL),
    Algorithm("Grid SAP ST", "grid-sap", SINGLE),
    Algorithm("Grid SAP MT", "grid-sap-mt", PARALLEL),
    Algorithm("AxisSweep", "axis-sweep", SINGLE),
    Algorithm("DBVT F", "dbvt-f", SINGLE),
    Algorithm("DBVT D", "dbvt-d", SINGLE),
    Algorithm("Tracy ST", "tracy", SINGLE),
    Algorithm("Tracy MT", "tracy-mt", PARALLEL),
    Algorithm("CGAL", "cgal", SINGLE),
    Algorithm("KD", "kd", SINGLE, settings="margin=0.01"),
    Algorithm("GPU SAP", "b3-sap", PARALLEL),
    Algorithm("GPU LBVH", "b3-lbvh", PARALLEL),
    Algorithm("GPU Grid", "b3-grid", PARALLEL),
]

BY_NAME = {algorithm.name: algorithm for algorithm in ALGORITHMS}
BY_ID = {algorithm.id: algorithm for algorithm in ALGORITHMS}


def is_gpu(algorithm: Algorithm) -> bool:
    """Whether it runs on a device."""
    return algorithm.name.startswith("GPU")


@functools.cache
def table2() -> dict[tuple[str, int, str], float]:
    """Seconds per frame, rounded to 0.01 s, by scene, objects and our id."""
    with open(pathlib.Path(__file__).with_name("table2.csv"), encoding="utf-8") as file:
        return {
            (row["scene"], int(row["objects"]), BY_NAME[row["algorithm"]].id): float(
                row["seconds_per_frame"]
            )
            for row in csv.DictReader(file)
        }
