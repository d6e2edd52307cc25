"""Tests of calls of the program and of the package's command line."""

from __future__ import annotations

import importlib.util
import inspect
import json
import os
import pathlib
import stat
import subprocess
import sys
import tempfile
from typing import Any

import numpy as np
import pandas as pd
import pytest
from conftest import SOURCE_FOLDER
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


def test_recordings_are_run(tmp_path: pathlib.Path) -> None:
    boxes = np.array([[[0, 0, 0], [1, 1, 1]], [[1, 1, 1], [2, 2, 2]]], np.float32)
    groups = broadmark.Groups(tags=np.array([[7, *[2**32 - 1] * 2]] * 2, np.uint32))
    for name in ("own.aabbs", "own.broadmark"):
        path = tmp_path / name
        of_all = groups if path.suffix == ".broadmark" else None
        named: dict[str, Any] = {"name": "Own", "object_type": "Things"}
        broadmark.write_recording(path, [boxes] * 3, groups=of_all, **named)
        passed = broadmark.run(broadmark.read_recording(path), algorithm="bf")
        by_path = broadmark.run(path, algorithm="bf")
        for column in ("id", "scene", "object_type", "recording_hash", "pairs_mean"):
            assert passed.cases[column][0] == by_path.cases[column][0], (name, column)
        assert passed.cases["recording_file"][0] == "boxes from Python"
    with tempfile.TemporaryDirectory() as folder:
        options: dict[str, Any] = {"objects": 20, "frames": 2, "record": folder}
        broadmark.run("freefall", algorithm="none", recorder="posrot", **options)
        (path,) = pathlib.Path(folder).rglob("*.posrot")
        with pytest.raises(broadmark.InputError, match="of poses: pass the path of its file"):
            broadmark.run(broadmark.read_recording(path))


def test_boxes_have_no_path(tmp_path: pathlib.Path) -> None:
    boxes = np.array([[[[0, 0, 0], [1, 1, 1]]]] * 3, np.float32)
    results = broadmark.run(boxes, algorithm="bf,kd")
    assert set(results.cases["recording_file"]) == {"boxes from Python"}
    assert set(results.cases["file"]) == {"run(boxes from Python)"}
    results.save(tmp_path / "saved.json")
    text = (tmp_path / "saved.json").read_text()
    assert tempfile.gettempdir() + "/broadmark-" not in text + str(results)
    assert '"options":["--algorithm=bf,kd","--headless","--quiet"]' in text
    scene = broadmark.run("brownian", algorithm="bf", objects=9, frames=1)
    assert list(scene.files["file"]) == ["run(brownian)"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"objects": 500}, "objects: for scenes, but the source is boxes"),
        ({"engine": "kinematic"}, "engine: for scenes"),
        ({"json": "-"}, "json: '-', standard output, needs show=True"),
        ({"csv_frames": "-"}, "csv_frames: '-', standard output, needs show=True"),
    ],
)
def test_options_without_effect_are_errors(options: dict[str, Any], message: str) -> None:
    boxes = np.array([[[[0, 0, 0], [1, 1, 1]]]] * 3, np.float32)
    with pytest.raises(broadmark.InputError, match=message):
        broadmark.run(boxes, algorithm="bf", **options)


def test_a_single_set_of_boxes_is_an_error_without_a_path() -> None:
    boxes = np.array([[[[0, 0, 0], [1, 1, 1]]]], np.float32)
    with pytest.raises(broadmark.InputError, match="^boxes: expected at least 2 sets, .* got 1$"):
        broadmark.run(boxes)


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


def test_cases_are_chosen_before_they_are_shown(small_results: pathlib.Path, command: Any) -> None:
    options = ["--scene", "freefall", "--algorithm", "kd,bf", "--objects", "100"]
    status, out, _ = command("read", small_results / "results.json", *options)
    lines = out.splitlines()[1:]
    assert status == 0 and {line.split()[3] for line in lines} == {"kd", "bf"}
    assert {(line.split()[0], line.split()[2]) for line in lines} == {("FreeFall", "100")}
    status, _, error = command("read", small_results / "results.json", "--scene", "no-such")
    assert status == 2 and "'no-such': matches none of 'Brownian', 'FreeFall'" in error


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


def test_links_are_kept_and_their_targets_replaced(tmp_path: pathlib.Path, command: Any) -> None:
    source = write(tmp_path / "r.json", cases_for_everything())
    (tmp_path / "folder").mkdir()
    target, link = tmp_path / "folder" / "target.csv", tmp_path / "link.csv"
    link.symlink_to("folder/target.csv")
    for old in (None, "old"):  # the target need not exist
        if old:
            target.write_text(old)
        assert command("read", source, "--csv", link)[0] == 0
        assert link.is_symlink() and target.read_text().startswith("case,id")
    assert sorted(path.name for path in tmp_path.rglob("*")) == [
        *("folder", "link.csv", "r.json", "target.csv")
    ]


