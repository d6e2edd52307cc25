"""The choice of cases that a table or a figure shows, and its options.

Times of several machines are never pooled. Two cases for the same cell or point are an error whose
message names the options to choose between them.
"""

from __future__ import annotations

import argparse
import re
import sys
from fnmatch import fnmatchcase

import pandas as pd

from broadmark.errors import InputError
from broadmark.results import Results, read_results

#: Instruction sets in ascending order of vector width.
ISAS = ["scalar", "sse2", "neon", "simd128", "avx2", "avx512"]

#: The columns that identify a recording in titles. Recordings that are equal in them conflict.
RECORDING = ["scene", "object_type", "objects"]


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds RESULTS and the options that `read_selected` applies to them."""
    parser.add_argument(
        "results", nargs="+", metavar="RESULTS", help="results files (.json, .jsonl)"
    )
    parser.add_argument(
        "--machine", metavar="NAME", help="only cases of this machine (part of its name)"
    )
    parser.add_argument("--filter", metavar="REGEX", help="only cases with a matching id")


def read_selected(options: argparse.Namespace, may_be_empty: bool = False) -> Results:
    """The results selected by the options of `add_options`. Raises InputError if no case is left,
    unless `may_be_empty` is set and the files have no cases."""
    results = read_results(*options.results)
    may_be_empty = may_be_empty and not len(results.cases)
    for path in results.partial:
        print(f"{path}: partial results: the run was not finished", file=sys.stderr)
    if options.filter is not None and len(results.cases):
        results = results.select(match_ids(results.cases["id"], options.filter))
    if options.machine is not None and len(results.cases):
        known = sorted(results.cases["machine"].unique())
        chosen = [name for name in known if options.machine in name]
        if len(chosen) != 1:
            raise InputError(
                f"--machine '{options.machine}': matches {len(chosen)} names of {_quoted(known)}"
            )
        results = results.select(results.cases["machine"] == chosen[0])
    if not len(results.cases) and not may_be_empty:
        raise InputError("no case is left: change --filter or --machine")
    return results


def by_machine(results: Results) -> list[tuple[str, Results]]:
    """The results of each machine."""
    machines = results.cases["machine"]
    return [(name, results.select(machines == name)) for name in machines.unique()]


def single_machine(results: Results) -> tuple[str, Results]:
    """The name and results of the only machine. Raises InputError if there are several."""
    machines = by_machine(results)
    if len(machines) > 1:
        names = _quoted([name for name, _ in machines])
        raise InputError(f"results of {len(machines)} machines: choose one with --machine: {names}")
    return machines[0]


def match_ids(ids: pd.Series, pattern: str) -> pd.Series:
    """A mask of the ids that contain a match of the option --filter."""
    try:
        search = re.compile(pattern).search
    except re.error as error:
        raise InputError(f"--filter '{pattern}': not a regular expression: {error}") from None
    return ids.map(lambda id_: search(id_) is not None).astype(bool)


def add_case_options(parser: argparse.ArgumentParser) -> None:
    """Adds the options that `match_cases` applies."""
    parser.add_argument("--scene", metavar="NAME[,NAME…]", help="only these scenes")
    parser.add_argument(
        "--algorithm", metavar="ID[,ID…]", help="only these algorithms; patterns such as 'sap*'"
    )
    parser.add_argument("--objects", metavar="N[,N…]", help="only these numbers of bodies")


def read_cases(options: argparse.Namespace) -> tuple[str, Results]:
    """The name of the only machine, and its results selected by the options of `add_options` and
    `add_case_options`. Raises InputError if no case is left or there are several machines."""
    machine, results = single_machine(read_selected(options))
    return machine, select_cases(results, options)


def select_cases(results: Results, options: argparse.Namespace) -> Results:
    """The results selected by the options of `add_case_options`. Raises InputError if no case is left."""
    results = results.select(match_cases(results.cases, options))
    if not len(results.cases):
        raise InputError("no case is left: no case matches --scene, --algorithm and --objects")
    return results


def match_cases(cases: pd.DataFrame, options: argparse.Namespace) -> pd.Series:
    """A mask of the cases selected by the options of `add_case_options`."""
    mask = pd.Series(True, cases.index)
    for option, column in (
        (options.scene, "scene"),
        (options.algorithm, "algorithm"),
        (options.objects, "objects"),
    ):
        if option is not None:
            mask &= match_names(cases[column].astype(str), option)
    return mask


def match_names(names: pd.Series, patterns: str) -> pd.Series:
    """A mask of the names that match ID[,ID…], globs allowed. Raises InputError for a pattern without
    a match."""
    mask = pd.Series(False, index=names.index)
    for pattern in patterns.split(","):
        matches = names.map(lambda name, p=pattern: fnmatchcase(name.lower(), p.lower()))
        if not matches.any():
            raise InputError(f"'{pattern}': matches none of {_quoted(sorted(names.unique()))}")
        mask |= matches
    return mask


def require_unique(
    cases: pd.DataFrame, keys: list[str], choice: str = "choose with --filter"
) -> pd.DataFrame:
    """The cases, unique in the columns `keys`: a complete case replaces an incomplete case. Raises
    InputError for cases that are equal in these columns; `choice`: how to choose between them."""
    cases = cases[cases["complete"] | ~cases.groupby(keys)["complete"].transform("any")]
    duplicates = cases[cases.duplicated(keys, keep=False)]
    if len(duplicates):
        equal = (duplicates[keys] == duplicates[keys].iloc[0]).all(axis=1)
        first, second = (case for _, case in duplicates[equal].iloc[:2].iterrows())
        description = " ".join(str(first[column]) for column in keys)
        if first["id"] == second["id"]:
            raise InputError(
                f"{description}: is in {first['file']} and {second['file']}: give only one of them"
            )
        raise InputError(
            f"{description}: two cases match, {first['id']} and {second['id']}: {choice}"
        )
    return cases


def best_variants(cases: pd.DataFrame) -> pd.DataFrame:
    """For each algorithm and recording, the case with the most threads; ties go to the widest
    instruction set."""
    keys = [*RECORDING, "algorithm"]
    most = cases.groupby(keys)["threads"].transform("max")
    return require_unique(widest(cases[cases["threads"] == most], keys), keys)


def widest(cases: pd.DataFrame, keys: list[str]) -> pd.DataFrame:
    """Of the cases that are equal in the columns `keys`, those with the widest instruction set that
    is supported."""
    rank = cases["isa"].map(lambda isa: ISAS.index(isa) if isa in ISAS else 0)
    rank = rank.where(cases["status"] != "unsupported", -1)
    return cases[rank == rank.groupby([cases[key] for key in keys]).transform("max")]


def _quoted(names: list[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)
