"""The cases of a plot with their labels and styles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pandas as pd

from broadmark.drawing import Style, styles
from broadmark.errors import InputError
from broadmark.paper.algorithms import BY_ID
from broadmark.results import Results
from broadmark.selection import RECORDING, require_unique


@dataclass(frozen=True)
class Cases:
    """The cases of a plot, all with a time, in the order of the legend.

    `table` has the columns of `Results.cases`, and `label` (the algorithm with the parts of the id that
    distinguish its variants) and `panel` (scene and object type).
    """

    results: Results
    table: pd.DataFrame
    log: bool
    note: str  #: the machine

    @property
    def styles(self) -> dict[str, Style]:
        """The styles by label. Variants share the style of their algorithm."""
        found = styles(dict(zip(self.table["algorithm"], self.table["family"])))
        algorithms = dict(zip(self.table["label"], self.table["algorithm"]))
        return {
            label: found[algorithm].lighter() if algorithm.endswith("-mt") else found[algorithm]
            for label, algorithm in algorithms.items()
        }

    def rows_of(self, panel: str) -> dict[str, int]:
        """The row of each label among those of a scene, in plots with a row per label."""
        labels = self.table.loc[self.table["panel"] == panel, "label"].unique()
        return {label: row for row, label in enumerate(labels)}

    def mean_frames(self, case: int) -> pd.DataFrame:
        """The frames of a case, averaged over the repetitions."""
        frames = self.results.frames
        case_frames = frames[frames["case"] == case]
        columns = [name for name in case_frames if name.endswith("_ns") or name == "pairs"]
        return case_frames.groupby("frame", as_index=False)[columns].mean()


def timed_cases(results: Results, *, log: bool, note: str) -> Cases:
    """The cases with a time: complete and without wrong answers."""
    cases = results.cases
    ok = (cases["status"] == "ok") & cases["complete"] & cases["seconds_per_frame"].notna()
    if not ok.any():
        counts = cases["status"].where(~(cases["status"] == "ok"), "incomplete").value_counts()
        summary = ", ".join(f"{count} {status}" for status, count in counts.items())
        raise InputError(f"no case with a time is left: {summary}")
    table = cases[ok]
    table = table.assign(
        label=_labels(table), panel=table["scene"] + " " + table["object_type"].str.lower()
    )
    require_unique(table, [*RECORDING, "label"])
    order = [_rank(row) for _, row in table.iterrows()]
    return Cases(results, table.iloc[sorted(range(len(order)), key=order.__getitem__)], log, note)


def _labels(table: pd.DataFrame) -> pd.Series:
    """The algorithm, followed by the variant's part of the case's id if there are several variants."""
    variants = [
        id_.rpartition("/" + algorithm)[2]
        for id_, algorithm in zip(table["id"], table["algorithm"])
    ]
    has_variants = (
        table.assign(variant=variants).groupby("algorithm")["variant"].transform("nunique") > 1
    )
    return table["algorithm"] + pd.Series(variants, table.index).where(has_variants, "")


def _rank(case: pd.Series) -> tuple[Any, ...]:
    """The sort key: the order of the paper's table, then alphabetical order."""
    known = list(BY_ID)
    id_ = case["algorithm"]
    position = known.index(id_) if id_ in known else len(known)
    return case["panel"], case["objects"], position, case["label"]
