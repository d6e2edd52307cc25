"""The cases of a plot with their labels and styles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pandas as pd

from broadmark.drawing import Style, style
from broadmark.errors import InputError
from broadmark.paper.algorithms import BY_ID
from broadmark.results import SELF_CHECK_FAMILY, Results
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
        return {
            label: style(algorithm).lighter() if algorithm.endswith("-mt") else style(algorithm)
            for label, algorithm in zip(self.table["label"], self.table["algorithm"])
        }

    def rows_of(self, panel: str) -> dict[str, int]:
        """The row of each label among those of a scene, in plots with a row per label: by the time at the
        largest number of bodies that it has, the largest numbers first."""
        scene = self.table[self.table["panel"] == panel]
        largest = scene.sort_values("objects", kind="stable").drop_duplicates("label", keep="last")
        order = largest.sort_values(
            ["objects", "seconds_per_frame"], ascending=[False, True], kind="stable"
        )
        return {label: row for row, label in enumerate(order["label"])}

    def mean_frames(self, case: int) -> pd.DataFrame:
        """The frames of a case, averaged over the repetitions."""
        frames = self.results.frames
        case_frames = frames[frames["case"] == case]
        columns = [name for name in case_frames if name.endswith("_ns") or name == "pairs"]
        return case_frames.groupby("frame", as_index=False)[columns].mean()


def timed_cases(results: Results, *, log: bool, note: str) -> Cases:
    """The cases with a time: complete and without wrong answers. Self-checks are left out: their
    times are not comparable."""
    cases = results.cases
    ok = _reasons(cases) == ""
    if not ok.any():
        reasons = omitted(cases) or "only self-checks"
        raise InputError(f"no case with a time is left: {reasons}")
    table = cases[ok]
    table = table.assign(
        label=_labels(table), panel=table["scene"] + " " + table["object_type"].str.lower()
    )
    require_unique(table, [*RECORDING, "label"])
    order = [_rank(row) for _, row in table.iterrows()]
    return Cases(results, table.iloc[sorted(range(len(order)), key=order.__getitem__)], log, note)


def omitted(cases: pd.DataFrame) -> str:
    """The reasons why `timed_cases` omits cases, with their numbers; "" if it omits none but
    self-checks."""
    counts = _reasons(cases).value_counts().drop(["", SELF_CHECK_FAMILY], errors="ignore")
    return ", ".join(f"{count} {reason}" for reason, count in counts.items())


def _reasons(cases: pd.DataFrame) -> pd.Series:
    reasons = cases["status"].astype(object).replace("ok", "")
    untimed = ~cases["complete"] | cases["seconds_per_frame"].isna()
    reasons = reasons.mask((reasons == "") & untimed, "incomplete")
    return reasons.mask(cases["family"] == SELF_CHECK_FAMILY, SELF_CHECK_FAMILY)


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
