"""Memory: the mean time of a frame against the memory that it takes."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from broadmark.drawing import log_scale
from broadmark.errors import InputError
from broadmark.plots.cases import Cases
from broadmark.plots.panels import by_scene_and_size

#: Bytes that the system counts memory in: a small case may take less, and a logarithm has no 0.
PAGE = 4096


def memory(cases: Cases) -> Figure:
    """mean time of a frame against peak memory, both logarithmic: the best are at the lower left"""
    looks = cases.looks
    if not cases.table["peak_bytes"].notna().any():
        raise InputError("no case with its memory is left: it is unknown of runs with --in-process")

    def paint(axes: Any, part: pd.DataFrame) -> None:
        for _, case in part[part["peak_bytes"].notna()].iterrows():
            style = looks[case["label"]].of_points()
            axes.plot(
                max(case["peak_bytes"], PAGE),
                case["seconds_per_frame"],
                **style,
                label=case["label"],
            )
        log_scale(axes, "x", "B")
        log_scale(axes, "y", "s")

    return by_scene_and_size(
        cases, paint, size=(2.8, 2.4), x="peak memory", y="time of a frame", legend=True
    )
