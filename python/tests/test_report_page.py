"""Tests of the report in a browser: content, pointer and keyboard."""

from __future__ import annotations

import base64
import copy
import json
import pathlib
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from browser import Page, start_browser  # skips these tests without selenium
from report_results import case, standard_cases, write_results

import broadmark
from broadmark.palette import DARK, LIGHT, LOOKS

from selenium.webdriver.common.keys import Keys


@pytest.fixture(scope="module")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    started = start_browser(tmp_path_factory.mktemp("chromium"))
    yield started
    started.quit()


@pytest.fixture
def opened(driver: Any, tmp_path: pathlib.Path) -> Iterator[Page]:
    """A page. The browser's console must be empty after the test."""
    driver.get_log("browser")
    yield Page(driver, tmp_path)
    assert driver.get_log("browser") == []


@pytest.fixture
def standard(tmp_path: pathlib.Path) -> pathlib.Path:
    return write_results(tmp_path / "standard.jsonl", standard_cases())


def test_everything_is_drawn(opened: Page, small_results: pathlib.Path) -> None:
    opened.show(small_results / "results.json")
    assert opened.texts("#summary .tile")[:2] == ["20 cases", "4 recordings"]
    for section in ("ratios", "scaling", "memory", "frames", "failures", "cases"):
        opened.section(section)
    assert len(opened.texts("#cases tbody tr")) == 20
    opened.section("scaling")
    opened.wait("return document.querySelectorAll('#scaling svg[role=group]').length === 2")
    assert opened.js("return performance.getEntriesByType('resource').length") == 0


def test_gaps_are_penalised_in_ratios(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard)
    rows = opened.ratios()
    # Ratios to the best of each size; a gap counts as twice the slowest: 2 × 3, 2 × 2, 2 × 2.
    means = {
        "kd": (3 * 1 * 1) ** (1 / 3),
        "bf": (1 * 2 * 4) ** (1 / 3),
        "sap": (2 * 2 * 2) ** (1 / 3),
    }
    for name, mean in means.items():
        assert float(rows[name][0]) == pytest.approx(mean, abs=0.005), name
    assert rows["kd"][2:] == ["3.00", "1.00", "1.00"]
    assert rows["bf"][1:] == ["1", "1.00", "2.00", "timeout"]
    assert rows["faulty"][1:] == ["3", "mismatch", "not run", "not run"]
    assert rows["tracy"][2] == "error" and rows["cgal"][2] == "unsupported"
    assert list(rows)[:3] == ["kd", "bf", "sap"]


def test_failures_and_gaps_are_listed_with_their_reason(
    opened: Page, standard: pathlib.Path
) -> None:
    opened.show(standard)
    opened.section("failures")
    text = " ".join(opened.texts("#failures tbody tr"))
    for reason in ("over the limit of 0.5 s", "1 missed", "SIGSEGV", "no avx512"):
        assert reason in text
    assert "Not run: 3 variants on some of 3 recordings" in opened.texts("#failures summary")
    opened.section("scaling")
    opened.wait("return document.querySelector('#scaling svg[role=group]')")
    assert opened.texts("#scaling text.gap") == ["◔\u202f1", "≠\u202f1", "!\u202f1", "∅\u202f1"]
    assert "faulty" not in opened.js(  # wrong answers have no point
        "return [...document.querySelectorAll('#scaling .series')]"
        ".filter((n) => n.querySelector('.symbol')).map((n) => n.dataset.variant)"
    )


