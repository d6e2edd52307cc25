"""Times by frame, reduced to the number of points that a page can hold: a line of text per case.

A point is the mean of consecutive frames, each the median over the repetitions. A line is base64 of
32-bit floats: the times in nanoseconds of all points for each phase, then the pairs.
"""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
import numpy.typing as npt

from broadmark.results import PHASES

#: Limits on the points of a case and the floats of all cases; 1.5 million floats give 8 MB of text.
MAX_POINTS = 200
MAX_FLOATS = 1_500_000
MIN_POINTS = 20


def points_per_case(cases: int) -> int:
    """The maximum number of points per case."""
    share = MAX_FLOATS // (max(cases, 1) * (len(PHASES) + 1))
    return max(MIN_POINTS, min(MAX_POINTS, share))


def timeline(case: dict[str, Any], max_points: int) -> str:
    """The line of a case; empty if it has no times."""
    lengths = [len(times) for times in case["frames"]["total"]]
    frames = max(lengths, default=0)
    if not frames:
        return ""
    complete = [i for i, length in enumerate(lengths) if length == frames]
    times = [[case["frames"][phase][i] for i in complete] for phase in PHASES]
    pairs = np.asarray(case.get("frame_counts", {}).get("pairs", ()), np.float64)[:frames]
    if len(pairs) != frames:
        pairs = np.full(frames, np.nan)
    rows = np.vstack([np.median(times, axis=1), pairs])
    return base64.b64encode(_binned(rows, max_points).tobytes()).decode("ascii")


def _binned(rows: npt.NDArray[np.float64], max_points: int) -> npt.NDArray[np.float32]:
    """Means over bins of nearly equal size."""
    frames = rows.shape[1]
    edges = np.linspace(0, frames, min(frames, max_points) + 1).astype(int)
    sums = np.add.reduceat(rows, edges[:-1], axis=1)
    return np.asarray(sums / np.diff(edges), "<f4")
