"""The drift of a machine: what the times of all cases of a run share.

A case's drift is the median change of the other cases, so that its own change is no part of it. The
steps of these cases, once found, are left out, too.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

#: The fewest other cases that tell a change of the machine from one of the code, as for `compare`.
MIN_OTHERS = 3


def first_levels(values: Array) -> Array:
    """The level of each case (rows) over all runs (columns), by median polish (Tukey, 1977)."""
    levels = np.nanmedian(values, axis=1)
    for _ in range(5):
        drift = _median(values - levels[:, None])
        drift[np.isnan(drift)] = 0
        levels = np.nanmedian(values - drift, axis=1)
    return np.asarray(levels)


def drifts_of_others(residuals: Array, recordings: list[str]) -> Array:
    """For each case and run, the median residual of the other cases in that run: of those on the same
    recording, which ran alternately with it, or where these are few of all. Missing where all are
    too few."""
    drifts = np.full(residuals.shape, np.nan)
    for case, recording in enumerate(recordings):
        for mask in (
            np.ones(len(recordings), bool),
            np.array([other == recording for other in recordings]),
        ):
            mask[case] = False
            others = residuals[mask]
            enough = (~np.isnan(others)).sum(axis=0) >= MIN_OTHERS
            drifts[case, enough] = _median(others[:, enough])
    return drifts


def common_drift(residuals: Array) -> Array:
    """The median residual of all cases in each run; missing where they are too few."""
    drift = _median(residuals)
    drift[(~np.isnan(residuals)).sum(axis=0) <= MIN_OTHERS] = np.nan
    return drift


def _median(values: Array) -> Array:
    """The median of each column, missing if it has no value."""
    medians = np.full(values.shape[1], np.nan)
    known = ~np.isnan(values).all(axis=0)
    medians[known] = np.nanmedian(values[:, known], axis=0)
    return medians