def test_filters_change_table_charts_and_ratios(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard)
    opened.filter("algorithm", "sap", "kd")
    assert opened.texts("#found") == ["6 of 12 cases"]
    assert set(opened.ratios()) == {"sap", "kd"}
    opened.section("cases")
    assert len(opened.texts("#cases tbody tr")) == 6
    opened.section("scaling")
    opened.wait("return document.querySelectorAll('#scaling .series').length === 2")
    opened.filter("objects", "100")
    assert opened.texts("#found") == ["2 of 12 cases"]
    assert opened.ratios()["sap"][2:] == ["1.00"]  # bf is left out
    opened.find("#clear").click()
    assert opened.texts("#found") == ["12 cases"]
    opened.find("#search").send_keys("sigsegv")
    opened.wait("return document.querySelector('#found').textContent === '1 of 12 cases'")
    opened.section("cases")
    assert opened.texts("#cases tbody tr td:first-child") == ["tracy"]
    opened.filter("status")
    for section in ("ratios", "scaling", "memory", "frames", "failures"):
        assert "No case" in opened.section(section).text


def repeated(algorithm: str, objects: int, *seconds: float, **changes: Any) -> dict[str, Any]:
    """A case whose repetitions took these times per frame."""
    result = case(algorithm, objects, sum(seconds) / len(seconds), **changes)
    totals = [[round(value * 1e9)] * 4 for value in seconds]
    result["frames"] = {phase: copy.deepcopy(totals) for phase in result["frames"]}
    result["initialize_ns"] = [1] * len(seconds)
    return result


def test_ties_within_the_noise_share_the_crown(opened: Page) -> None:
    cases = [
        repeated("sap", 100, 0.99e-5, 1.00e-5, 1.01e-5),
        repeated("kd", 100, 1.00e-5, 1.01e-5, 1.02e-5),
        repeated("bf", 100, 1.29e-5, 1.30e-5, 1.31e-5),
    ]
    opened.show(write_results(opened.folder / "r.jsonl", cases))
    rows = opened.ratios()
    assert rows["kd"][2].startswith("1.01 ±0.02") and rows["bf"][2].startswith("1.30 ±0.0")
    crowned = "[...document.querySelectorAll('#ratios tbody .h0')].map((n) => n.closest('tr').cells[0].textContent)"
    assert sorted(opened.js(f"return {crowned}")) == ["kd", "kd", "sap", "sap"]  # mean and cell
    single = [repeated("sap", 100, 1.00e-5), repeated("kd", 100, 1.01e-5)]
    opened.show(write_results(opened.folder / "r.jsonl", single))
    assert opened.ratios()["kd"][2] == "1.01"  # no noise is known
    assert set(opened.js(f"return {crowned}")) == {"sap"}


def test_what_another_file_did_not_ask_for_is_no_gap(opened: Page) -> None:
    few = write_results(opened.folder / "few.jsonl", [case("kd", 100, 1e-5), case("bf", 100, 2e-5)])
    many = [case("kd", 200, 2e-5), case("bf", 400, 9e-5), case("kd", 400, 3e-5)]
    more = write_results(opened.folder / "more.jsonl", [*many, case("sap", 200, 4e-5)])
    opened.show(few, more)
    rows = opened.ratios()
    assert rows["sap"] == ["3.46", "1", "not requested", "2.00", "not run"]  # √(2 · (2 · 3))
    assert rows["bf"][1:] == ["1", "2.00", "not run", "3.00"]
    opened.section("failures")
    assert "sap: on" not in " ".join(opened.texts("#failures li"))
    assert "sap: Brownian Cubes, 400 bodies" in opened.texts("#failures li")


def test_what_another_run_in_a_file_did_not_ask_for_is_no_gap(opened: Page) -> None:
    few = write_results(opened.folder / "few.jsonl", [case("kd", 100, 1e-5), case("bf", 100, 2e-5)])
    more = write_results(opened.folder / "more.jsonl", [case("kd", 200, 2e-5)])
    more.write_text(more.read_text().replace("2026-01-02T03", "2026-01-02T04"))
    both = broadmark.read_results(few) + broadmark.read_results(more)
    both.save(opened.folder / "both.json")
    opened.show(opened.folder / "both.json")
    assert opened.ratios()["bf"] == ["2.00", "", "2.00", "not requested"]


