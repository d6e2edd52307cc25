"""The benchmark page in a browser, and its results."""

import gzip
import json
import subprocess

from conftest import ROOT, SITE

#: Instead of the page's three sizes.
FEW = "--objects 500"


def measure(page):
    """Measures the smallest size only. Returns the results."""
    arguments = (SITE / "arguments.txt").read_text()
    page.driver.get(page.address + "benchmark.html")
    page.wait("crossOriginIsolated && document.readyState === 'complete'")
    page.driver.execute_script(
        """
        const text = textOf;
        textOf = async (name) => name === "arguments.txt" ? arguments[0] : text(name);
        document.getElementById("processor").value = "a processor";
        document.getElementById("run").click();
        """,
        arguments.replace("--objects 500,2000,8000", FEW),
    )
    page.wait("window.results || /failed/.test(document.getElementById('progress').textContent)")
    assert page.driver.execute_script("return document.getElementById('progress').textContent") == (
        "Done: 36 of 36 cases are correct."
    )
    return page.driver.execute_script("return window.results")


def test_measures_and_reports_beside_published_results(page, tmp_path):
    results = measure(page)
    assert results["environments"][0]["cpu"] == "a processor"
    assert "Chrom" in results["environments"][0]["os"]
    page.driver.switch_to.frame("report")
    page.wait("document.documentElement.dataset.ready")
    page.wait("document.getElementById('summary').innerText.includes('2 machines')")
    columns = json.loads(page.wait("document.getElementById('data').textContent"))["columns"]
    page.driver.switch_to.default_content()
    own = [i for i, machine in enumerate(columns["machine"]) if machine == 1]
    for i, case in zip(own, results["cases"], strict=True):
        algorithm = columns["algorithm"]
        assert algorithm["texts"][algorithm["codes"][i]] == case["algorithm"]
        assert columns["seconds_per_frame"][i] == case["summary"]["seconds_per_frame"]
        assert columns["pairs_mean"][i] == case["pairs"]["mean"]
    assert page.complaints() == []
    check_by_the_native_program(results, tmp_path)


def check_by_the_native_program(results, folder):
    published = json.loads(
        gzip.decompress((ROOT / "app/web/benchmark/published.json.gz").read_bytes())
    )
    # The recordings of physics depend on how Bullet was compiled.
    hashes = [
        {
            case["recording"]["hash"]
            for case in each["cases"]
            if case["recording"]["name"] == "Brownian" and case["recording"]["objects"] == 500
        }
        for each in (results, published)
    ]
    assert hashes[0] == hashes[1]
    (folder / "browser.json").write_text(json.dumps(results))
    command = [ROOT / "build/release/broadmark", "compare", "browser.json", "browser.json"]
    if command[0].exists():  # not in the root of ./check --web
        ended = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        assert ended.returncode == 0, ended.stdout + ended.stderr
