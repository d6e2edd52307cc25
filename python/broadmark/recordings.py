"""Recordings as numpy arrays. Those of changing worlds (.broadmark) are in recording2. The others
(.aabbs, .posrot) have the format of the original Broadmark:

    char[128] name, char[128] object type, int32 bodies, int32 frames, int32 0, int32 0, world box,
    a box per body, then for each frame a record per body

A box is eight 32-bit floats: min x y z 0, max x y z 0. A record is a box (.aabbs) or a pose
(.posrot): position x y z 0, rotation x y z w.
"""

from __future__ import annotations

import itertools
import os
import pathlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from broadmark import recording2
from broadmark.arguments import Floats, as_boxes
from broadmark.errors import InputError
from broadmark.files import atomic_write

Path = str | os.PathLike[str]

HEADER = np.dtype(
    [
        ("name", "S128"),
        ("object_type", "S128"),
        ("bodies", "<i4"),
        ("frames", "<i4"),
        ("zeros", "<i4", 2),
        ("world", "<f4", (2, 4)),
    ]
)
RECORD_BYTES = 32


@dataclass(frozen=True)
class Recording:
    """Boxes of n bodies in the initial pose and F frames, mapped from the file."""

    name: str
    object_type: str
    world: Floats  #: (2, 3): min, max
    boxes: Floats  #: (F + 1, n, 2, 3); [0] is the initial pose; [..., 0, :] min, [..., 1, :] max


@dataclass(frozen=True)
class PoseRecording:
    """Poses of n bodies in F frames, mapped from the file."""

    name: str
    object_type: str
    world: Floats  #: (2, 3): min, max
    boxes: Floats  #: (n, 2, 3): of the bodies in their local frames
    positions: Floats  #: (F, n, 3)
    rotations: Floats  #: (F, n, 4): quaternions x y z w


EXTENSIONS = (".aabbs", ".broadmark", ".posrot")


def read_recording(path: Path) -> Recording | recording2.ChangingRecording | PoseRecording:
    """Maps a recording (.aabbs, .broadmark, .posrot) into memory; pages are read on access.

    Raises InputError for another file type or a wrong size. `broadmark verify` checks the values.
    """
    path = pathlib.Path(path)
    if path.suffix not in EXTENSIONS:
        raise InputError(f"{path}: not a recording: the extension must be one of {EXTENSIONS}")
    try:
        content = np.memmap(path, np.uint8, "r")
    except (OSError, ValueError) as error:  # ValueError: an empty file
        raise InputError(f"{path}: cannot be read: {error}") from None
    if path.suffix == ".broadmark":
        return recording2.read(path, content)
    if content.size < HEADER.itemsize:
        raise InputError(
            f"{path}: has {content.size} bytes, fewer than the header's {HEADER.itemsize}"
        )
    header = content[: HEADER.itemsize].view(HEADER)[0]
    bodies, frames = int(header["bodies"]), int(header["frames"])
    records = bodies * (1 + frames)
    expected_size = HEADER.itemsize + RECORD_BYTES * records
    if bodies < 0 or frames < 0 or content.size != expected_size:
        raise InputError(
            f"{path}: has {content.size} bytes, but its header states {bodies} bodies and "
            f"{frames} frames: expected {expected_size} bytes"
        )
    frame_data = content[HEADER.itemsize :].view("<f4").reshape(1 + frames, bodies, 2, 4)
    metadata = (_text(header["name"]), _text(header["object_type"]), header["world"][:, :3].copy())
    if path.suffix == ".aabbs":
        return Recording(*metadata, boxes=frame_data[..., :3])
    poses = frame_data[1:]
    return PoseRecording(
        *metadata,
        boxes=frame_data[0, :, :, :3],
        positions=poses[:, :, 0, :3],
        rotations=poses[:, :, 1],
    )


def _text(field: bytes) -> str:
    return field.split(b"\0", 1)[0].decode("ascii", "replace")