def test_builds_of_a_machine_are_one_machine(opened: Page) -> None:
    files = []
    for build in ("1.0.0", "2.0.0"):
        files.append(write_results(opened.folder / f"{build}.jsonl", [case("kd", 100, 1e-5)]))
        commit = json.dumps({"version": build, "commit": build})[1:-1]
        text = files[-1].read_text().replace('"version": "1.0.0"', commit)
        files[-1].write_text(text)
    opened.show(*files)
    assert opened.texts("#summary .tile")[3:5] == ["1 machine", "2 builds"]
    opened.show(files[0], write_results(opened.folder / "r.jsonl", standard_cases(), cpu="Another"))
    tiles = opened.texts("#summary .tile")
    assert "2 machines" in tiles and not any("build" in tile for tile in tiles)


def test_self_checks_are_no_algorithms_and_come_last(opened: Page) -> None:
    none = case("none", 100, 1e-7, family="self-check")
    opened.show(write_results(opened.folder / "r.jsonl", [none, case("kd", 100, 1e-5)]))
    assert "1 algorithm" in opened.texts("#summary .tile")
    opened.section("cases")
    assert opened.texts("#cases tbody td:first-child") == ["kd", "none"]
    opened.section("scaling")
    opened.wait("return document.querySelector('#scaling .row-name')")
    assert opened.texts("#scaling .row-name") == ["kd"]
    opened.section("worst")
    assert "none" not in opened.texts("#worst tbody td")


def test_a_single_size_is_a_list(opened: Page, standard: pathlib.Path) -> None:
    cases = [result for result in standard_cases() if result["recording"]["objects"] == 100]
    opened.show(write_results(standard, cases))
    opened.section("scaling")
    opened.wait("return document.querySelector('#scaling .row-name')")
    assert opened.texts("#scaling .row-name")[:3] == ["bf", "sap", "kd"]
    assert opened.texts("#scaling text.gap") == ["≠ mismatch", "! error", "∅ unsupported"]
    assert opened.texts("#scaling .legend") == []
    first = opened.find('#scaling .series[data-variant="sap"] .row-name')
    opened.js("arguments[0].scrollIntoView({block: 'center'})", first)
    opened.hover(first)
    assert "20.0" in opened.find("#tooltip").text
    opened.js("document.querySelector('#scaling .symbol').focus()")
    opened.type(Keys.ARROW_DOWN, Keys.ENTER)
    assert opened.find("#details-title").text == "sap"


def test_fingers_find_the_rows_of_a_single_size(opened: Page) -> None:
    heights = []
    for width in (1280, 390):
        results = [case("kd", 100, 1e-5), case("bf", 100, 2e-5)]
        opened.show(write_results(opened.folder / "r.jsonl", results), width=width)
        opened.section("scaling")
        opened.wait("return document.querySelectorAll('#scaling .row-name')[1]")
        y = "[...document.querySelectorAll('#scaling .row-name')].map((n) => n.getBoundingClientRect().y)"
        first, second = opened.js(f"return {y}")
        heights.append(second - first)
    assert heights[0] == pytest.approx(20, abs=1) and heights[1] >= 32


def test_commands_need_files(opened: Page) -> None:
    boxes = np.array([[[[0, 0, 0], [1, 1, 1]]]] * 3, np.float32)
    saved = broadmark.run(boxes, algorithm="kd")
    saved.save(opened.folder / "saved.json")
    shown = {}
    for name, results in (
        ("scene", broadmark.run("brownian", algorithm="kd", objects=20, frames=2)),
        ("boxes", saved),
        ("saved", broadmark.read_results(opened.folder / "saved.json")),
    ):
        opened.show_results(results)
        opened.section("cases")
        opened.find("#cases tbody button").click()
        shown[name] = opened.find("#details").text
    assert "Without the results file" in shown["scene"]
    assert "From its results file" not in shown["scene"]
    for name in ("boxes", "saved"):
        assert "Boxes from Python: call broadmark.run() with them." in shown[name]
        assert "broadmark --headless" not in shown[name] and "/tmp/broadmark-" not in shown[name]


