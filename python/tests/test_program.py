"""Tests of calls of the program and of the package's command line."""

from __future__ import annotations

import importlib.util
import inspect
import json
import pathlib
import subprocess
import sys
from typing import Any

import numpy as np
import pandas as pd
import pytest
from synthetic_results import case, write

import broadmark
from broadmark.commands import COMMANDS
from broadmark.program import call, find_program, request_file


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


def test_arrays_with_absent_bodies_are_run() -> None:
    boxes = np.array([[[0, 0, 0], [1, 1, 1]], [[1, 1, 1], [2, 2, 2]]], np.float32)
    gone = np.stack([boxes[0], broadmark.EMPTY_BOX])
    results = broadmark.run([boxes, gone, boxes], algorithm="bf,tide")
    assert list(results.frames["pairs"]) == [0, 1] * 2
    assert set(results.cases["status"]) == {"ok"}


def test_the_arguments_of_run_are_the_keys_of_run_requests() -> None:
    with request_file(no_such_key=1) as path, pytest.raises(broadmark.InputError) as refused:
        call("--headless", "--request", path)
    keys = str(refused.value).partition("(one of: ")[2].rstrip(")").split(", ")
    own = {"show"} | set(inspect.signature(broadmark.run).parameters) - set(keys)
    assert own == {"show"}
    assert set(keys) - set(inspect.signature(broadmark.run).parameters) == {"jsonl"}  # read back


def test_errors_are_value_errors() -> None:
    with pytest.raises(ValueError, match="no-such"):
        broadmark.run("brownian", algorithm="no-such")


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
    pd.testing.assert_frame_equal(pd.read_csv(frames), pd.read_csv(small_results / "frames.csv"))
    status, out, _ = command("read", small_results / "results.json", "--csv-frames", "-")
    assert status == 0 and out == frames.read_text()


def test_parquet_needs_pyarrow(
    small_results: pathlib.Path, tmp_path: pathlib.Path, command: Any
) -> None:
    file = tmp_path / "frames.parquet"
    status, _, error = command("read", small_results / "results.json", "--parquet-frames", file)
    if importlib.util.find_spec("pyarrow") is None:
        assert status == 2 and "pyarrow" in error and not file.exists()
    else:
        frames = pd.read_parquet(file)
        assert list(frames) == list(pd.read_csv(small_results / "frames.csv"))
        assert status == 0 and frames["objects"].mean() == 150


def cases_for_everything() -> list[dict[str, Any]]:
    more = {"vectorised": False, "differences": []}
    return [case("Brownian", n, "kd", 1e-4, **more) for n in (1000, 4000)]


CAMPAIGN = {
    "schema": "broadmark-campaign/1",
    "recordings": [{"scenes": "brownian", "objects": 40, "frames": 2}],
    "algorithm": ["kd"],
}


OUTPUTS = [
    *(("read", "--csv={}"), ("read", "--csv-frames={}"), ("table2", "-o{}"), ("claims", "-o{}")),
    *(("plot bars", "-o{}.svg"), ("report --no-pictures", "-o{}"), ("history", "--json={}")),
    *(("history", "-o{}.svg"), ("figures", "-o{}"), ("campaign", "-o{}")),
]
WRITE_FOLDERS = ("figures", "campaign")


@pytest.mark.parametrize(
    ("name", "option", "place"),
    [
        (name, option, place)
        for name, option in OUTPUTS
        for place in ("missing/out", "file/out", "folder")
        if place == "file/out" or name not in WRITE_FOLDERS
    ],
)
def test_unwritable_outputs_are_status_2(
    name: str, option: str, place: str, tmp_path: pathlib.Path, command: Any
) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder.svg").mkdir()
    source = write(tmp_path / "r.json", cases_for_everything())
    if name == "campaign":
        source = tmp_path / "c.json"
        source.write_text(json.dumps(CAMPAIGN))
    words = [*name.split(), source, option.format(tmp_path / place)]
    status, _, error = command(*words)
    assert status == 2, (words, error)
    last = error.splitlines()[-1]
    assert last.startswith("broadmark: ") and place in last and "Traceback" not in error


@pytest.mark.parametrize(
    ("words", "begins"),
    [
        (["read", "--csv"], "case,id"),
        (["table2", "-o"], "A processor"),
        (["claims", "-o"], "Comparisons are judged"),
        (["plot", "bars", "-o"], "<?xml"),
        (["report", "--no-pictures", "-o"], "<!DOCTYPE html>"),
        (["history", "--json"], "{"),
    ],
)
def test_a_dash_is_standard_output(
    words: list[str],
    begins: str,
    tmp_path: pathlib.Path,
    command: Any,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "r.json", cases_for_everything())
    arguments = [words[0], *words[1:-1], "r.json", words[-1], "-"]
    status, out, _ = command(*arguments)
    assert status == 0 and out.startswith(begins), out[:200]
    assert [path.name for path in tmp_path.iterdir()] == ["r.json"]


def test_short_times_keep_their_digits(tmp_path: pathlib.Path, command: Any) -> None:
    path = write(tmp_path / "r.json", [case("FreeFall", 1000, "kd", 5.25e-6)])
    assert "5.25e-06" in command("read", path)[1]
