"""Recordings as numpy arrays. The files (.aabbs, .posrot) are those of the original Broadmark:

    char[128] name, char[128] object type, int32 bodies, int32 frames, int32 0, int32 0, world box,
    a box for each body, then `frames` times a record for each body

A box is eight 32-bit floats: min x y z 0, max x y z 0. A record is a box (.aabbs) or a pose
(.posrot): position x y z 0, rotation x y z w.
"""

from __future__ import annotations

import os
import pathlib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from broadmark.errors import InputError
from broadmark.files import whole_file

Path = str | os.PathLike[str]
Floats = npt.NDArray[np.float32]

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
    """Boxes of n bodies in F frames after the initial pose, mapped from the file."""

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
    boxes: Floats  #: (n, 2, 3): of the bodies before they were moved and turned
    positions: Floats  #: (F, n, 3)
    rotations: Floats  #: (F, n, 4): quaternions x y z w


def read_recording(path: Path) -> Recording | PoseRecording:
    """Maps a recording (.aabbs, .posrot): only what is used is read.

    Raises InputError for a file of another kind or size. `broadmark verify` checks all values.
    """
    path = pathlib.Path(path)
    if path.suffix not in (".aabbs", ".posrot"):
        raise InputError(f"{path}: is no recording: its name ends with neither .aabbs nor .posrot")
    try:
        content = np.memmap(path, np.uint8, "r")
    except (OSError, ValueError) as error:  # ValueError: an empty file
        raise InputError(f"{path}: cannot be read: {error}") from None
    if content.size < HEADER.itemsize:
        raise InputError(f"{path}: has {content.size} bytes, its header alone {HEADER.itemsize}")
    header = content[: HEADER.itemsize].view(HEADER)[0]
    bodies, frames = int(header["bodies"]), int(header["frames"])
    records = bodies * (1 + frames)
    expected = HEADER.itemsize + RECORD_BYTES * records
    if bodies < 0 or frames < 0 or content.size != expected:
        raise InputError(
            f"{path}: has {content.size} bytes, but {expected} with the {bodies} bodies "
            f"and {frames} frames of its header"
        )
    sets = content[HEADER.itemsize :].view("<f4").reshape(1 + frames, bodies, 2, 4)
    about = (_text(header["name"]), _text(header["object_type"]), header["world"][:, :3].copy())
    if path.suffix == ".aabbs":
        return Recording(*about, boxes=sets[..., :3])
    poses = sets[1:]
    return PoseRecording(
        *about,
        boxes=sets[0, :, :, :3],
        positions=poses[:, :, 0, :3],
        rotations=poses[:, :, 1],
    )


def _text(field: bytes) -> str:
    return field.split(b"\0", 1)[0].decode("ascii", "replace")


def as_boxes(boxes: Any) -> Floats:
    """Boxes as an array (n, 2, 3) of 32-bit floats, without copying one that is so already.

    Takes (n, 2, 3) and (n, 6): min x y z, max x y z. Raises InputError for other shapes, NaN and
    boxes whose min is greater than their max; an infinite side is one of these here, as recordings
    hold none.
    """
    array = np.asarray(boxes)
    if array.dtype.kind not in "iuf":
        raise InputError(f"boxes: of type {array.dtype}, not numbers")
    if array.ndim == 2 and array.shape[1] == 6:
        array = array.reshape(-1, 2, 3)
    if array.ndim != 3 or array.shape[1:] != (2, 3):
        raise InputError(f"boxes: of shape {array.shape}, not (n, 2, 3) or (n, 6)")
    array = array.astype(np.float32, copy=False)
    wrong = ~np.isfinite(array).all((1, 2))
    if wrong.any():
        raise InputError(
            f"boxes: body {int(wrong.argmax())} has a side that is not a finite number"
        )
    wrong = (array[:, 0] > array[:, 1]).any(1)
    if wrong.any():
        body = int(wrong.argmax())
        raise InputError(
            f"boxes: body {body} has its min {array[body, 0]} above its max {array[body, 1]}"
        )
    return array


def write_recording(
    path: Path,
    boxes: Iterable[Any],
    *,
    name: str = "Custom",
    object_type: str = "Boxes",
    world: Any = None,
) -> None:
    """Writes boxes as a recording (.aabbs).

    `boxes` is an array (F + 1, n, 2, 3), or any iterable of arrays (n, 2, 3) or (n, 6), taken one
    by one: the first is the initial pose, which is not timed, the others are the frames. `world`
    (2, 3): default, what contains all boxes. A file appears only when it is whole. Raises
    InputError for boxes that a recording cannot hold.
    """
    path = pathlib.Path(path)
    if path.suffix != ".aabbs":
        raise InputError(f"{path}: the name of a recording of boxes ends with .aabbs")
    header = np.zeros(1, HEADER)
    header["name"], header["object_type"] = _field("name", name), _field("object type", object_type)
    with whole_file(path) as file:
        header.tofile(file)
        sets = 0
        bounds: Floats | None = None
        for frame in boxes:
            try:
                array = as_boxes(frame)
            except InputError as error:
                raise InputError(f"frame {sets}: {error}") from None
            if sets == 0:
                header["bodies"] = len(array)
            elif len(array) != header["bodies"][0]:
                raise InputError(
                    f"frame {sets}: has {len(array)} bodies, the first {header['bodies'][0]}"
                )
            records = np.zeros((len(array), 2, 4), "<f4")
            records[..., :3] = array
            records.tofile(file)
            if len(array):
                reach = np.stack([array[:, 0].min(0), array[:, 1].max(0)])
                bounds = reach if bounds is None else _united(bounds, reach)
            sets += 1
        if sets < 2:
            raise InputError(
                f"{path}: {sets} sets of boxes: the initial pose and a frame are least"
            )
        header["frames"] = sets - 1
        if world is not None:
            bounds = as_boxes(np.asarray(world)[np.newaxis])[0]
        if bounds is not None:
            header["world"][0, :, :3] = bounds
        file.seek(0)
        header.tofile(file)


def _united(a: Floats, b: Floats) -> Floats:
    return np.stack([np.minimum(a[0], b[0]), np.maximum(a[1], b[1])])


def _field(what: str, text: str) -> bytes:
    if not text.isascii() or not text.isprintable() or not 0 < len(text) < 128:
        raise InputError(f"{what} '{text}': is not 1 to 127 printable ASCII characters")
    return text.encode("ascii")
