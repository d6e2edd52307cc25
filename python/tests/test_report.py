"""Tests of the report's file and data."""

from __future__ import annotations

import base64
import json
import pathlib
import re
import shlex
from typing import Any

import numpy as np
import pytest
from conftest import SOURCE_FOLDER
from report_results import case, standard_cases, write_results

import broadmark
from broadmark.program import call
from broadmark.report import page, write_report
from broadmark.report.data import page_data
from broadmark.report.timelines import points_per_case, timeline


def data_of(tmp_path: pathlib.Path, *cases: dict[str, Any]) -> dict[str, Any]:
    return page_data(broadmark.read_results(write_results(tmp_path / "results.jsonl", list(cases))))


def texts(column: dict[str, Any]) -> list[str]:
    return [column["texts"][code] for code in column["codes"]]


def test_the_command_writes_a_single_file(
    small_results: pathlib.Path, tmp_path: pathlib.Path, command: Any
) -> None:
    report = tmp_path / "a report.html"
    status, out, _ = command("report", small_results / "results.json", "-o", report)
    assert status == 0
    assert re.search(r"written: .*a report\.html \(\d\.\d MB, \d+ cases\)", out)
    assert [path.name for path in tmp_path.iterdir()] == ["a report.html"]
    text = report.read_text("utf-8")
    assert "default-src 'none'" in text and "d3js.org v5" in text and "BSD-3-Clause" in text
    data = json.loads(text.partition('id="data">')[2].partition("</script>")[0])
    assert len(data["pictures"]) == 2  # of Brownian and FreeFall
    assert base64.b64decode(data["pictures"][0]["uri"].partition(",")[2]).startswith(b"\x89PNG")


def test_options_select_cases(tmp_path: pathlib.Path, command: Any) -> None:
    results = write_results(tmp_path / "r.jsonl", [case(a, 100, 1e-5) for a in ("kd", "sap")])
    report = tmp_path / "report.html"
    status, out, _ = command("report", results, "-o", report, "--no-pictures", "--filter", "/kd$")
    assert status == 0 and "1 cases" in out
    text = report.read_text("utf-8").partition('id="data">')[2]
    data = json.loads(text.partition("</script>")[0])
    assert data["columns"]["algorithm"]["texts"] == ["kd"]
    status, _, err = command("report", results, "--filter", "nothing")
    assert status == 2 and "--filter" in err