@pytest.mark.parametrize("is_link", [False, True])
def test_what_is_not_a_file_is_not_replaced(
    is_link: bool, tmp_path: pathlib.Path, command: Any
) -> None:
    source = write(tmp_path / "r.json", cases_for_everything())
    fifo = path = tmp_path / "fifo"
    os.mkfifo(fifo)
    if is_link:
        path = tmp_path / "link"
        path.symlink_to(fifo)
    status, out, error = command("read", source, "--csv", path)
    assert (status, out) == (2, "") and fifo.is_fifo() and path.is_symlink() == is_link
    assert error == f"broadmark: {path}: cannot be written: not a regular file\n"


@pytest.fixture
def full_device(tmp_path: pathlib.Path) -> pathlib.Path:
    """A private copy of /dev/full."""
    path = tmp_path / "full"
    try:
        os.mknod(path, stat.S_IFCHR | 0o600, os.makedev(1, 7))
    except PermissionError:
        pytest.skip("needs the right to make a device")
    return path


def run_package(*words: Any, stdout: Any) -> tuple[int, str]:
    """Exit status and standard error of a command of the package in a process of its own."""
    command = [sys.executable, "-m", "broadmark", *map(str, words)]
    environment = os.environ | {"PYTHONPATH": str(SOURCE_FOLDER / "python")}
    done = subprocess.run(
        command, stdout=stdout, stderr=subprocess.PIPE, text=True, check=False, env=environment
    )
    return done.returncode, done.stderr


OUTPUT_COMMANDS = ["--help", "read", "read --csv=-", "table", "report --no-pictures -o-"]


@pytest.mark.parametrize("words", OUTPUT_COMMANDS)
def test_a_full_output_is_an_error(
    words: str, full_device: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    source = [] if words == "--help" else [write(tmp_path / "r.json", cases_for_everything())]
    name, *options = words.split()
    with open(full_device, "wb") as full:
        status, error = run_package(name, *source, *options, stdout=full)
    full_error = "broadmark: standard output: cannot be written: No space left on device\n"
    assert (status, error) == (2, full_error)


@pytest.mark.parametrize("words", OUTPUT_COMMANDS)
def test_a_closed_pipe_ends_silently(words: str, tmp_path: pathlib.Path) -> None:
    source = [] if words == "--help" else [write(tmp_path / "r.json", cases_for_everything())]
    name, *options = words.split()
    reader, writer = os.pipe()
    os.close(reader)
    try:
        assert run_package(name, *source, *options, stdout=writer) == (0, "")
    finally:
        os.close(writer)


def test_a_closed_output_is_an_error() -> None:
    package = [sys.executable, "-m", "broadmark", "--help"]
    environment = os.environ | {"PYTHONPATH": str(SOURCE_FOLDER / "python")}
    closed = ["bash", "-c", 'exec "$@" >&-', "bash", *package]
    done = subprocess.run(closed, capture_output=True, text=True, check=False, env=environment)
    closed_error = "broadmark: standard output: cannot be written: Bad file descriptor\n"
    assert (done.returncode, done.stderr) == (2, closed_error)


def test_pages_do_not_fit_standard_output(
    tmp_path: pathlib.Path, command: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    scenes = ("Brownian", "FreeFall", "Gravity")
    names = [f"algorithm{i}" for i in range(60)]
    more = {"vectorised": False, "differences": []}
    many = [case(scene, 1000, name, 1e-4, **more) for scene in scenes for name in names]
    write(tmp_path / "r.json", many)
    advice = "standard output takes one page, not 3: name a file (a .pdf has all), or choose with --scene"
    for words in (["plot", "bars"], ["history"]):
        status, out, error = command(*words, "r.json", "-o", "-")
        assert (status, out) == (2, "") and f"broadmark: -o -: {advice}" in error
        status, out, error = command(*words, "r.json", "-o", "-", "--scene", "gravity")
        assert status == 0 and out.startswith("<?xml") and "written" not in out
    status, _, error = command("figures", "r.json", "-o", "-")
    assert status == 2 and error == "broadmark: -o -: expected a folder, not standard output\n"
    assert [path.name for path in tmp_path.iterdir()] == ["r.json"]


def test_short_times_keep_their_digits(tmp_path: pathlib.Path, command: Any) -> None:
    path = write(tmp_path / "r.json", [case("FreeFall", 1000, "kd", 5.25e-6)])
    assert "5.25e-06" in command("read", path)[1]
