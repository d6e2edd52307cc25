"""Tables of results, and those in the documents."""

from __future__ import annotations

import pathlib
import subprocess
import sys
from typing import Any

import pytest
from conftest import SOURCE_FOLDER
from synthetic_results import case, write


pytestmark = pytest.mark.filterwarnings("error")


@pytest.fixture
def results(tmp_path: pathlib.Path) -> pathlib.Path:
    cases = [
        case("Brownian", 1000, "sap", 0.0025, isa="avx2"),
        case("Brownian", 1000, "sap", 0.009),
        case("Brownian", 1000, "sap", isa="avx512", status="unsupported"),
        case("Brownian", 8000, "sap", 0.5, status="timeout"),
        case("Brownian", 1000, "grid-sap-mt", 0.00012345),
        case("Brownian", 8000, "grid-sap-mt", 1.234),
        case("Brownian", 8000, "cgal", 2.468),
        case("Gravity", 1000, "cgal", 0.001),
        case("Gravity", 1000, "none", 0.0001),
    ]
    return write(tmp_path / "r.json", cases)


def lines(command: Any, *arguments: Any) -> list[str]:
    status, out, _ = command("table", *arguments)
    assert status == 0
    return list(out.splitlines())


def test_numbers_have_three_digits_and_the_fastest_comes_first(
    results: pathlib.Path, command: Any
) -> None:
    only = ["--filter", "^(Brownian|Gravity)", "--scene", "Brownian"]
    table = lines(command, results, "--value", "seconds_per_frame", *only)
    assert table[0].startswith("mean, ms; A processor, ")
    assert [line.split() for line in table[1:]] == [
        ["algorithm", "threads", "Brownian", "1,000", "Brownian", "8,000"],
        ["grid-sap-mt", "4", "0.123", "1,230"],
        ["cgal", "1", "–", "2,470"],
        ["sap", "1", "2.50", "timeout"],
    ]


def test_ratios_to_a_row(results: pathlib.Path, command: Any) -> None:
    options = [results, "--value", "seconds_per_frame", "--relative-to", "algorithm=cgal"]
    table = lines(command, *options, "--format", "markdown")
    assert table[:5] == [
        "| algorithm | threads | Brownian 1,000 | Brownian 8,000 | Gravity 1,000 |",
        "| --- | --- | ---: | ---: | ---: |",
        "| `cgal` | 1 | – | 2,470 ms | 1.00 ms |",
        "| `grid-sap-mt` | 4 | – | 0.500 | – |",
        "| `sap` | 1 | – | timeout | – |",
    ]
    assert table[6].startswith("*mean divided by that of cgal 1; A processor, ")


def test_other_rows_columns_and_values(results: pathlib.Path, command: Any) -> None:
    options = ["--rows", "scene,objects", "--columns", "algorithm", "--value", "peak_bytes"]
    table = lines(command, results, *options, "--algorithm", "cgal,sap")
    assert [line.split() for line in table[1:]] == [
        ["scene", "bodies", "sap", "cgal"],
        ["Brownian", "1,000", "4.10", "–"],
        ["Brownian", "8,000", "timeout", "32.8"],
        ["Gravity", "1,000", "–", "4.10"],
    ]


def test_integers_are_exact(tmp_path: pathlib.Path, command: Any) -> None:
    cases = [case("Brownian", n, "sap", 1e-3) for n in (1000, 2000)]
    cases[1]["recording"]["seed"] = 123456
    table = lines(command, write(tmp_path / "r.json", cases), "--value", "seed")
    assert table[-1].split() == ["sap", "1", "1", "123,456"]


@pytest.mark.parametrize(
    "options, message",
    [
        (["--rows", "algoritm"], "'algoritm' is not a column: expected one of id, "),
        (["--value", "scene"], "--value 'scene': expected one of "),
        (["--columns", "scene"], "two cases match, "),
        (
            ["--columns", "scene"],
            ": choose with --scene, --algorithm, --objects or --filter, or add ",
        ),
        (["--relative-to", "algorithm=bf"], "0 rows match, expected one"),
        (["--relative-to", "isa=scalar"], "'isa' is not in --rows algorithm,threads"),
    ],
)
def test_bad_input(results: pathlib.Path, command: Any, options: list[str], message: str) -> None:
    status, _, error = command("table", results, *options)
    assert status == 2 and message in error


def test_the_documents_tables_are_those_of_their_results() -> None:
    script: list[Any] = [sys.executable, SOURCE_FOLDER / "scripts/tables", "--check"]
    done = subprocess.run(script, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
