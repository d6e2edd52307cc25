"""Shows one number per case as a table, with rows and columns of your choice.

    python3 -m broadmark table results.json --columns scene,objects --relative-to algorithm=cgal

Rows and columns are named as in `read --csv`. Times are in milliseconds, memory is in megabytes, with
three digits; integers are exact. A case without the number shows its status. Rows of algorithms are in
ascending order of their number in the last column that they have one in. Self-checks are left out,
and instruction sets narrower than the widest of a cell.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pandas as pd

from broadmark import selection
from broadmark.errors import InputError
from broadmark.files import write_text
from broadmark.results import COLUMNS, NUMBERS, SELF_CHECK_FAMILY, commit_name, is_unknown
from broadmark.text_tables import aligned, markdown_row

TITLES = {column["key"]: column["title"] for column in COLUMNS}
UNITS = {column["key"]: column["unit"] for column in COLUMNS}

#: The units of tables, and how many of the results' units one of them is.
SHOWN_UNITS = {"seconds": ("ms", 1e-3), "bytes": ("MB", 1e6)}

MISSING = "–"

#: How to choose between cases of a cell.
CHOICE = (
    "choose with --scene, --algorithm, --objects or --filter, or add what differs to --rows or "
    "--columns"
)

Key = tuple[Any, ...]  #: the values of the rows' or columns' keys


@dataclass(frozen=True)
class Table:
    caption: str
    headings: list[str]
    names: int  #: the first headings, which name the rows
    rows: list[list[str]]


def add_options(parser: argparse.ArgumentParser) -> None:
    selection.add_options(parser)
    selection.add_case_options(parser)
    keys: dict[str, Any] = {"type": lambda text: text.split(","), "metavar": "KEY[,KEY…]"}
    parser.add_argument(
        "--rows", default=["algorithm", "threads"], help="default: algorithm,threads", **keys
    )
    parser.add_argument(
        "--columns", default=["scene", "objects"], help="default: scene,objects", **keys
    )
    parser.add_argument(
        "--value", metavar="KEY", default="median_seconds", help="default: median_seconds"
    )
    parser.add_argument(
        "--relative-to",
        metavar="KEY=VALUE[,…]",
        help="divide by the row with these values; its own numbers are shown with their unit",
    )
    parser.add_argument("--format", choices=list(FORMATS), default="text", help="default: text")
    parser.add_argument("-o", "--output", metavar="FILE", help="'-', the default: standard output")


def main(options: argparse.Namespace) -> None:
    _, results = selection.read_cases(options)
    cases = results.cases[results.cases["family"] != SELF_CHECK_FAMILY]
    if not len(cases):
        raise InputError("no case is left: only self-checks")
    for key in [*options.rows, *options.columns]:
        if key not in TITLES:
            raise InputError(f"'{key}' is not a column: expected one of {', '.join(TITLES)}")
    if options.value not in NUMBERS:
        raise InputError(f"--value '{options.value}': expected one of {', '.join(NUMBERS)}")
    environment = results.environments.loc[cases["environment"].iloc[0]].to_dict()
    write_text(options.output, FORMATS[options.format](_table(cases, environment, options)))


def _table(cases: pd.DataFrame, environment: dict[str, Any], options: argparse.Namespace) -> Table:
    keys = [*options.rows, *options.columns]
    if "isa" not in keys:
        cases = selection.widest(cases, keys)
    cases = selection.require_unique(cases, keys, CHOICE)
    columns = _in_order(_keys_of(cases, options.columns))
    cells: dict[Key, dict[Key, float | str]] = {}
    for row, column, number, status in zip(
        _keys_of(cases, options.rows),
        _keys_of(cases, options.columns),
        cases[options.value],
        cases["status"],
    ):
        shown = status if status != "ok" or is_unknown(number) else float(number)
        cells.setdefault(row, {})[column] = shown
    rows = _in_order(list(cells))
    if "algorithm" in options.rows:
        rows.sort(key=lambda row: _rank(cells[row], columns))
    unit, scale = SHOWN_UNITS.get(UNITS[options.value], (UNITS[options.value], 1))
    known = cases[options.value].dropna()
    is_integer = not unit and (known == known.round()).all()
    reference = _reference(rows, options)
    base = None if reference is None else cells[reference]

    def text(row: Key, column: Key) -> str:
        number = cells[row].get(column, MISSING)
        if isinstance(number, str):
            return number
        if base is None or row == reference:
            shown = f"{number:,.0f}" if is_integer else _digits(number / scale)
            return shown + (f" {unit}" if base is not None else "")
        divisor = base.get(column)
        return _digits(number / divisor) if isinstance(divisor, float) and divisor else MISSING

    what = TITLES[options.value]
    if base is not None:
        what += " divided by that of " + " ".join(map(_name, reference or ()))
    return Table(
        f"{what}{f', {unit}' if unit and base is None else ''}; {_machine(cases, environment)}",
        [*map(TITLES.__getitem__, options.rows), *(" ".join(map(_name, c)) for c in columns)],
        len(options.rows),
        [[*map(_name, row), *(text(row, column) for column in columns)] for row in rows],
    )


def _keys_of(cases: pd.DataFrame, keys: list[str]) -> list[Key]:
    return list(cases[keys].itertuples(index=False, name=None))


def _in_order(keys: list[Key]) -> list[Key]:
    """Each once: texts in order of appearance, numbers ascending."""
    ranks: list[dict[Any, int]] = []
    for values in zip(*keys):
        distinct = list(dict.fromkeys(values))
        if not any(isinstance(value, str) for value in distinct):
            distinct.sort()
        ranks.append({value: rank for rank, value in enumerate(distinct)})
    return sorted(set(keys), key=lambda key: [rank[value] for rank, value in zip(ranks, key)])


def _rank(cells: dict[Key, float | str], columns: list[Key]) -> tuple[int, float]:
    """The sort key of a row: by the last column in which it has a number."""
    for place, column in enumerate(reversed(columns)):
        number = cells.get(column)
        if isinstance(number, float):
            return place, number
    return len(columns), 0


def _reference(rows: list[Key], options: argparse.Namespace) -> Key | None:
    if options.relative_to is None:
        return None
    wanted = [part.partition("=") for part in options.relative_to.split(",")]
    for key, _, _ in wanted:
        if key not in options.rows:
            raise InputError(f"--relative-to: '{key}' is not in --rows {','.join(options.rows)}")
    found = [
        row
        for row in rows
        if all(str(row[options.rows.index(key)]) == value for key, _, value in wanted)
    ]
    if len(found) != 1:
        raise InputError(
            f"--relative-to {options.relative_to}: {len(found)} rows match, expected one"
        )
    return found[0]


def _machine(cases: pd.DataFrame, environment: dict[str, Any]) -> str:
    parts = [
        f"{environment.get('cpu') or 'unknown processor'}, {environment.get('logical_cores', '?')} cores",
        environment.get("isa", ""),
        environment.get("compiler", ""),
        str(cases["started"].min())[:10],
    ]
    if commit := commit_name(environment):
        parts.append(f"commit {commit}")
    return ", ".join(part for part in parts if part)


def _name(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:,}"


def _digits(value: float) -> str:
    """Three significant digits, without an exponent."""
    value = float(f"{value:.3g}")
    decimals = 0 if value == 0 else max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:,.{decimals}f}"


def _as_text(table: Table) -> str:
    lines = [table.headings, *table.rows]
    return "\n".join([table.caption, *aligned(lines, table.names)]) + "\n"


def _as_markdown(table: Table) -> str:
    rules = ["---"] * table.names + ["---:"] * (len(table.headings) - table.names)
    code = [heading == TITLES["algorithm"] for heading in table.headings]
    rows = [[f"`{cell}`" if c else cell for c, cell in zip(code, row)] for row in table.rows]
    lines = map(markdown_row, [table.headings, rules, *rows])
    return "\n".join([*lines, "", f"*{table.caption}*"]) + "\n"


FORMATS: dict[str, Callable[[Table], str]] = {
    "text": _as_text,
    "markdown": _as_markdown,
}