def test_two_files_are_compared(opened: Page) -> None:
    files = []
    for name, factor in (("before", 1.0), ("after", 1.5)):
        results = broadmark.run(
            "brownian", algorithm="bf,sap,kd,grid-sap,tide", objects=60, frames=20, repetitions=3
        )
        for testcase in results.details:
            scale = factor if testcase["algorithm"] == "bf" else 1
            for repetition in range(3):
                jitter = 1 + 0.001 * repetition
                frames = np.full(20, round(scale * jitter * 1e6))
                for phase in testcase["frames"]:
                    testcase["frames"][phase][repetition] = frames
        files.append(opened.folder / f"{name}.json")
        results.save(files[-1])
    opened.show(*files)
    opened.section("compared")
    rows = opened.texts("#compared tbody tr:first-child td")
    assert rows[0] == "bf" and float(rows[4]) == pytest.approx(1.5, rel=0.01)
    assert rows[6] == "REGRESSED"
    assert set(opened.texts("#compared tbody td:last-child")[1:]) == {"same"}
    assert "1 regressed" in " ".join(opened.texts("#compared p")).lower()


def test_worst_frames_and_ageing(opened: Page) -> None:
    ageing = case("kd", 100, 1e-5)
    ageing["recording"]["frames"] = 100
    times = [[10_000] * 50 + [40_000] * 50, [10_000] * 50 + [40_000] * 50]
    times[0][29], times[1][29] = 900_000, 90_000  # a stall in one repetition
    for phase in ageing["frames"]:
        ageing["frames"][phase] = times
    for counts in ageing["frame_counts"].values():
        counts[:] = [1] * 100
    ageing["ageing"] = {
        "early": {"private_bytes": 4096, "moves": 1, "tests": 10},
        "late": {"private_bytes": 6144, "moves": 1, "tests": 11},
    }
    opened.show(write_results(opened.folder / "r.jsonl", [ageing, case("bf", 100, 2e-5)]))
    opened.section("worst")
    cells = opened.texts("#worst tbody td")
    assert cells[0] == "bf" and cells[4:7] == ["20.0\u00a0µs", "1.00", "1"]
    assert cells[7:10] == ["–", "–", "–"] and cells[11] == "–"  # too few frames
    kd = cells[cells.index("kd") :]
    assert kd[4:10] == ["90.0\u00a0µs", "9.00", "30", "–", "4.00", "1.10"] and kd[11] == "1.50"


def test_a_filter_of_statuses_hides_no_gap(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard)
    opened.filter("status", "ok")
    assert opened.ratios()["bf"][2:] == ["1.00", "2.00", "timeout"]


def test_headers_sort_the_table(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard)
    opened.section("cases")
    times = "return [...document.querySelectorAll('#cases tbody tr')].map((r) => r.cells[5].textContent)"
    column = "#cases th:nth-child(6)"
    assert opened.js(times)[:3] == ["5.00\u00a0µs", "10.0\u00a0µs", "20.0\u00a0µs"]
    assert opened.find(column).get_attribute("aria-sort") == "ascending"
    opened.find(f"{column} button").send_keys(Keys.ENTER)
    assert opened.find(column).get_attribute("aria-sort") == "descending"
    assert opened.js(times)[0] == "80.0\u00a0µs"
    assert opened.js(times)[-3:] == ["–"] * 3  # unknown values come last


