"""Tests of results files as data frames."""

from __future__ import annotations

import gzip
import json
import pathlib
from typing import Any

import numpy as np
import pandas as pd
import pytest
from conftest import SOURCE_FOLDER
from synthetic_results import case, write

import broadmark
from broadmark.program import call
from broadmark.results import COLUMNS, without_build


def test_cases_match_the_programs_csv(small_results: pathlib.Path) -> None:
    expected = pd.read_csv(small_results / "results.csv", keep_default_na=False, na_values=[""])
    for name in ("results.json", "results.jsonl"):
        cases = broadmark.read_results(small_results / name).cases
        cases = (
            cases.set_index("id").loc[expected["id"]].reset_index()
        )  # lines are in the order of completion
        for column in expected:
            there = (
                expected[column].fillna("")
                if expected[column].dtype == object or expected[column].isna().all()
                else None
            )
            if there is not None:
                assert list(cases[column].fillna("").astype(str)) == list(there.astype(str)), column
            else:
                np.testing.assert_allclose(
                    cases[column].astype(float), expected[column], rtol=1e-6, err_msg=column
                )


def test_frames_match_the_programs_csv(small_results: pathlib.Path) -> None:
    expected = pd.read_csv(small_results / "frames.csv", keep_default_na=False, na_values=[""])
    frames = broadmark.read_results(small_results / "results.json").frames
    assert len(frames) == len(expected) > 100
    assert list(frames) == ["case", *expected]
    for column in expected:
        there, ours = expected[column].fillna(""), frames[column].astype(object).fillna("")
        assert list(ours) == list(there), column


def test_frames_are_grouped_as_numbers_and_texts(small_results: pathlib.Path) -> None:
    frames = broadmark.read_results(small_results / "results.json").frames
    assert len(frames[frames.objects > 100]) == len(frames) / 2
    assert frames[["objects", "threads", "repetition", "frame"]].mean().notna().all()
    groups = frames.groupby(["scene", "algorithm", "threads"])["total_ns"].mean()
    assert len(groups) == 2 * 5 and groups.notna().all()
    bf = frames[frames.algorithm == "bf"]  # the other algorithms remain categories
    assert list(bf.groupby("algorithm").size().index) == ["bf"]
    assert list(bf.pivot_table("total_ns", "frame", "algorithm")) == ["bf"]
    assert frames.algorithm.dtype == "category" and type(bf.copy()) is type(frames)
    assert list(bf["total_ns"].groupby(bf["algorithm"]).mean().index) == ["bf"]
    assert dict(bf.algorithm.value_counts()) == {"bf": len(bf)}
    assert dict(bf.algorithm.value_counts(normalize=True)) == {"bf": 1}
    assert dict(bf.threads.value_counts()) == {1: len(bf)}


def test_unknown_values_are_nan(small_results: pathlib.Path, tmp_path: pathlib.Path) -> None:
    foreign = case("FreeFall", 1000, "kd", 1e-3, device=None)
    foreign["recording"]["seed"] = None
    path = write(tmp_path / "r.json", [foreign, case("FreeFall", 1000, "sap", 1e-3)])
    for results in (
        broadmark.read_results(path),
        broadmark.read_results(small_results / "results.json"),
    ):
        assert not any(value is None for value in results.cases.to_numpy().ravel())
        numbers = [c["key"] for c in COLUMNS if c["kind"] == "number"]
        assert all(results.cases[name].dtype.kind in "if" for name in numbers)
    assert broadmark.read_results(path).cases.seed.isna().tolist() == [True, False]


def test_builds_of_a_machine_are_told_apart(tmp_path: pathlib.Path, command: Any) -> None:
    files = []
    for number, dirty in enumerate([False, True]):
        builds = [case("Gravity", 1000, "kd", 1e-3), case("Gravity", 4000, "kd", 5e-3)]
        files.append(write(tmp_path / f"{number}.json", builds))
        document = json.loads(files[-1].read_text())
        document["environments"][0] |= {"commit": "0123456789ab" + "c" * 28, "dirty": dirty}
        document["environments"][0] |= {"compiler": "gcc 12", "compiler_flags": " -O3"}
        files[-1].write_text(json.dumps(document))
    assert broadmark.read_results(files[0]).cases.machine[0] == "A processor, 8 cores"
    both = broadmark.read_results(*files)
    environments = both.environments
    assert environments["dirty"].dtype == bool and environments["logical_cores"].dtype == "int64"
    assert list(environments[~environments.dirty].machine) == [environments.machine[0]]
    assert [environments.loc[i].to_dict()["dirty"] is True for i in (0, 1)] == [False, True]
    machines = list(both.cases.machine.unique())
    assert machines == [
        "A processor, 8 cores, commit 0123456789",
        "A processor, 8 cores, commit 0123456789 with changes",
    ]
    assert list(map(without_build, machines)) == ["A processor, 8 cores"] * 2
    for name in ("table2", "claims"):
        status, out, _ = command(name, files[1])
        assert status == 0 and "Commit 0123456789 with changes, gcc 12, -O3" in out


