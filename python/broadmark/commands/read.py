"""Shows results files as a table, or writes them as CSV.

Reads several files of any version, JSON or JSON Lines.
"""

from __future__ import annotations

import argparse

import pandas as pd

from broadmark import selection

COLUMNS = [
    *("scene", "object_type", "objects", "algorithm", "isa", "threads", "params"),
    *("seconds_per_frame", "pairs_mean", "status"),
]


def add_options(parser: argparse.ArgumentParser) -> None:
    selection.add_options(parser)
    parser.add_argument("--csv", metavar="FILE", help="write all columns of the cases as CSV")
    parser.add_argument("--csv-frames", metavar="FILE", help="write a row per frame as CSV")


def main(options: argparse.Namespace) -> None:
    results = selection.read_selected(options)
    if options.csv:
        results.cases.to_csv(options.csv, index=False)
    if options.csv_frames:
        results.frames.to_csv(options.csv_frames, index=False)
    if not options.csv and not options.csv_frames:
        with pd.option_context("display.width", 200):
            print(results.cases[COLUMNS].to_string(index=False))
