"""Tests of calls of the program and of the package's command line."""

from __future__ import annotations

import pathlib
import subprocess
import sys
from typing import Any

import numpy as np
import pandas as pd
import pytest

import broadmark
from broadmark.commands import COMMANDS
from broadmark.program import call, find_program


def test_a_scene_is_run_with_any_options() -> None:
    results = broadmark.run("brownian", algorithm=["sap", "kd"], objects=[20, 40], frames=3, seed=2)
    assert set(results.cases["scene"] + " " + results.cases["algorithm"]) == {
        "Brownian sap",
        "Brownian kd",
    }
    assert sorted(results.cases["objects"]) == [20, 20, 40, 40]
    assert set(results.cases["seed"]) == {2}
    assert set(results.cases["status"]) == {"ok"}


def test_arrays_are_run() -> None:
    touching = np.array([[[0, 0, 0], [1, 1, 1]], [[1, 1, 1], [2, 2, 2]], [[3, 0, 0], [4, 1, 1]]])
    results = broadmark.run([touching] * 4, algorithm="bf,sap,grid-sap")
    assert list(results.frames["pairs"]) == [1] * 9  # the first array is the initial pose
    assert set(results.cases["status"]) == {"ok"}


def test_what_is_no_array_is_an_error() -> None:
    source: Any = 5
    with pytest.raises(broadmark.InputError, match="expected an array or arrays, not type int"):
        broadmark.run(source)


def test_the_version_is_that_of_the_program() -> None:
    assert call("--version").split()[0] == broadmark.__version__
    command = [sys.executable, "-m", "broadmark", "--version"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert said == f"broadmark {broadmark.__version__}; the program: {find_program()}\n"


def test_a_wrong_answer_is_a_status_not_an_exception(faulty_plugin: str) -> None:
    results = broadmark.run(
        "brownian", plugin=faulty_plugin, algorithm="faulty", objects=200, frames=300
    )
    assert list(results.cases["status"]) == ["mismatch"]
    assert results.frames["missed"].sum() == results.cases["missed"].sum() > 0


def test_errors_have_the_programs_message() -> None:
    with pytest.raises(broadmark.InputError, match="no-such"):
        broadmark.run("brownian", algorithm="no-such")


def test_a_missing_program_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("BROADMARK", "/there/is/no/such")
    with pytest.raises(broadmark.InputError, match="BROADMARK is '/there/is/no/such'"):
        broadmark.run("brownian")


def test_every_command_has_help(command: Any) -> None:
    status, out, _ = command("--help")
    assert status == 0
    for name in COMMANDS:
        assert f"\n    {name} " in out
        status, text, _ = command(name, "--help")
        assert status == 0 and f"usage: python3 -m broadmark {name}" in text


def test_bad_usage_is_status_2(command: Any) -> None:
    assert command("no-such")[0] == 2
    assert command("read", "/there/is/no/such.json")[0] == 2


def test_results_are_shown_and_written(
    small_results: pathlib.Path, tmp_path: pathlib.Path, command: Any
) -> None:
    status, out, _ = command("read", small_results / "results.json")
    assert status == 0 and "sap-mt" in out and "dbvt" not in out
    cases, frames = tmp_path / "cases.csv", tmp_path / "frames.csv"
    assert (
        command("read", small_results / "results.json", "--csv", cases, "--csv-frames", frames)[0]
        == 0
    )
    assert len(pd.read_csv(cases)) == len(pd.read_csv(small_results / "results.csv"))
    assert len(pd.read_csv(frames)) == len(pd.read_csv(small_results / "frames.csv"))