def test_flags_may_be_unknown(tmp_path: pathlib.Path) -> None:
    files = []
    for cpu, dirty in (("old", {}), ("clean", {"dirty": False}), ("changed", {"dirty": True})):
        files.append(write(tmp_path / f"{cpu}.json", [case("Gravity", 1000, "kd", 1e-3)], cpu=cpu))
        document = json.loads(files[-1].read_text())
        document["environments"][0] |= dirty
        files[-1].write_text(json.dumps(document))
    results = broadmark.read_results(*files)
    environments = results.environments
    assert list(environments[environments.dirty].cpu) == ["changed"]
    assert list(environments[~environments.dirty].cpu) == ["clean"]
    results.save(tmp_path / "all.json")
    saved = json.loads((tmp_path / "all.json").read_text())["environments"]
    assert [environment.get("dirty") for environment in saved] == [None, False, True]
    assert [type(environment["logical_cores"]) for environment in saved] == [int] * 3


def test_results_are_shown_shortly(small_results: pathlib.Path) -> None:
    results = broadmark.read_results(small_results / "results.json")
    assert str(results) == repr(results)
    first, algorithms, recordings, *_, file = str(results).splitlines()
    assert first == "20 cases: 20 ok" and algorithms == "3 algorithms: bf, kd, sap-mt"
    assert recordings == "4 recordings: Brownian, FreeFall; 100, 200 bodies"
    assert file == str(small_results / "results.json")
    table = results._repr_html_()
    assert "<table" in table and table.count("<tr") <= 25


def test_results_are_added_and_saved(small_results: pathlib.Path, tmp_path: pathlib.Path) -> None:
    results = broadmark.read_results(small_results / "results.json")
    kd, sap = (results.select(results.cases.algorithm == name) for name in ("kd", "sap-mt"))
    other = broadmark.read_results(write(tmp_path / "r.json", [case("FreeFall", 9, "bf", 1e-3)]))
    both = kd + sap + other
    assert list(both.cases.case) == list(range(4 + 8 + 1)) and both.cases.machine.nunique() == 2
    for name in ("saved.json", "saved.json.gz"):
        both.save(tmp_path / name)
        again = broadmark.read_results(tmp_path / name)
        pd.testing.assert_frame_equal(
            again.cases.drop(columns="file"), both.cases.drop(columns="file")
        )
        pd.testing.assert_frame_equal(again.frames, both.frames)
    (kd + sap).save(tmp_path / "saved.json")
    assert "/kd" in call("merge", str(tmp_path / "saved.json"), "--csv", "-")
    with pytest.raises(broadmark.InputError, match="must be .json or .json.gz"):
        both.save(tmp_path / "saved.csv")


def test_several_files_are_combined(small_results: pathlib.Path, tmp_path: pathlib.Path) -> None:
    paths = [small_results / "results.json", tmp_path / "later.json"]
    document = json.loads(paths[0].read_text())
    for environment in document["environments"]:
        environment["started"] = "2040-01-01T00:00:00Z"
    paths[1].write_text(json.dumps(document))
    both = broadmark.read_results(*paths)
    single = broadmark.read_results(paths[0])
    assert len(both.cases) == 2 * len(single.cases)
    assert list(both.cases.index) == list(both.cases["case"]) == list(range(len(both.cases)))
    assert len(both.environments) == 1  # single machine
    assert both.cases["file"].nunique() == 2
    assert len(both.frames) == 2 * len(single.frames)


def test_copies_of_a_case_count_once(small_results: pathlib.Path, tmp_path: pathlib.Path) -> None:
    paths = [small_results / "results.json", small_results / "results.jsonl"]
    single = broadmark.read_results(paths[0])
    with pytest.warns(UserWarning, match=r"jsonl: repeats 20 cases of .*results.json: left out"):
        both = broadmark.read_results(*paths)
    pd.testing.assert_frame_equal(both.cases, single.cases)
    assert list(both.files.file) == list(map(str, paths))
    with pytest.warns(UserWarning, match="repeats 20 cases"):
        doubled = single + single
    pd.testing.assert_frame_equal(doubled.cases, single.cases)
    pd.testing.assert_frame_equal(doubled.files, single.files)
    slower = json.loads(paths[0].read_text())
    slower["cases"][0]["frames"]["total"][0][0] += 1
    (tmp_path / "slower.json").write_text(json.dumps(slower))
    with pytest.warns(UserWarning, match="repeats 19 cases"):
        assert len(broadmark.read_results(paths[0], tmp_path / "slower.json").cases) == 21