def test_tooltips_on_hover_and_focus(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard)
    opened.section("scaling")
    opened.wait("return document.querySelector('#scaling .series .symbol')")
    first = opened.find('#scaling .series[data-variant="bf"] .symbol')
    opened.js("arguments[0].scrollIntoView({block: 'center'})", first)
    opened.hover(first)
    tip = opened.find("#tooltip")
    assert tip.is_displayed() and "10.0" in tip.text and "95 %" in tip.text
    opened.hover(opened.find("#search"))
    assert not tip.is_displayed()

    opened.js("arguments[0].focus()", first)
    assert tip.is_displayed()
    assert first.get_attribute("aria-describedby") == "tooltip"
    opened.type(Keys.ARROW_RIGHT)
    assert "200 bodies" in tip.text and "bf" in tip.text
    opened.type(Keys.ARROW_DOWN)
    assert "200 bodies" in tip.text and "kd" in tip.text
    opened.type(Keys.ENTER)
    assert opened.find("#details-title").text == "kd"


def test_arrow_keys_move_in_the_grid(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard)
    opened.ratios()
    opened.js("document.querySelector('[role=gridcell]').focus()")
    opened.type(Keys.ARROW_RIGHT, Keys.ARROW_DOWN)
    assert "bf" in opened.find("#tooltip").text and "200 bodies" in opened.find("#tooltip").text
    assert (
        opened.js("return document.querySelectorAll('[role=gridcell][tabindex=\"0\"]').length") == 1
    )


def test_a_case_links_to_the_program_in_a_browser(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard, program_page="https://example.org/index.html")
    opened.section("cases")
    opened.find("#cases tbody tr:first-child button").send_keys(Keys.ENTER)
    link = opened.find("#details [data-name=browser]").get_attribute("href")
    assert link == (
        "https://example.org/index.html#brownian&--objects&100&--frames&4&--seed&1"
        "&--param&mass=1&--algorithm&faulty&--frame&3"
    )


def test_details_show_commands_and_hash(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard)
    opened.section("cases")
    link = opened.find("#cases tbody tr:first-child button")
    assert link.text == "faulty"
    link.send_keys(Keys.ENTER)
    codes = {
        name: opened.js(
            "return document.querySelector(arguments[0]).textContent", f'[data-name="{name}"]'
        )
        for name in ("again", "export", "command", "hash", "id")
    }
    source = "broadmark --headless brownian --objects 100 --frames 4 --seed 1 --param mass=1"
    variant = " --algorithm faulty --threads 1 --check full --warmup 0 --repetitions 2"
    assert codes["command"] == source + variant
    assert codes["again"].startswith(f"broadmark --headless {standard} --case Brownian/Cubes/N100")
    assert codes["export"].endswith("--export-case small.aabbs")
    assert codes["hash"] == f"{100:032x}"
    assert "1 frame with a wrong answer" in opened.find("#details figure").text
    opened.type(Keys.ESCAPE)
    assert not opened.find("#details").is_displayed()
    assert opened.driver.switch_to.active_element == link


def test_arrow_keys_move_the_timeline_cursor(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard)
    opened.section("frames")
    names = opened.texts("#frames .phases > span")
    assert [name.split("\u00a0")[0].strip() for name in names] == [
        *("update objects 10.0", "update structures 10.0", "search overlaps 20.0"),
    ]  # of kd with 400 bodies, the fastest
    opened.js("document.querySelector('#frames svg').focus()")
    opened.type(Keys.ARROW_RIGHT)
    tip = opened.find("#tooltip").text
    assert "frame 2" in tip and "total 40.0" in tip and "12 pairs" in tip


def test_machines_are_never_pooled(opened: Page, standard: pathlib.Path) -> None:
    slow = [case(a, n, s) for a, n, s in (("bf", 100, 1e-3), ("sap", 100, 4e-3), ("kd", 100, 2e-3))]
    other = write_results(opened.folder / "other.jsonl", slow, cpu="Another")
    opened.show(standard, other)
    assert opened.ratios(0)["sap"][2:] == ["2.00", "2.00", "2.00"]
    assert opened.ratios(1)["sap"][2:] == ["4.00"]
    side = opened.texts(".side tbody tr:first-child td")
    assert len(side) == 6  # mean, rank and gaps on each
    opened.section("scaling")
    opened.wait("return document.querySelectorAll('#scaling svg[role=group]').length === 2")
    titles = opened.texts("#scaling h4 .muted")
    assert [title.split(",")[0] for title in titles] == ["A processor", "Another"]
    assert opened.js(
        "return [...document.querySelectorAll('#scaling svg[role=group]')]"
        ".map((svg) => svg.querySelectorAll('.symbol').length)"
    ) == [8, 3]


