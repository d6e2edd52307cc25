"""Recordings as arrays, and back."""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np
import pytest

import broadmark
from broadmark.program import call
from broadmark.recordings import as_boxes


def random_boxes(frames: int, bodies: int) -> Any:
    generator = np.random.default_rng(1)
    low = generator.uniform(0, 5, (frames, bodies, 3))
    return np.stack([low, low + 1], axis=2).astype(np.float32)


def test_what_is_written_is_read_and_verified(tmp_path: pathlib.Path) -> None:
    boxes = random_boxes(4, 7)
    path = tmp_path / "mine.aabbs"
    broadmark.write_recording(path, boxes, name="Mine", object_type="Things")
    recording = broadmark.read_recording(path)
    assert isinstance(recording, broadmark.Recording)
    assert (recording.name, recording.object_type) == ("Mine", "Things")
    np.testing.assert_array_equal(recording.boxes, boxes)
    np.testing.assert_array_equal(
        recording.world, [boxes[..., 0, :].min((0, 1)), boxes.max((0, 1, 2))]
    )
    assert "ok" in call("verify", str(path))
    assert [p.name for p in tmp_path.iterdir()] == ["mine.aabbs"]


def test_arrays_may_come_one_by_one_and_flat(tmp_path: pathlib.Path) -> None:
    boxes = random_boxes(3, 2)
    path = tmp_path / "mine.aabbs"
    broadmark.write_recording(path, (one.reshape(-1, 6).astype(float) for one in boxes))
    np.testing.assert_array_equal(broadmark.read_recording(path).boxes, boxes)


def test_nothing_is_copied(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "mine.aabbs"
    broadmark.write_recording(path, random_boxes(3, 2))
    base: Any = broadmark.read_recording(path).boxes
    while isinstance(base, np.ndarray) and base.base is not None:
        base = base.base
    assert not isinstance(base, np.ndarray)  # the mapping itself
    flat = random_boxes(1, 5)[0].reshape(-1, 6)
    assert np.shares_memory(as_boxes(flat), flat)


def test_poses_are_those_of_the_same_scenes_boxes(tmp_path: pathlib.Path) -> None:
    call(
        *("bake", "--scenes", "brownian", "--objects", "20", "--frames", "5", "--quiet"),
        *("--recorder", "aabbs,posrot", "--output", str(tmp_path)),
    )
    (boxes,) = map(broadmark.read_recording, tmp_path.glob("*/*.aabbs"))
    (poses,) = map(broadmark.read_recording, tmp_path.glob("*/*.posrot"))
    assert isinstance(boxes, broadmark.Recording) and isinstance(poses, broadmark.PoseRecording)
    assert poses.positions.shape == (5, 20, 3) and poses.rotations.shape == (5, 20, 4)
    np.testing.assert_allclose(np.linalg.norm(poses.rotations, axis=2), 1, rtol=1e-5)
    centres = boxes.boxes[1:].mean(2)
    np.testing.assert_allclose(centres, poses.positions, atol=1e-4)


@pytest.mark.parametrize(
    ("boxes", "message"),
    [
        ([[[0, 0, 0, 1, 1, 1]]], "1 sets of boxes"),
        ([[[0, 0, 0, 1, 1]]] * 2, r"frame 0: boxes: of shape \(1, 5\)"),
        ([[[0, 0, 0, 1, 1, 1]], [[0, 0, 0, 1, 1, np.nan]]], "frame 1: boxes: body 0"),
        ([[[0, 2, 0, 1, 1, 1]]] * 2, "frame 0: boxes: body 0 has its min"),
        ([[[0, 0, 0, 1, 1, 1]], [[0, 0, 0, 1, 1, 1]] * 2], "frame 1: has 2 bodies, the first 1"),
        ([[["a"] * 6]] * 2, "not numbers"),
    ],
)
def test_what_a_recording_cannot_hold(tmp_path: pathlib.Path, boxes: Any, message: str) -> None:
    with pytest.raises(broadmark.InputError, match=message):
        broadmark.write_recording(tmp_path / "mine.aabbs", [np.array(one) for one in boxes])
    assert not list(tmp_path.iterdir())


def test_names_that_a_header_cannot_hold(tmp_path: pathlib.Path) -> None:
    for name in ("", "x" * 128, "größer", "a\nb"):
        with pytest.raises(broadmark.InputError, match="printable ASCII"):
            broadmark.write_recording(tmp_path / "a.aabbs", random_boxes(2, 2), name=name)


def test_bad_files_are_refused(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "mine.aabbs"
    broadmark.write_recording(path, random_boxes(3, 2))
    whole = path.read_bytes()
    for content in (
        b"",
        whole[:200],
        whole[:-1],
        whole + b"0",
        whole[:256] + b"\xff" * 16 + whole[272:],
    ):
        path.write_bytes(content)
        with pytest.raises(broadmark.InputError, match="mine.aabbs: "):
            broadmark.read_recording(path)
    for name in ("there is no such.aabbs", "other.txt"):
        with pytest.raises(broadmark.InputError):
            broadmark.read_recording(tmp_path / name)


def test_an_array_file_is_written_by_the_command(tmp_path: pathlib.Path, command: Any) -> None:
    np.save(tmp_path / "boxes.npy", random_boxes(3, 4))
    path = tmp_path / "mine.aabbs"
    assert command("write", tmp_path / "boxes.npy", "-o", path) == (0, "", "")
    np.testing.assert_array_equal(broadmark.read_recording(path).boxes, random_boxes(3, 4))
    status, _, error = command("write", tmp_path / "no.npy", "-o", path)
    assert status == 2 and "no.npy" in error
