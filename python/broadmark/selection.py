"""Which cases of results a table or a picture shows, and the options that choose them.

Times of several machines are never pooled, nor is one of two cases chosen in silence: what competes
for one place is an error that tells how to choose.
"""

from __future__ import annotations

import argparse
import re
import sys
from fnmatch import fnmatchcase

import pandas as pd

from broadmark.errors import InputError
from broadmark.results import Results, read_results

#: Instruction sets, the widest last.
WIDTHS = ["scalar", "sse2", "neon", "avx2", "avx512"]

#: What a recording is called in titles; two recordings that differ in more compete for one place.
RECORDING = ["scene", "object_type", "objects"]


def add_options(parser: argparse.ArgumentParser) -> None:
    """RESULTS and the options that choose from them, as `read_selected` takes them."""
    parser.add_argument("results", nargs="+", metavar="RESULTS", help="results (.json, .jsonl)")
    parser.add_argument("--machine", metavar="NAME", help="of this machine only (part of its name)")
    parser.add_argument("--filter", metavar="REGEX", help="only cases whose id matches")


def read_selected(options: argparse.Namespace, may_be_empty: bool = False) -> Results:
    """The results that the options of `add_options` name. Without a case they are an error, unless
    they `may_be_empty` and had none to choose from."""
    results = read_results(*options.results)
    may_be_empty = may_be_empty and not len(results.cases)
    for path in results.partial:
        print(f"{path}: partial: its run did not come to an end", file=sys.stderr)
    cases = results.cases
    if options.filter is not None and len(cases):
        try:
            results = results.select(cases["id"].str.contains(re.compile(options.filter)))
        except re.error as error:
            raise InputError(f"--filter '{options.filter}': is no pattern: {error}") from None
    if options.machine is not None and len(results.cases):
        known = sorted(results.cases["machine"].unique())
        chosen = [name for name in known if options.machine in name]
        if len(chosen) != 1:
            raise InputError(
                f"--machine '{options.machine}': is part of {len(chosen)} names of {_listed(known)}"
            )
        results = results.select(results.cases["machine"] == chosen[0])
    if not len(results.cases) and not may_be_empty:
        raise InputError("no case is left of these results: mend --filter or --machine")
    return results


def by_machine(results: Results) -> list[tuple[str, Results]]:
    """The results of each machine."""
    machines = results.cases["machine"]
    return [(name, results.select(machines == name)) for name in machines.unique()]


def one_machine(results: Results) -> tuple[str, Results]:
    """The results, which must be of one machine."""
    machines = by_machine(results)
    if len(machines) > 1:
        names = _listed([name for name, _ in machines])
        raise InputError(f"results of {len(machines)} machines: choose one with --machine: {names}")
    return machines[0]


def match_names(names: pd.Series, patterns: str) -> pd.Series:
    """Which names are among ID[,ID…], globs allowed. InputError for a pattern that none matches."""
    mask = pd.Series(False, index=names.index)
    for pattern in patterns.split(","):
        matches = names.map(lambda name, p=pattern: fnmatchcase(name.lower(), p.lower()))
        if not matches.any():
            raise InputError(f"'{pattern}': matches none of {_listed(sorted(names.unique()))}")
        mask |= matches
    return mask


def one_per_place(cases: pd.DataFrame, place: list[str]) -> pd.DataFrame:
    """The cases, if no two of them have the same values of `place`; a case that ran to its end
    replaces one that did not. Else InputError."""
    cases = cases[cases["complete"] | ~cases.groupby(place)["complete"].transform("any")]
    twice = cases[cases.duplicated(place, keep=False)]
    if len(twice):
        same = (twice[place] == twice[place].iloc[0]).all(axis=1)
        first, second = (case for _, case in twice[same].iloc[:2].iterrows())
        what = " ".join(str(first[column]) for column in place)
        if first["id"] == second["id"]:
            raise InputError(
                f"{what}: is in {first['file']} and {second['file']}: give one of them"
            )
        raise InputError(
            f"{what}: two cases compete, {first['id']} and {second['id']}: choose with --filter"
        )
    return cases


def best_variants(cases: pd.DataFrame) -> pd.DataFrame:
    """For each algorithm on each recording the case with the most threads and, of these, with the
    widest instruction set."""
    rank = cases["threads"] * len(WIDTHS) + cases["isa"].map(
        lambda isa: WIDTHS.index(isa) if isa in WIDTHS else 0
    )
    place = [*RECORDING, "algorithm"]
    best = rank.groupby([cases[column] for column in place]).transform("max")
    return one_per_place(cases[rank == best], place)


def _listed(names: list[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)
