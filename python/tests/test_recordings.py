"""Tests of reading and writing recordings."""

from __future__ import annotations

import itertools
import json
import pathlib
from typing import Any

import numpy as np
import pytest

import broadmark
from broadmark.program import call
from broadmark.arguments import as_boxes


def random_boxes(frames: int, bodies: int) -> Any:
    generator = np.random.default_rng(1)
    low = generator.uniform(0, 5, (frames, bodies, 3))
    return np.stack([low, low + 1], axis=2).astype(np.float32)


def test_written_recordings_are_read_and_verified(tmp_path: pathlib.Path) -> None:
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


def test_arrays_can_be_iterated_and_flat(tmp_path: pathlib.Path) -> None:
    boxes = random_boxes(3, 2)
    path = tmp_path / "mine.aabbs"
    broadmark.write_recording(path, (frame.reshape(-1, 6).astype(float) for frame in boxes))
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


def test_poses_match_the_boxes_of_the_scene(tmp_path: pathlib.Path) -> None:
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
        ([[[0, 0, 0, 1, 1, 1]]], "boxes: expected at least 2 sets, "),
        ([[[0, 0, 0, 1, 1]]] * 2, r"frame 0: boxes: of shape \(1, 5\)"),
        ([[[0, 0, 0, 1, 1, 1]], [[0, 0, 0, 1, 1, np.nan]]], "frame 1: boxes: body 0"),
        ([[[0, 2, 0, 1, 1, 1]]] * 2, "frame 0: boxes: body 0 has a min"),
        (
            [[[0, 0, 0, 1, 1, 1]], [[0, 0, 0, 1, 1, 1]] * 2],
            "frame 1: has 2 bodies, the first frame 1",
        ),
        ([[["a"] * 6]] * 2, "expected numbers"),
    ],
)
def test_invalid_boxes_are_rejected(tmp_path: pathlib.Path, boxes: Any, message: str) -> None:
    with pytest.raises(broadmark.InputError, match=message):
        broadmark.write_recording(tmp_path / "mine.aabbs", [np.array(frame) for frame in boxes])
    assert not list(tmp_path.iterdir())


def test_invalid_names_are_rejected(tmp_path: pathlib.Path) -> None:
    for name in ("", "x" * 128, "größer", "a\nb"):
        with pytest.raises(broadmark.InputError, match="printable ASCII"):
            broadmark.write_recording(tmp_path / "a.aabbs", random_boxes(2, 2), name=name)


def test_arguments_of_other_types_are_rejected(tmp_path: pathlib.Path) -> None:
    path, boxes = tmp_path / "a.broadmark", random_boxes(2, 2)
    number: Any = 3
    for wrong, message in (
        ({"name": number}, "name 3: expected 1 to 127 printable ASCII characters"),
        ({"object_type": number}, "object type 3: "),
        ({"groups": number}, "groups: expected Groups, not type int"),
        ({"groups": [broadmark.Groups(), number]}, "groups: expected Groups, not type int"),
    ):
        with pytest.raises(broadmark.InputError, match=message):
            broadmark.write_recording(path, boxes, **wrong)
    assert not list(tmp_path.iterdir())


def test_the_empty_box_is_constant() -> None:
    with pytest.raises(ValueError, match="read-only"):
        broadmark.EMPTY_BOX[0] = 0
    assert not broadmark.present(broadmark.EMPTY_BOX)


def changing_boxes(frames: int, bodies: int) -> Any:
    """Boxes of changing frames: a tenth of the bodies moves per frame, some disappear and reappear."""
    generator = np.random.default_rng(2)
    boxes = np.repeat(random_boxes(1, bodies), frames, axis=0)
    for before, now in itertools.pairwise(boxes):
        now[:] = before
        moved = generator.random(bodies) < 0.1
        now[moved] = random_boxes(1, bodies)[0, moved] + generator.random(dtype=np.float32)
        now[generator.random(bodies) < 0.03] = broadmark.EMPTY_BOX
    return boxes


GROUPS = broadmark.Groups(
    layers=np.arange(60, dtype=np.uint8) % 3,
    tags=np.arange(180, dtype=np.uint32).reshape(60, 3),
    colliding_layers=((0, 1), (2, 2)),
)


def changing_recording(path: pathlib.Path) -> broadmark.ChangingRecording:
    broadmark.write_recording(path, changing_boxes(40, 60), name="Changing", groups=GROUPS)
    recording = broadmark.read_recording(path)
    assert isinstance(recording, broadmark.ChangingRecording)
    return recording


