"""Shows results files as a table, or writes them as CSV or Parquet.

Reads several files of any version, JSON or JSON Lines. Tables of frames have the columns of the
program's --csv-frames.
"""

from __future__ import annotations

import argparse
import importlib.util
import io

import pandas as pd

from broadmark import selection
from broadmark.errors import InputError
from broadmark.files import write_bytes
from broadmark.results import SHORT


def add_options(parser: argparse.ArgumentParser) -> None:
    selection.add_options(parser)
    selection.add_case_options(parser)
    for kind in ("CSV", "Parquet"):
        name = kind.lower()
        parser.add_argument(
            f"--{name}", metavar="FILE", help=f"write all columns of the cases as {kind}"
        )
        parser.add_argument(
            f"--{name}-frames", metavar="FILE", help=f"write a row per frame as {kind}"
        )


def main(options: argparse.Namespace) -> None:
    results = selection.select_cases(selection.read_selected(options), options)
    written = False
    for format_, cases, frames in (
        (_csv, options.csv, options.csv_frames),
        (_parquet, options.parquet, options.parquet_frames),
    ):
        if cases is not None:
            write_bytes(cases, format_(results.cases))
        if frames is not None:
            write_bytes(frames, format_(results.frames.drop(columns="case")))
        written |= cases is not None or frames is not None
    if not written:
        with pd.option_context("display.width", 200, "display.float_format", "{:.6g}".format):
            print(results.cases[SHORT].to_string(index=False))


def _csv(table: pd.DataFrame) -> bytes:
    flags = table.select_dtypes(bool)
    text: str = table.assign(**flags.astype(int)).to_csv(index=False)
    return text.encode()


def _parquet(table: pd.DataFrame) -> bytes:
    if importlib.util.find_spec("pyarrow") is None:
        raise InputError("Parquet needs the Python package pyarrow, which is not installed")
    stream = io.BytesIO()
    table.to_parquet(stream, engine="pyarrow", index=False)
    return stream.getvalue()