def test_the_summary_warns(opened: Page, standard: pathlib.Path) -> None:
    disturbed = case("sap", 100, 7e-5)
    disturbed["conditions"]["warnings"] = ["other programs keep a core busy"]
    partial = write_results(opened.folder / "cut.jsonl", [disturbed], complete=False)
    opened.show(standard, partial)
    notices = " ".join(opened.texts("#summary .notice"))
    assert "cut.jsonl is partial" in notices
    assert "other programs keep a core busy (1 case)" in notices
    assert "1 case was run again later" in notices
    assert opened.ratios()["sap"][2] == "7.00"  # the last run
    opened.filter("file", str(standard))
    assert opened.ratios()["sap"][2] == "2.00"


def test_hostile_names_are_inserted_as_text(opened: Page) -> None:
    evil = [
        "</script><script>window.hacked=1</script>",
        "<img src=x onerror=window.hacked=1>",
        "constructor",
        "a\u2028b $data ${x} -->",
    ]
    hostile = []
    for i, name in enumerate(evil):
        result = case(
            name, 100, 1e-5 * (i + 1), family=name, id=name, params={name: name}, device=name
        )
        result["recording"] |= {"name": name, "object_type": name, "hash": name}
        result["recording"]["source"] = {name: name, "seed": str(i)}
        result["conditions"]["warnings"] = [name]
        hostile += [
            result,
            {**result, "status": "error", "reason": name, "id": name + "2", "threads": 2},
        ]
    path = write_results(opened.folder / "hostile.jsonl", hostile, cpu=evil[0])
    opened.show(path)
    for section in ("ratios", "scaling", "memory", "frames", "failures", "cases"):
        opened.section(section)
    opened.find("#cases tbody button").click()
    assert evil[0] in opened.find("#details").text
    assert opened.js("return window.hacked") is None
    assert opened.js("return document.querySelectorAll('img').length") == 0
    assert len(opened.texts("script")) == 4


def test_a_phone_needs_no_horizontal_scrolling(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard, width=360)
    for section in ("ratios", "scaling", "memory", "frames", "failures", "cases"):
        opened.section(section)
    assert opened.js("return document.documentElement.scrollWidth") == 360
    opened.find(".all-filters > summary").click()
    opened.filter("algorithm", "kd")
    assert opened.texts("#found") == ["3 of 12 cases"]


def test_on_a_phone_tables_hint_that_they_scroll_and_fingers_find_controls(opened: Page) -> None:
    wide = [case(a, n, s) for a, s in (("kd", 1e-5), ("bf", 3e-5)) for n in range(100, 2000, 100)]
    opened.show(write_results(opened.folder / "wide.jsonl", wide), width=390)
    for section in ("ratios", "scaling", "memory", "frames", "failures", "cases"):
        opened.section(section)
    opened.find(".all-filters > summary").click()
    opened.wait("return document.querySelector('#ratios .scroll-frame.more .scroll-hint')")
    assert opened.find("#ratios .scroll-hint").is_displayed()
    opened.js("document.querySelector('#ratios .scroll').scrollLeft = 1e6")
    opened.wait("return !document.querySelector('#ratios .scroll-frame.more')")
    small = opened.js(
        "return [...document.querySelectorAll('button, select, input:not([type=checkbox]), summary,"
        " .filter label, [role=gridcell]')].map((n) => [n, n.getBoundingClientRect()])"
        ".filter(([n, box]) => box.width && (box.height < 44 || box.width < 44))"
        ".map(([n, box]) => `${n.outerHTML.slice(0, 60)} ${box.width}x${box.height}`)"
    )
    assert small == []


