"""Shows results files as a table, or writes them as one CSV table.

Reads JSON and JSON Lines of any version, several files at once.
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
    parser.add_argument("--csv", metavar="FILE", help="write all columns of the cases")
    parser.add_argument("--csv-frames", metavar="FILE", help="write a row per frame")


def main(options: argparse.Namespace) -> None:
    results = selection.read_selected(options)
    if options.csv:
        results.cases.to_csv(options.csv, index=False)
    if options.csv_frames:
        results.frames.to_csv(options.csv_frames, index=False)
    if not options.csv and not options.csv_frames:
        with pd.option_context("display.width", 200):
            print(results.cases[COLUMNS].to_string(index=False))