def write_recording(
    path: Path,
    boxes: Iterable[Any],
    *,
    name: str = "Custom",
    object_type: str = "Boxes",
    world: Any = None,
    groups: recording2.Groups | Iterable[recording2.Groups] | None = None,
) -> None:
    """Writes boxes as a recording (.aabbs, .broadmark).

    `boxes` is an array (F + 1, n, 2, 3), or an iterable of arrays (n, 2, 3) or (n, 6), consumed as
    the file is written: the initial pose, which is not timed, then the frames. `world` (2, 3) is the
    bounding box of all boxes by default. `groups`: the collision filter, or, if layers or tags
    change, that of each set. EMPTY_BOX for absent bodies and `groups` require .broadmark. Numbers other
    than 32-bit floats are rounded outward. The file is written atomically. Raises InputError for boxes
    that a recording cannot hold.
    """
    path = pathlib.Path(path)
    is_changing = path.suffix == ".broadmark"
    if path.suffix != ".aabbs" and not is_changing:
        raise InputError(
            f"{path}: the extension of a recording of boxes must be .aabbs or .broadmark"
        )
    if groups is not None and not is_changing:
        raise InputError(f"{path}: groups of bodies require the extension .broadmark")
    _field("name", name), _field("object type", object_type)
    if not isinstance(boxes, Iterable):
        raise InputError(f"boxes: expected an array or arrays, not type {type(boxes).__name__}")
    frames = _validated(boxes, may_be_absent=is_changing)
    first = next(frames, None)
    if first is None:
        raise InputError(_too_few(0))
    with atomic_write(path) as file:
        writer: recording2.Writer | _AabbsWriter
        if is_changing:
            all_groups = _groups_of_frames(path, groups)
            bodies, initial = len(first), next(all_groups)
            header = recording2.new_header(
                name, object_type, bodies, initial, not isinstance(groups, recording2.Groups | None)
            )
            writer = recording2.Writer(file, header, initial, bodies)
        else:
            writer = _AabbsWriter(file, name, object_type, len(first))
        bounds: Floats | None = None
        frame_count = 0
        for array in itertools.chain([first], frames):
            if isinstance(writer, recording2.Writer):
                writer.write(array, next(all_groups) if frame_count > 0 else None)
            else:
                writer.write(array)
            present_boxes = array[recording2.present(array)]
            if len(present_boxes):
                frame_bounds = np.stack([present_boxes[:, 0].min(0), present_boxes[:, 1].max(0)])
                bounds = frame_bounds if bounds is None else _merged(bounds, frame_bounds)
            frame_count += 1
        if frame_count < 2:
            raise InputError(_too_few(frame_count))
        if world is not None:
            bounds = as_boxes(np.asarray(world)[np.newaxis])[0]
        writer.finish(np.zeros((2, 3), np.float32) if bounds is None else bounds)


def _groups_of_frames(path: pathlib.Path, groups: Any) -> Iterator[recording2.Groups]:
    """The groups of each frame, without end if they do not change."""
    if groups is None or isinstance(groups, recording2.Groups):
        yield from itertools.repeat(groups or recording2.Groups())
        return
    for of_frame in groups if isinstance(groups, Iterable) else [groups]:
        if not isinstance(of_frame, recording2.Groups):
            raise InputError(f"groups: expected Groups, not type {type(of_frame).__name__}")
        yield of_frame
    raise InputError(f"{path}: there are fewer groups than sets of boxes")


def _too_few(frame_count: int) -> str:
    return f"boxes: expected at least 2 sets, the initial pose and a frame; got {frame_count}"


def _validated(boxes: Iterable[Any], may_be_absent: bool) -> Iterator[Floats]:
    """The frames as validated arrays of the same size."""
    bodies: int | None = None
    for number, frame in enumerate(boxes):
        try:
            array = as_boxes(frame, may_be_absent=may_be_absent)
        except InputError as error:
            raise InputError(f"frame {number}: {error}") from None
        bodies = len(array) if bodies is None else bodies
        if len(array) != bodies:
            raise InputError(f"frame {number}: has {len(array)} bodies, the first frame {bodies}")
        yield array


class _AabbsWriter:
    """Writes an .aabbs recording to an open file, frame by frame."""

    def __init__(self, file: Any, name: str, object_type: str, bodies: int) -> None:
        self._file = file
        self._header = np.zeros(1, HEADER)
        self._header["name"] = _field("name", name)
        self._header["object_type"] = _field("object type", object_type)
        self._header["bodies"], self._header["frames"] = bodies, -1
        self._header.tofile(file)

    def write(self, boxes: Floats) -> None:
        records = np.zeros((len(boxes), 2, 4), "<f4")
        records[..., :3] = boxes
        records.tofile(self._file)
        self._header["frames"] += 1

    def finish(self, world: Floats) -> None:
        self._header["world"][0, :, :3] = world
        self._file.seek(0)
        self._header.tofile(self._file)


def _merged(a: Floats, b: Floats) -> Floats:
    return np.stack([np.minimum(a[0], b[0]), np.maximum(a[1], b[1])])


def _field(name: str, text: str) -> bytes:
    is_text = isinstance(text, str) and text.isascii() and text.isprintable()
    if not is_text or not 0 < len(text) < 128:
        raise InputError(f"{name} {text!r}: expected 1 to 127 printable ASCII characters")
    return text.encode("ascii")