def test_changing_worlds_are_read_in_any_order(tmp_path: pathlib.Path) -> None:
    boxes = changing_boxes(40, 60)
    recording = changing_recording(tmp_path / "a.broadmark")
    np.testing.assert_array_equal(recording.boxes, boxes)
    for frame in (39, 0, 17, 18, 5):
        np.testing.assert_array_equal(recording.frame(frame), boxes[frame])
    for frame, (now, changed) in enumerate(recording.frames()):
        np.testing.assert_array_equal(now, boxes[frame])
        differs = (boxes[frame] != boxes[max(frame - 1, 0)]).any((1, 2))
        np.testing.assert_array_equal(changed, differs.nonzero()[0])
        np.testing.assert_array_equal(recording.changed(frame), changed)
    assert not recording.all_present and not broadmark.present(boxes).all()
    assert recording.groups.colliding_layers == GROUPS.colliding_layers
    np.testing.assert_array_equal(recording.groups.layers, GROUPS.layers)
    np.testing.assert_array_equal(recording.groups.tags, GROUPS.tags)
    assert recording.groups.worlds is None
    for frame in (-1, 40):
        with pytest.raises(broadmark.InputError, match="last frame is 39"):
            recording.frame(frame)


def test_program_and_python_read_each_others_files(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "a.broadmark"
    written = changing_recording(path)
    assert "ok" in call("verify", str(path))
    call("convert", str(path), str(tmp_path / "b.broadmark"), "--quiet")
    read = broadmark.read_recording(tmp_path / "b.broadmark")
    assert isinstance(read, broadmark.ChangingRecording)
    np.testing.assert_array_equal(read.boxes, written.boxes)
    np.testing.assert_array_equal(read.groups.tags, GROUPS.tags)
    assert read.groups.colliding_layers == GROUPS.colliding_layers
    assert (read.name, read.source) == ("Changing", "a.broadmark")
    with pytest.raises(broadmark.InputError, match="layers"):
        call("convert", str(path), str(tmp_path / "c.aabbs"))


def changing_groups(frames: int, bodies: int) -> list[broadmark.Groups]:
    """Groups of frames: in each, some bodies change layer or tags."""
    generator = np.random.default_rng(3)
    layers = np.zeros(bodies, np.uint8)
    tags = np.full((bodies, 3), 0xFFFFFFFF, np.uint32)
    groups = []
    for frame in range(frames):
        some = generator.random(bodies) < (0.2 if frame > 0 else 0)
        layers, tags = layers.copy(), tags.copy()
        layers[some] = generator.integers(0, 4, some.sum())
        tags[some, 1] = generator.integers(0, 9, some.sum())
        groups.append(broadmark.Groups(layers, None, tags, ((0, 0), (1, 3))))
    return groups


def test_filters_that_change_are_read_and_written(tmp_path: pathlib.Path) -> None:
    frames, bodies = 300, 40
    boxes = np.repeat(changing_boxes(1, bodies), frames, axis=0)
    groups = changing_groups(frames, bodies)
    path = tmp_path / "a.broadmark"
    broadmark.write_recording(path, boxes, groups=groups)
    assert "ok" in call("verify", str(path))
    call("convert", str(path), str(tmp_path / "b.broadmark"), "--quiet")
    for name in ("a", "b"):
        recording = broadmark.read_recording(tmp_path / f"{name}.broadmark")
        assert isinstance(recording, broadmark.ChangingRecording) and recording.filter_changes
        np.testing.assert_array_equal(recording.boxes, boxes)
        for frame in (0, 299, 1, 150, 257):
            now = recording.groups_at(frame)
            np.testing.assert_array_equal(now.layers, groups[frame].layers)
            np.testing.assert_array_equal(now.tags, groups[frame].tags)
            assert now.colliding_layers == ((0, 0), (1, 3))
            before = groups[max(frame - 1, 0)]
            differs = (now.layers != before.layers) | (now.tags != before.tags).any(1)
            np.testing.assert_array_equal(recording.filter_changed(frame), differs.nonzero()[0])
    results = tmp_path / "r.json"
    call("--headless", str(path), "--algorithm", "bf,kd,tide", "--json", str(results), "--quiet")
    assert {case["status"] for case in json.loads(results.read_text())["cases"]} == {"ok"}


def test_a_periodic_box_is_read(tmp_path: pathlib.Path) -> None:
    particles = tmp_path / "a.xyz"
    lattice = 'Lattice="2 0 0 0 2 0 0 0 2" pbc="T F T"'
    particles.write_text(f"2\n{lattice}\nH 0.1 1 1\nH 1.9 1 1\n")
    path = tmp_path / "a.broadmark"
    call("import", str(particles), "--radius", "0.2", "--periodic", "-o", str(path), "--quiet")
    recording = broadmark.read_recording(path)
    assert isinstance(recording, broadmark.ChangingRecording)
    assert (recording.periodic, recording.filter_changes) == ("0:2,-,0:2", False)
    np.testing.assert_allclose(recording.boxes[0, :, 0, 0], [1.9, 1.7], rtol=1e-6)


def test_only_layers_and_tags_may_change(tmp_path: pathlib.Path) -> None:
    boxes = random_boxes(2, 3)
    first = broadmark.Groups(layers=np.array([1, 0, 0]))
    for second, message in (
        (broadmark.Groups(worlds=np.array([1, 0, 0])), "only layers and tags"),
        (broadmark.Groups(colliding_layers=((0, 1),)), "only layers and tags"),
        (broadmark.Groups(layers=np.array([32, 0, 0])), "frame 1: layers: expected numbers"),
        (broadmark.Groups(tags=np.array([1, 0, 0])), "frame 1: tags: expected"),
        (None, "fewer groups"),
    ):
        with pytest.raises(broadmark.InputError, match=message):
            groups = [first, second] if second else [first]
            broadmark.write_recording(tmp_path / "a.broadmark", boxes, groups=groups)
    assert not list(tmp_path.iterdir())


def test_the_reader_in_the_documents(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    manual = pathlib.Path(__file__).parents[2] / "docs/recordings.md"
    code = manual.read_text().split("```python\n")[1].split("```")[0]
    assert len(code.splitlines()) <= 12
    monkeypatch.chdir(tmp_path)
    for frames, bodies in ((40, 60), (3, 1), (300, 2)):
        boxes = changing_boxes(frames, bodies)
        broadmark.write_recording("city.broadmark", boxes)
        for last in (frames - 1, frames // 2):
            stop = code.replace("index.tolist()", f"index.tolist()[:{last + 1}]")
            names: dict[str, Any] = {}
            exec(stop, names)  # pylint: disable=exec-used
            np.testing.assert_array_equal(names["boxes"], boxes[last])


def test_only_changing_recordings_hold_absent_bodies_and_groups(tmp_path: pathlib.Path) -> None:
    boxes = changing_boxes(40, 60)
    with pytest.raises(broadmark.InputError, match="not a finite number"):
        broadmark.write_recording(tmp_path / "a.aabbs", boxes)
    with pytest.raises(broadmark.InputError, match="groups"):
        broadmark.write_recording(tmp_path / "a.aabbs", random_boxes(2, 60), groups=GROUPS)
    for bad in (
        broadmark.Groups(layers=np.full(60, 32)),
        broadmark.Groups(layers=np.zeros(59, int)),
        broadmark.Groups(tags=np.zeros((60, 2), int)),
        broadmark.Groups(worlds=np.zeros(60)),
        broadmark.Groups(colliding_layers=((0, 32),)),
    ):
        with pytest.raises(broadmark.InputError, match="expected"):
            broadmark.write_recording(tmp_path / "a.broadmark", boxes, groups=bad)
    boxes[3, 5] = [[np.inf] * 3, [1, 1, 1]]
    with pytest.raises(broadmark.InputError, match="frame 3: boxes: body 5"):
        broadmark.write_recording(tmp_path / "a.broadmark", boxes)
    assert not list(tmp_path.iterdir())


def test_invalid_changing_files_are_rejected(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "mine.broadmark"
    changing_recording(path)
    whole = path.read_bytes()
    index = int.from_bytes(whole[-32:-24], "little")
    nested = b"[" * (64 * 2000 - 16)
    for content in (
        b"",
        whole[:40],
        whole[:-1],
        whole[:-32],
        whole + bytes(32),
        b"X" + whole[1:],
        whole[:8] + b"\xff" * 8 + whole[16:],
        whole[:8] + len(nested).to_bytes(8, "little") + nested + whole[16:],
        whole.replace(b"recording/2", b"recording/3"),
        whole.replace(b'"objects": 60', b'"objects": 61'),
        whole.replace(b'"frames": 39', b'"frames": 38'),
        whole.replace(b'"objects": 60', b'"objects": 1e999'),
        whole.replace(b'"layers"', b'"liars"'),
        whole[: index + 40] + b"\xff" * 4 + whole[index + 44 :],
        whole[: index + 32] + b"\xff" * 8 + whole[index + 40 :],
    ):
        path.write_bytes(content)
        with pytest.raises(broadmark.InputError, match="mine.broadmark: "):
            broadmark.read_recording(path)


def test_invalid_files_are_rejected(tmp_path: pathlib.Path) -> None:
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


def test_an_archive_of_arrays_is_written_by_the_command(
    tmp_path: pathlib.Path, command: Any
) -> None:
    boxes = random_boxes(3, 4)
    archive, path = tmp_path / "boxes.npz", tmp_path / "mine.broadmark"
    for arrays in ({"any": boxes}, {"boxes": boxes, "times": np.arange(3)}):
        np.savez(archive, **arrays)
        assert command("write", archive, "-o", path) == (0, "", "")
        np.testing.assert_array_equal(broadmark.read_recording(path).boxes, boxes)
    np.savez_compressed(archive, first=boxes, second=boxes)
    status, _, error = command("write", archive, "-o", path)
    assert status == 2 and "boxes.npz: holds 2 arrays, none named boxes" in error
    archive.write_bytes(archive.read_bytes()[:-30])
    assert command("write", archive, "-o", path)[0] == 2
