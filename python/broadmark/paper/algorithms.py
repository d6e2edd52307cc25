"""The paper's scenes and algorithms: our ids, how it draws them, and the numbers of its Table 2."""

from __future__ import annotations

import csv
import functools
import pathlib
from dataclasses import dataclass

#: An algorithm is shown up to the first size at which a frame takes longer.
CAP_SECONDS = 0.5

#: The figures' axes: thousands of objects, seconds.
MOST_THOUSANDS, MOST_SECONDS = 1024, 0.55


@dataclass(frozen=True)
class Scene:
    """A scene of the paper's evaluation."""

    name: str  #: in recordings and in Table 2
    title: str
    figure: int  #: that shows its times


SCENES = [
    Scene("Brownian", "Brownian", 5),
    Scene("FreeFall", "Free Fall", 6),
    Scene("Gravity", "Gravity", 7),
]


@dataclass(frozen=True)
class Algorithm:
    """A column of Table 2 and a line of the figures."""

    name: str
    id: str  #: ours
    colour: str  #: says where the implementation is from
    marker: str  #: says the algorithm
    filled: bool  #: says the variant
    panel: str  #: SINGLE or PARALLEL
    line: str = "-"


SINGLE, PARALLEL = "single-threaded", "multi-threaded and GPU"

GREEN = "#2e9e3f"  # the original's own
BLUE = "#2166c4"  # Bullet 2
RED = "#d62728"  # Bullet 3
YELLOW = "#dba800"  # independent ones
LAVENDER = "#a785dd"
BLACK = "#000000"

#: In the order of Table 2.
ALGORITHMS = [
    Algorithm("BF ST", "bf", GREEN, "o", False, SINGLE),
    Algorithm("BF MT", "bf-simd-mt", GREEN, "o", False, PARALLEL),
    Algorithm("SAP ST", "sap", GREEN, "^", False, SINGLE),
    Algorithm("SAP MT", "sap-simd-mt", GREEN, "^", False, PARALLEL),
    Algorithm("Grid BF ST", "grid-bf", GREEN, "s", False, SINGLE),
    Algorithm("Grid BF MT", "grid-bf-mt", GREEN, "s", False, PARALLEL),
    Algorithm("Grid SAP ST", "grid-sap", GREEN, "s", True, SINGLE),
    Algorithm("Grid SAP MT", "grid-sap-mt", GREEN, "s", True, PARALLEL),
    Algorithm("AxisSweep", "axis-sweep", BLUE, "^", True, SINGLE),
    Algorithm("DBVT F", "dbvt-f", BLUE, "D", False, SINGLE),
    Algorithm("DBVT D", "dbvt-d", BLUE, "D", True, SINGLE),
    Algorithm("Tracy ST", "tracy", YELLOW, "v", True, SINGLE),
    Algorithm("Tracy MT", "tracy-mt", YELLOW, "v", True, PARALLEL),
    Algorithm("CGAL", "cgal", LAVENDER, "p", True, SINGLE),
    Algorithm("KD", "kd", BLACK, "d", True, SINGLE),
    Algorithm("GPU SAP", "b3-sap", RED, "^", True, PARALLEL, "--"),
    Algorithm("GPU LBVH", "b3-lbvh", RED, "s", True, PARALLEL, "--"),
    Algorithm("GPU Grid", "b3-grid", RED, "o", True, PARALLEL, "--"),
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