def test_without_the_program_there_are_no_pictures(
    tmp_path: pathlib.Path, command: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("BROADMARK", "/there/is/no/such")
    results = write_results(tmp_path / "results.jsonl", standard_cases())
    report = tmp_path / "report.html"
    status, out, _ = command("report", results, "-o", report)
    assert status == 0 and "No pictures of the scenes" in out
    status, out, _ = command("report", results, "-o", report, "--no-pictures")
    assert status == 0 and "No pictures" not in out


def test_a_missing_recording_has_no_picture(tmp_path: pathlib.Path) -> None:
    result = case("sap", 100, 1e-5)
    result["recording"]["source"] = "gone.aabbs"
    results = broadmark.read_results(write_results(tmp_path / "results.jsonl", [result]))
    notes = write_report(results, tmp_path / "report.html")
    assert len(notes) == 1 and notes[0].startswith("Brownian Cubes: no picture")


def test_absent_pictures_have_their_reason(tmp_path: pathlib.Path) -> None:
    def notes_of(source: Any, objects: int = 100) -> list[str]:
        result = case("sap", objects, 1e-5)
        result["recording"]["source"] = source
        path = write_results(tmp_path / "results.jsonl", [result])
        return write_report(broadmark.read_results(path), tmp_path / "report.html")

    assert notes_of("gone.aabbs") == ["Brownian Cubes: no picture: gone.aabbs: no such file."]
    quick = {"objects": "1000000", "frames": "4", "seed": "1"}
    (note,) = notes_of(quick, 1_000_000)
    assert note == "Brownian Cubes: no picture: too large to be drawn quickly."
    boxes = np.array([[[[0, 0, 0], [1, 1, 1]]]] * 3, np.float32)
    (note,) = write_report(broadmark.run(boxes, algorithm="bf"), tmp_path / "report.html")
    assert note == "Custom Boxes: no picture: its boxes were passed from Python."
    np.save(tmp_path / "boxes.npy", boxes)
    imported = broadmark.run(tmp_path / "boxes.npy", algorithm="bf")
    assert write_report(imported, tmp_path / "report.html") == []


def test_files_that_are_not_compared_have_their_names(tmp_path: pathlib.Path) -> None:
    files = [
        write_results(tmp_path / f"{cpu}.jsonl", [case("kd", 100, 1e-5)], cpu=cpu)
        for cpu in ("one", "two")
    ]
    results = broadmark.read_results(*files)
    (note,) = write_report(results, tmp_path / "report.html", pictures=False)
    assert note.startswith(f"The two files are not compared: {files[0]}: environments[0]: ")
    assert "before.json" not in note


def test_a_missing_d3_names_its_package(
    tmp_path: pathlib.Path, command: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    results = write_results(tmp_path / "results.jsonl", standard_cases())
    monkeypatch.setattr(page, "D3", tmp_path / "no.js")
    status, _, error = command("report", results, "-o", tmp_path / "report.html")
    assert status == 2 and "node-d3" in error
    assert [path.name for path in tmp_path.iterdir()] == ["results.jsonl"]


def test_commands_run_the_case_again(small_results: pathlib.Path, tmp_path: pathlib.Path) -> None:
    results = broadmark.read_results(small_results / "results.json")
    is_kd = results.cases["id"].str.startswith("FreeFall/Cubes/N200/F4/s1/kd/")
    (number,) = results.cases.index[is_kd][:1]
    data = page_data(results)
    columns = data["columns"]
    recording = data["recordings"][columns["recording"][number]]
    condition = texts(columns["condition_command"])[number]
    assert "--repetitions 2" in condition and "--check full" in condition
    commands = [
        f"{recording['command']} {texts(columns['variant_command'])[number]} {condition}",
        f"{texts(columns['again_command'])[number]} {condition}",
    ]
    for i, line in enumerate(commands):
        file = tmp_path / f"again{i}.json"
        call("--headless", *shlex.split(line), "--quiet", "--json", str(file))
        (again,) = broadmark.read_results(file).cases.to_dict("records")
        for column in ("algorithm", "recording_hash", "params", "isa", "threads", "repetitions"):
            assert again[column] == results.cases[column][number], column


def test_paths_are_relative_to_the_page(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A results file names its recording and plug-in relative to its own folder."""
    folder = tmp_path / "runs"
    folder.mkdir()
    for name in ("boxes.aabbs", "mine.so", "pairs.csv"):
        (folder / name).touch()
    cases = [
        case("mine", 100, 1e-5, plugin="mine.so"),
        case("logged", 100, 1e-5, plugin="pairs:pairs.csv"),
    ]
    for result in cases:
        result["recording"]["source"] = "boxes.aabbs"
    write_results(folder / "r.jsonl", cases)
    monkeypatch.chdir(tmp_path)
    columns = page_data(broadmark.read_results("runs/r.jsonl"))["columns"]
    for part in ("variant_command", "again_command"):
        mine, logged = texts(columns[part])
        assert "--plugin runs/mine.so" in mine and "--plugin pairs:runs/pairs.csv" in logged


def test_cases_that_need_files_have_no_address(tmp_path: pathlib.Path) -> None:
    cases = [case(name, 100, 1e-5) for name in ("sap", "kd", "mine", "gpu")]
    cases[1]["recording"] = {**cases[1]["recording"], "source": "boxes.aabbs"}
    cases[2]["plugin"] = "mine.so"
    cases[3]["device"] = "a GPU"
    results = broadmark.read_results(write_results(tmp_path / "results.jsonl", cases))
    assert "address" not in page_data(results)["columns"]
    addresses = texts(page_data(results, program_page="https://example.org")["columns"]["address"])
    assert addresses[0].startswith("brownian&--objects&100&") and addresses[1:] == [""] * 3


def test_variants_are_labelled_by_differing_traits(tmp_path: pathlib.Path) -> None:
    data = data_of(
        tmp_path,
        case("sap", 100, 1e-5),
        case("kd", 100, 1e-5, params={"leaf": "64", "margin": "0"}),
        case("kd", 100, 1e-5, params={"leaf": "128", "margin": "0"}),
        case("kd-mt", 100, 1e-5, threads=1),
        case("kd-mt", 100, 1e-5, threads=2),
        case("mine", 100, 1e-5, plugin="a/old.so"),
        case("mine", 100, 1e-5, plugin="a/new.so"),
    )
    assert texts(data["columns"]["variant"]) == [
        *("sap", "kd/leaf=64", "kd/leaf=128", "kd-mt/t1", "kd-mt/t2"),
        *("old.so:mine", "new.so:mine"),
    ]
    assert list(data["parameters"]) == ["leaf"]


def test_recordings_are_labelled_by_differing_settings(tmp_path: pathlib.Path) -> None:
    def case_on(objects: int, recording_hash: str, **source: str) -> dict[str, Any]:
        result = case("sap", objects, 1e-5)
        result["recording"] |= {"hash": recording_hash, "frames": int(source["frames"])}
        result["recording"]["source"] = {"objects": str(objects)} | source
        return result

    seeds = data_of(
        tmp_path, case_on(1, "a", frames="4", seed="1"), case_on(2, "b", frames="4", seed="2")
    )
    assert [recording["setting"] for recording in seeds["recordings"]] == ["seed=1", "seed=2"]
    sizes = data_of(tmp_path, case_on(1, "a", frames="4"), case_on(2, "b", frames="8"))
    assert [recording["setting"] for recording in sizes["recordings"]] == ["", ""]
    frames = data_of(tmp_path, case_on(1, "a", frames="4"), case_on(1, "b", frames="8"))
    assert [recording["setting"] for recording in frames["recordings"]] == ["4 frames", "8 frames"]
    unlike = data_of(tmp_path, case_on(1, "a1", frames="4"), case_on(1, "b2", frames="4"))
    assert [recording["setting"] for recording in unlike["recordings"]] == [
        "recording a1",
        "recording b2",
    ]


def test_timeline_points_are_means_of_medians() -> None:
    result = case("sap", 100, 1e-6)
    frames = np.arange(1000.0)
    for phase in result["frames"]:
        result["frames"][phase] = [frames, frames + 2, frames + 1000, frames[:3]]
    result["frame_counts"]["pairs"] = frames
    line = timeline(result, 200)
    points = np.frombuffer(base64.b64decode(line), "<f4").reshape(5, 200)
    np.testing.assert_allclose(points[0], frames.reshape(200, 5).mean(1) + 2)
    np.testing.assert_allclose(points[4], frames.reshape(200, 5).mean(1))
    assert timeline(case("sap", 100, None), 200) == ""


def test_many_cases_have_fewer_points() -> None:
    assert points_per_case(1) == 200
    assert 20 <= points_per_case(10_000) < 200
    assert points_per_case(10**9) == 20


def test_fuzzed_files_are_reported_or_rejected(tmp_path: pathlib.Path) -> None:
    written = 0
    for file in sorted((SOURCE_FOLDER / "tests/fuzz/corpus/results").iterdir()):
        try:
            write_report(broadmark.read_results(file), tmp_path / "report.html", pictures=False)
            written += 1
        except broadmark.InputError:
            pass
    assert written > 5


def test_empty_results_have_a_page(tmp_path: pathlib.Path, command: Any) -> None:
    results = write_results(tmp_path / "nothing.jsonl", [])
    assert command("report", results, "-o", tmp_path / "report.html")[0] == 0
