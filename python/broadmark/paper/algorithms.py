"""The paper's scenes and algorithms with our ids and the paper's styles, and its Table 2."""

from __future__ import annotations

import csv
import functools
import pathlib
from dataclasses import dataclass, field

from broadmark.palette import light

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


@dataclass(frozen=True)
class Algorithm:
    """A column of Table 2 and a line of the figures."""

    name: str
    id: str  #: our id
    colour: str  #: by the origin of the implementation
    marker: str  #: by the algorithm
    filled: bool  #: by the variant
    panel: str  #: SINGLE or PARALLEL
    line: str = "-"
    #: The original's values of parameters that have another default here.
    settings: dict[str, float] = field(default_factory=dict)


SINGLE, PARALLEL = "single-threaded", "multi-threaded and GPU"

ORIGINAL = light("paper_original")
BULLET2 = light("paper_bullet2")
BULLET3 = light("paper_bullet3")
INDEPENDENT = light("paper_independent")

#: In the order of Table 2.
ALGORITHMS = [
    Algorithm("BF ST", "bf", ORIGINAL, "o", False, SINGLE),
    Algorithm("BF MT", "bf-simd-mt", ORIGINAL, "o", False, PARALLEL),
    Algorithm("SAP ST", "sap", ORIGINAL, "^", False, SINGLE),
    Algorithm("SAP MT", "sap-simd-mt", ORIGINAL, "^", False, PARALLEL),
    Algorithm("Grid BF ST", "grid-bf", ORIGINAL, "s", False, SINGLE),
    Algorithm("Grid BF MT", "grid-bf-mt", ORIGINAL, "s", False, PARALLEL),
    Algorithm("Grid SAP ST", "grid-sap", ORIGINAL, "s", True, SINGLE),
    Algorithm("Grid SAP MT", "grid-sap-mt", ORIGINAL, "s", True, PARALLEL),
    Algorithm("AxisSweep", "axis-sweep", BULLET2, "^", True, SINGLE),
    Algorithm("DBVT F", "dbvt-f", BULLET2, "D", False, SINGLE),
    Algorithm("DBVT D", "dbvt-d", BULLET2, "D", True, SINGLE),
    Algorithm("Tracy ST", "tracy", INDEPENDENT, "v", True, SINGLE),
    Algorithm("Tracy MT", "tracy-mt", INDEPENDENT, "v", True, PARALLEL),
    Algorithm("CGAL", "cgal", light("paper_cgal"), "p", True, SINGLE),
    Algorithm("KD", "kd", light("paper_kd"), "d", True, SINGLE, "-", {"margin": 0.01}),
    Algorithm("GPU SAP", "b3-sap", BULLET3, "^", True, PARALLEL, "--"),
    Algorithm("GPU LBVH", "b3-lbvh", BULLET3, "s", True, PARALLEL, "--"),
    Algorithm("GPU Grid", "b3-grid", BULLET3, "o", True, PARALLEL, "--"),
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