def test_every_case_is_printed_without_hatching(opened: Page) -> None:
    many = [case(f"a{i}", 100 * n, None if i % 2 else 1e-5) for i in range(70) for n in range(1, 5)]
    opened.show(write_results(opened.folder / "many.jsonl", many))
    pdf = opened.driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": True})["data"]
    assert len(base64.b64decode(pdf)) < 2_000_000
    opened.js("dispatchEvent(new Event('beforeprint'))")
    assert len(opened.texts("#cases tbody tr")) == 280
    assert len(opened.texts("#ratios tbody tr")) == 70


def test_dark_theme_by_system_and_by_button(opened: Page, standard: pathlib.Path) -> None:
    colour = "return getComputedStyle(document.body).backgroundColor"
    opened.show(standard)
    light = opened.js(colour)
    opened.find("#theme").click()
    dark = opened.js(colour)
    assert light == "rgb(255, 255, 255)" and dark != light
    opened.show(standard, dark=True)
    assert opened.js(colour) == dark
    opened.find("#theme").click()
    assert opened.js(colour) == light


def test_curves_have_the_colours_of_their_algorithms(opened: Page, standard: pathlib.Path) -> None:
    for dark, colours in ((False, LIGHT), (True, DARK)):
        opened.show(standard, dark=dark)
        opened.section("scaling")
        opened.wait("return document.querySelector('#scaling .series')")
        symbol = opened.find('#scaling .series[data-variant="kd"] .symbol')
        part = [int(colours["curve"][LOOKS["kd"][0]][i : i + 2], 16) for i in (1, 3, 5)]
        assert opened.js("return getComputedStyle(arguments[0]).stroke", symbol) == (
            "rgb({}, {}, {})".format(*part)
        )


def test_it_prints_on_a4(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard, dark=True)
    options = {"preferCSSPageSize": True, "printBackground": True}
    pdf = base64.b64decode(opened.driver.execute_cdp_cmd("Page.printToPDF", options)["data"])
    boxes = re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", pdf)
    assert 2 <= len(boxes) <= 8
    for width, height in boxes:
        assert float(width) == pytest.approx(595.3, abs=1.5)
        assert float(height) == pytest.approx(841.9, abs=1.5)


def test_other_times_can_be_compared(opened: Page, standard: pathlib.Path) -> None:
    cases = standard_cases()
    for result in cases:
        result["summary"]["p95"] = 1e-4 * len(result["algorithm"])
    opened.show(write_results(standard, cases))
    opened.find(".found option:nth-child(3)").click()
    assert opened.ratios()["sap"][2:] == ["1.50", "1.50", "1.50"]


def test_ten_thousand_cases_open_quickly(opened: Page) -> None:
    many = []
    for i in range(10_000):
        result = case(f"algorithm{i % 40}", 1000 * (1 + i // 400), 1e-5 * (1 + i % 97))
        result["recording"]["source"] = f"recording{i // 400}.aabbs"
        result["id"] = str(i)
        result["threads"] = 1 + i // 40 % 10
        many.append(result)
    opened.show(write_results(opened.folder / "many.jsonl", many))
    assert opened.texts("#found") == ["10,000 cases"]
    opened.wait("return document.querySelector('table[role=grid]')")
    # Most cases have no element, so the page is fast.
    assert opened.js("return document.getElementsByTagName('*').length") < 10_000
    opened.filter("algorithm", "algorithm7")
    assert opened.texts("#found") == ["250 of 10,000 cases"]


def test_data_cannot_leave_its_element(opened: Page, standard: pathlib.Path) -> None:
    opened.show(standard)
    text = (opened.folder / "a report.html").read_text("utf-8")
    data = text.partition('id="data">')[2].partition("</script>")[0]
    assert "<" not in data
    assert json.loads(data)["runs"][0]["file"] == str(standard)
