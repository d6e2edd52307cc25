"""The WebAssembly program in node, on recordings of the native program (see scripts/checks/web).

Every algorithm is right there, and finds as many pairs in each frame as the native program.
"""

import csv
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE = pathlib.Path(os.environ.get("BROADMARK_SITE", ROOT / "build/web/site"))
CASES = pathlib.Path(os.environ["BROADMARK_CASES"])


def pairs_of(table):
    """The pairs of each frame of each exact algorithm."""
    pairs = {}
    for row in csv.DictReader(table.read_text().splitlines()):
        if row["allowed_extra"] == "0":
            pairs.setdefault(row["algorithm"], {})[int(row["frame"])] = int(row["pairs"])
    return pairs


@pytest.mark.parametrize(
    "recording",
    sorted(path for path in CASES.rglob("*") if path.suffix in (".aabbs", ".broadmark")),
    ids=lambda path: path.stem,
)
@pytest.mark.parametrize(
    "program, isa", [("broadmark", "simd128"), ("broadmark", "scalar"), ("plain", "scalar")]
)
def test_every_algorithm_is_right(recording, program, isa, tmp_path):
    command = ["node", str(SITE / f"{program}.js"), "--headless", "scene" + recording.suffix]
    command += ["--algorithm", "all", "--isa", isa, "--check", "full", "--quiet", "--allow-timeout"]
    (tmp_path / command[3]).write_bytes(recording.read_bytes())
    command += ["--csv-frames", "frames.csv"]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    found = pairs_of(tmp_path / "frames.csv")
    native = pairs_of(recording.with_suffix(".csv"))["columns"]
    assert len(native) == 12
    for name in ("bf", "sap-simd", "grid-sap", "columns", "tide", "kd", "tracy", "bvh8", "cgal"):
        assert found[name] == native, name
