"""Times frame by frame, few enough points for a page: one line of text per case.

A point is the mean of some frames, each with its median over the repetitions. A line is base64 of
32-bit floats: for each phase the times in nanoseconds of all points, then the pairs.
"""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
import numpy.typing as npt

from broadmark.results import PHASES

#: Points of a case at most, and floats of all cases together: 1.5 million make 8 MB of text.
MOST_POINTS = 200
MOST_FLOATS = 1_500_000
FEWEST_POINTS = 20


def points_of_a_case(cases: int) -> int:
    """How many points each case may have."""
    share = MOST_FLOATS // (max(cases, 1) * (len(PHASES) + 1))
    return max(FEWEST_POINTS, min(MOST_POINTS, share))


def timeline(case: dict[str, Any], most_points: int) -> str:
    """The line of a case; an empty one if it has no times."""
    lengths = [len(times) for times in case["frames"]["total"]]
    frames = max(lengths, default=0)
    if not frames:
        return ""
    whole = [i for i, length in enumerate(lengths) if length == frames]
    times = [[case["frames"][phase][i] for i in whole] for phase in PHASES]
    pairs = np.asarray(case.get("frame_counts", {}).get("pairs", ()), np.float64)[:frames]
    if len(pairs) != frames:
        pairs = np.full(frames, np.nan)
    rows = np.vstack([np.median(times, axis=1), pairs])
    return base64.b64encode(_binned(rows, most_points).tobytes()).decode("ascii")


def _binned(rows: npt.NDArray[np.float64], most_points: int) -> npt.NDArray[np.float32]:
    """Means of as equal numbers of neighbours as possible."""
    frames = rows.shape[1]
    edges = np.linspace(0, frames, min(frames, most_points) + 1).astype(int)
    sums = np.add.reduceat(rows, edges[:-1], axis=1)
    return np.asarray(sums / np.diff(edges), "<f4")
