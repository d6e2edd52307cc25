"""What the plots share: the cases to show with their names and styles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pandas as pd

from broadmark.drawing import Style, styles
from broadmark.errors import InputError
from broadmark.paper.algorithms import BY_ID
from broadmark.results import Results
from broadmark.selection import RECORDING, one_per_place


@dataclass(frozen=True)
class Cases:
    """The cases of a plot, each with a time, in the order of the legend.

    `table` is that of `Results.cases` with `label`, the algorithm with what tells its variants apart,
    and `panel`, the scene with the type of its bodies.
    """

    results: Results
    table: pd.DataFrame
    log: bool
    note: str  #: the machine

    @property
    def looks(self) -> dict[str, Style]:
        """Styles by label. Variants of one algorithm share its style."""
        found = styles(dict(zip(self.table["algorithm"], self.table["family"])))
        algorithms = dict(zip(self.table["label"], self.table["algorithm"]))
        return {
            label: found[algorithm].lighter() if algorithm.endswith("-mt") else found[algorithm]
            for label, algorithm in algorithms.items()
        }

    def mean_frames(self, case: int) -> pd.DataFrame:
        """The frames of a case: means over its repetitions."""
        frames = self.results.frames
        one = frames[frames["case"] == case]
        columns = [c for c in one if c.endswith("_ns") or c == "pairs"]
        return one.groupby("frame", as_index=False)[columns].mean()


def chosen(results: Results, *, log: bool, note: str) -> Cases:
    """The cases that have a time: complete, and every answer right."""
    cases = results.cases
    ok = (cases["status"] == "ok") & cases["complete"] & cases["seconds_per_frame"].notna()
    if not ok.any():
        counts = cases["status"].where(~(cases["status"] == "ok"), "incomplete").value_counts()
        found = ", ".join(f"{count} {status}" for status, count in counts.items())
        raise InputError(f"no case with a time is left: {found}")
    table = cases[ok]
    table = table.assign(
        label=_labels(table), panel=table["scene"] + " " + table["object_type"].str.lower()
    )
    one_per_place(table, [*RECORDING, "label"])
    order = [_rank(row) for _, row in table.iterrows()]
    return Cases(results, table.iloc[sorted(range(len(order)), key=order.__getitem__)], log, note)


def _labels(table: pd.DataFrame) -> pd.Series:
    """The algorithm, and as in the case's id what tells it from other variants on the same bodies."""
    variants = [
        id_.rpartition("/" + algorithm)[2]
        for id_, algorithm in zip(table["id"], table["algorithm"])
    ]
    several = (
        table.assign(variant=variants).groupby("algorithm")["variant"].transform("nunique") > 1
    )
    return table["algorithm"] + pd.Series(variants, table.index).where(several, "")


def _rank(case: pd.Series) -> tuple[Any, ...]:
    """The order of the paper's table, then the alphabet."""
    known = list(BY_ID)
    id_ = case["algorithm"]
    place = known.index(id_) if id_ in known else len(known)
    return case["panel"], case["objects"], place, case["label"]