def test_selected_cases_keep_their_frames(small_results: pathlib.Path) -> None:
    results = broadmark.read_results(small_results / "results.json")
    kd = results.select(results.cases["algorithm"] == "kd")
    assert set(kd.frames["algorithm"]) == {"kd"}
    assert list(kd.cases.index) == list(kd.cases["case"]) == [0, 1, 2, 3]
    assert (
        kd.frames["total_ns"].sum() == results.frames.query("algorithm == 'kd'")["total_ns"].sum()
    )


def test_a_truncated_file_is_partial(small_results: pathlib.Path, tmp_path: pathlib.Path) -> None:
    text = (small_results / "results.jsonl").read_text()
    cut = tmp_path / "cut.jsonl"
    cut.write_text(text[: len(text) * 2 // 3])
    results = broadmark.read_results(cut)
    assert results.partial == [str(cut)]
    assert (
        0 < len(results.cases) < len(broadmark.read_results(small_results / "results.jsonl").cases)
    )


def test_compressed_files_are_read(small_results: pathlib.Path, tmp_path: pathlib.Path) -> None:
    plain = small_results / "results.json"
    compressed = tmp_path / "results.json.gz"
    compressed.write_bytes(gzip.compress(plain.read_bytes()))
    expected = broadmark.read_results(plain)
    found = broadmark.read_results(compressed)
    pd.testing.assert_frame_equal(
        found.cases.drop(columns="file"), expected.cases.drop(columns="file")
    )
    compressed.write_bytes(compressed.read_bytes()[:-20])
    with pytest.raises(broadmark.InputError, match="results.json.gz: cannot be read"):
        broadmark.read_results(compressed)


def test_the_first_version_is_read() -> None:
    results = broadmark.read_results(SOURCE_FOLDER / "tests/fuzz/corpus/results/seed")
    assert list(results.cases["seconds_per_frame"].isna()) == [True]  # its summary is empty
    assert list(results.frames["total_ns"]) == [1, 2, 3, 4]
    assert list(results.cases["missed"]) == [1]


def test_times_are_arrays(small_results: pathlib.Path) -> None:
    details = broadmark.read_results(small_results / "results.json").details
    assert all(isinstance(a, np.ndarray) for case in details for a in case["frames"]["total"])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "cannot be read"),
        ("{", "cannot be read"),
        ("[]", "the schema is not broadmark-results/2"),
        ('{"schema": "broadmark-scene/1"}', "the schema is not broadmark-results/2"),
        ('{"schema": "broadmark-results/2", "environments": [], "cases": [5]}', "not an object"),
        ('{"schema": "broadmark-results/2", "environments": [], "cases": [{}]}', "case 0"),
        ('{"schema": "broadmark-results/2"}\n5\n', "line 2"),
    ],
)
def test_other_files_are_rejected(tmp_path: pathlib.Path, text: str, message: str) -> None:
    file = tmp_path / "file.json"
    file.write_text(text)
    with pytest.raises(broadmark.InputError, match=message) as refused:
        broadmark.read_results(file)
    assert str(file) in str(refused.value)


def test_fuzzed_files_are_read_or_rejected() -> None:
    read = 0
    for file in sorted((SOURCE_FOLDER / "tests/fuzz/corpus/results").iterdir()):
        try:
            read += len(broadmark.read_results(file).frames) > 0
        except broadmark.InputError:
            pass
    assert read > 5


def test_empty_results_have_empty_tables(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "nothing.json"
    file.write_text(json.dumps({"schema": "broadmark-results/2", "environments": [], "cases": []}))
    results = broadmark.read_results(file)
    assert len(results.cases) == len(results.frames) == 0


def test_changing_populations_are_counted(tmp_path: pathlib.Path) -> None:
    changing = case("FreeFall", 1000, "kd", 1e-3, bodies={"mean": 812.5, "max": 990})
    path = write(tmp_path / "r.json", [changing, case("FreeFall", 1000, "sap", 1e-3)])
    cases = broadmark.read_results(path).cases.set_index("algorithm")
    assert cases.loc["kd", "bodies_mean"] == 812.5
    assert cases.loc["kd", "bodies_max"] == 990
    assert cases.loc["sap", ["bodies_mean", "bodies_max"]].isna().all()
