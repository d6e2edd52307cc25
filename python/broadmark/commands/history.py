"""Follows cases over the commits: a line per machine, and where times or counts changed.

Prints the changes: case, machine, commit, level before and after, ratio with its interval. With -o it
draws a panel per case, a page per scene. RESULTS are files, and folders with results at any depth.

The commit of a file is 'commit' in its environment, with 'commit_date', or with --git that in its path,
such as results/1a2b3c4.json. Without commits the files are in the order of their runs.

Each time is judged relative to the other cases of its run, as by `broadmark compare`: a change of the
machine is no change of the code. Times of other processors, compilers, build types or conditions are on
lines of their own. docs/history.md describes the method.
"""

from __future__ import annotations

import argparse
import functools
import os
import pathlib
import sys

from broadmark import selection
from broadmark.drawing import check_format, draw_pages
from broadmark.errors import InputError
from broadmark.files import report_written, write_text
from broadmark.history.commits import ordered_commits
from broadmark.history.figure import page, pages
from broadmark.history.history import History, history
from broadmark.history.measures import TIME, measure_of
from broadmark.history.tables import csv_text, json_text, text_table
from broadmark.results import NotResultsError, Results, read_results

SUFFIXES = (".json", ".jsonl", ".json.gz", ".jsonl.gz")


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "results",
        nargs="+",
        metavar="RESULTS",
        help="results (.json, .jsonl, also .gz), or folders of results",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="draw an image (.svg, .pdf, .png); '-': SVG to standard output, instead of the table",
    )
    parser.add_argument(
        "--column",
        default=TIME,
        metavar="NAME",
        help="what to follow: time (default; each frame's minimum over the repetitions), or a column "
        "of docs/results.md, such as instructions_per_frame",
    )
    parser.add_argument(
        "--git",
        metavar="DIR",
        help="the repository that the commits are ordered by; files may name theirs in their path",
    )
    parser.add_argument(
        "--margin",
        metavar="SHARE",
        help="ignore changes within this share (default: 5%% for times, 1%% for others)",
    )
    parser.add_argument("--machine", metavar="NAME", help="only machines with this in their label")
    parser.add_argument("--by-host", action="store_true", help="a line for each host name")
    selection.add_case_options(parser)
    parser.add_argument("--filter", metavar="REGEX", help="only cases with a matching id")
    for name, doc in (("json", "lines and changes as JSON"), ("csv", "changes as CSV")):
        parser.add_argument(
            f"--{name}",
            metavar="FILE",
            help=f"{doc}; '-': to standard output, instead of the table",
        )


def main(options: argparse.Namespace) -> None:
    measure = measure_of(options.column)
    margin = measure.margin if options.margin is None else _share("--margin", options.margin)
    if options.output:
        check_format(options.output)
    outputs = (options.json, options.csv, options.output)
    if outputs.count("-") > 1:
        raise InputError("--json, --csv and -o: only one of them can be '-', standard output")
    results = _selected(_read(options.results), options)
    found = history(
        results,
        ordered_commits(results, options.git),
        measure,
        margin=margin,
        by_host=options.by_host,
        machine=options.machine,
    )
    for note in found.notes:
        print(note, file=sys.stderr)
    if "-" not in outputs:
        print(text_table(found), end="")
    for path, text in ((options.json, json_text), (options.csv, csv_text)):
        if path is not None:
            write_text(path, text(found))
    if options.output:
        _draw(found, options.output)


def _read(paths: list[str]) -> Results:
    files: list[str] = []
    optional: set[str] = set()
    for path in paths:
        if not os.path.isdir(path):
            files.append(path)
            continue
        inside = sorted(
            str(file) for file in pathlib.Path(path).rglob("*") if file.name.endswith(SUFFIXES)
        )
        if not inside:
            raise InputError(f"{path}: the folder has no results: expected {', '.join(SUFFIXES)}")
        files += inside
        optional |= set(inside)
    files = list({os.path.realpath(file): file for file in files}.values())

    def skip(path: str | os.PathLike[str], error: NotResultsError) -> bool:
        if path in optional:
            print(f"{error}: left out", file=sys.stderr)
        return path in optional

    results = read_results(*files, skip=skip)
    for path in results.partial:
        print(f"{path}: partial results: the run was not finished", file=sys.stderr)
    return results


def _selected(results: Results, options: argparse.Namespace) -> Results:
    if options.filter is not None and len(results.cases):
        results = results.select(selection.match_ids(results.cases["id"], options.filter))
    if len(results.cases):
        results = results.select(selection.match_cases(results.cases, options))
    if not len(results.cases):
        raise InputError("no case is left: change --filter, --scene, --algorithm or --objects")
    return results


def _share(name: str, text: str) -> float:
    try:
        value = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    except ValueError:
        value = -1
    if not 0 <= value < 1:
        raise InputError(f"{name} '{text}': expected a share from 0 to 1, such as 0.05 or 5%")
    return value


def _draw(found: History, path: str) -> None:
    drawn = [(title, functools.partial(page, found, title, ids)) for title, ids in pages(found)]
    for written in draw_pages(path, drawn):
        report_written(written)
