"""Common fixtures of the tests."""

from __future__ import annotations

import pathlib
import sys
from collections.abc import Callable

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from broadmark.__main__ import main  # noqa: E402
from broadmark.program import call, find_program  # noqa: E402

SOURCE_FOLDER = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def small_results(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """A folder with results of a small run in every format: results.json, .jsonl, .csv, frames.csv."""
    folder = tmp_path_factory.mktemp("results")
    call(
        *("--headless", "brownian", "freefall", "--objects", "100,200", "--frames", "4", "--quiet"),
        *("--algorithm", "bf,sap-mt,kd,none", "--threads", "1,2", "--repetitions", "2"),
        *("--time-limit", "60"),  # on a busy machine, too
        *("--json", str(folder / "results.json"), "--jsonl", str(folder / "results.jsonl")),
        *("--csv", str(folder / "results.csv"), "--csv-frames", str(folder / "frames.csv")),
        accept=(0, 1, 4),
    )
    return folder


@pytest.fixture
def command(capfd: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, str, str]]:
    """Runs a command of the package; returns exit status, standard output and standard error."""

    def run_command(*arguments: object) -> tuple[int, str, str]:
        try:
            status = main([str(argument) for argument in arguments])
        except SystemExit as end:  # argparse
            status = int(end.code or 0)
        out, err = capfd.readouterr()
        return status, out, err

    return run_command


@pytest.fixture(scope="session")
def faulty_plugin() -> str:
    """A plug-in with the deliberately wrong algorithm `faulty`."""
    return library_of_tests("libfaulty_algorithm.so")


@pytest.fixture(scope="session")
def engine_plugin() -> str:
    """A plug-in with the physics engine `drift`."""
    return library_of_tests("libmy_engine.so")


@pytest.fixture(scope="session")
def fault_injection() -> str:
    """A library that makes system calls fail (tests/support/fault_injection.cpp)."""
    return library_of_tests("libfault_injection.so")


def library_of_tests(name: str) -> str:
    plugin = pathlib.Path(find_program()).parent / "tests" / name
    if not plugin.exists():
        pytest.skip("the tests' libraries are built in the checkout, without sanitizers")
    return str(plugin)
