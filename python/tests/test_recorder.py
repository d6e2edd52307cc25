"""Tests of integrations/broadmark_recorder.py."""

from __future__ import annotations

import importlib.util
import pathlib
import re
import shutil
from typing import Any

import numpy as np
import pytest

import broadmark
from broadmark.program import call

FILE = pathlib.Path(__file__).parents[2] / "integrations" / "broadmark_recorder.py"
_spec = importlib.util.spec_from_file_location("broadmark_recorder", FILE)
assert _spec is not None and _spec.loader is not None
recorder: Any = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(recorder)


def pairs_of(lower: Any, upper: Any) -> Any:
    """All overlapping pairs."""
    overlap = ((lower[:, None] <= upper[None]) & (lower[None] <= upper[:, None])).all(2)
    return np.argwhere(np.triu(overlap, 1))


def record(folder: pathlib.Path, frames: int = 6, dtype: Any = np.float32, **options: Any) -> Any:
    """Records drifting boxes, some absent at times. Returns the boxes of all frames."""
    generator = np.random.default_rng(1)
    lower = generator.uniform(0, 4, (40, 3)).astype(dtype)
    boxes = []
    with recorder.Recorder(folder / "session", **options) as session:
        for frame in range(frames):
            lower[:10] += dtype(0.25)
            shown = np.where((np.arange(40) % 7 == frame)[:, None], np.nan, lower)
            session.frame(shown, shown + dtype(1), pairs_of(shown, shown + dtype(1)))
            boxes.append(np.stack([shown, shown + dtype(1)], 1))
    return np.array(boxes)


def audit(folder: pathlib.Path, *options: str, accept: tuple[int, ...] = (0,)) -> str:
    files = (f"{folder}/session.broadmark", f"{folder}/session.csv")
    return call("audit", *files, *options, accept=accept)


def test_sessions_are_read_and_audited(tmp_path: pathlib.Path) -> None:
    boxes = record(tmp_path)
    assert "ok: session Bodies, 40 bodies, 5 frames" in call(
        "verify", str(tmp_path / "session.broadmark")
    )
    read = broadmark.read_recording(tmp_path / "session.broadmark")
    absent = np.isnan(boxes).any((2, 3))
    np.testing.assert_array_equal(read.boxes[~absent], boxes[~absent])
    assert np.isinf(read.boxes[absent]).all() and absent.any()
    assert "of which none is wrong" in audit(tmp_path)


def test_a_dropped_pair_is_found(tmp_path: pathlib.Path) -> None:
    record(tmp_path)
    log = tmp_path / "session.csv"
    log.write_text("".join(log.read_text().splitlines(True)[:-1]))
    assert re.search("missed +1 +1 +5 ", audit(tmp_path, accept=(1,)))


def test_each_frame_completes_the_files(tmp_path: pathlib.Path) -> None:
    unit = np.zeros((2, 3))
    session = recorder.Recorder(tmp_path / "session")
    for frame in range(3):
        session.frame(unit, unit + 1, [[0, 1]])
        folder = tmp_path / str(frame)
        folder.mkdir()
        for name in ("session.broadmark", "session.csv"):
            shutil.copy(tmp_path / name, folder)
        assert f"in {frame + 1} frame" in audit(folder)


def test_layers_and_worlds_are_recorded(tmp_path: pathlib.Path) -> None:
    lower = np.zeros((4, 3))
    with recorder.Recorder(
        tmp_path / "session",
        layers=[0, 0, 1, 1],
        worlds=[0, 0, 0, 5],
        colliding_layers=[(0, 0), (0, 1)],
    ) as session:
        for _ in range(2):
            session.frame(lower, lower + 1, [[0, 1], [0, 2], [2, 1]])
    assert "of which none is wrong" in audit(tmp_path)


def test_rounding_makes_no_pair_missed(tmp_path: pathlib.Path) -> None:
    record(tmp_path, dtype=np.float64)
    assert "of which none is wrong" in audit(tmp_path, "--margin", "1e-6")
    (tmp_path / "touching").mkdir()
    with recorder.Recorder(tmp_path / "touching" / "session") as session:
        for _ in range(2):  # as floats to the nearest, these boxes touch
            session.frame([[0, 0, 0], [0.1 + 1e-12, 0, 0]], [[0.1, 1, 1], [1, 1, 1]], [])
    assert "of which none is wrong" in audit(tmp_path / "touching")


def test_half_spaces_end_at_the_largest_float(tmp_path: pathlib.Path) -> None:
    lower = np.array([[-np.inf, -np.inf, -np.inf], [0, -0.5, 0]])
    upper = np.array([[np.inf, 0, np.inf], [1, 1, 1]])
    with recorder.Recorder(tmp_path / "session") as session:
        for _ in range(2):
            session.frame(lower, upper, [[0, 1]])
    assert "of which none is wrong" in audit(tmp_path)
    world = broadmark.read_recording(tmp_path / "session.broadmark").world
    assert world.tolist() == [[0, -0.5, 0], [1, 1, 1]]


def test_mistakes_are_refused(tmp_path: pathlib.Path) -> None:
    lower = np.zeros((2, 3))
    with recorder.Recorder(tmp_path / "session", layers=[0, 0]) as session:
        session.frame(lower, lower + 1, [])
        for arguments, words in (
            ((lower + 2, lower, []), "frame 1: the lower end"),
            ((np.zeros((3, 3)), np.ones((3, 3)), []), "boxes"),
            ((lower, lower + 1, [[0, -1]]), "integers"),
        ):
            with pytest.raises(ValueError, match=words):
                session.frame(*arguments)
    with pytest.raises(FileExistsError):
        recorder.Recorder(tmp_path / "session")
    with recorder.Recorder(tmp_path / "other", layers=[0]) as session:
        with pytest.raises(ValueError, match="of 2 bodies"):
            session.frame(lower, lower + 1, [])
