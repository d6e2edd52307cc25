"""Recordings of worlds that change (.broadmark), as arrays, and back; docs/recordings.md describes
the bytes. In a frame stands only what changed since the one before; a key frame holds all boxes.
"""

from __future__ import annotations

import dataclasses
import functools
import json
import pathlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from broadmark.errors import InputError
from broadmark.files import whole_file

Floats = npt.NDArray[np.float32]
Ids = npt.NDArray[np.uint32]

MAGIC = b"BRDMARK2"
SCHEMA = "broadmark-recording/2"
ALIGNMENT = 32
LAYERS = 32
NO_TAG = 0xFFFFFFFF
START = np.dtype([("magic", "S8"), ("header_bytes", "<u8")])
INDEX = np.dtype([("offset", "<u8"), ("changed", "<u4"), ("key", "<u4"), ("hash", "<u8", 2)])
END = np.dtype([("index_offset", "<u8"), ("hash", "<u8", 2), ("magic", "S8")])
#: Numbers of bodies that may follow the header, in this order.
GROUPS: dict[str, tuple[str, tuple[int, ...]]] = {
    "layers": ("u1", ()),
    "worlds": ("<u4", ()),
    "tags": ("<u4", (3,)),
}
BOX_BYTES = 24
MOST_BETWEEN_KEYS = 256

#: The box of a body that is absent.
EMPTY_BOX: Floats = np.array([[np.inf] * 3, [-np.inf] * 3], np.float32)


@dataclass(frozen=True)
class Groups:
    """Which pairs are wanted: none of layers that do not collide, of two worlds, or with a common
    tag."""

    layers: Any = None  #: an array (n,); None: all in layer 0
    worlds: Any = None  #: (n,); None: all in world 0
    tags: Any = None  #: (n, 3); NO_TAG: none; None: no body has any
    #: pairs of layers; a pair counts both ways
    colliding_layers: tuple[tuple[int, int], ...] = ((0, 0),)


@dataclass(frozen=True)
class ChangingRecording:
    """Boxes of n bodies in F frames after the initial pose, some of them absent, mapped from the
    file."""

    name: str
    object_type: str
    world: Floats  #: (2, 3): min, max
    bodies: int  #: n
    last_frame: int  #: F
    all_present: bool  #: no body is ever absent
    groups: Groups
    source: str | None  #: the file that it was made from
    scene_parameters: dict[str, Any] | None  #: as in the sidecar of a baked recording
    _content: npt.NDArray[np.uint8] = dataclasses.field(repr=False)
    _index: Any = dataclasses.field(repr=False)

    def changed(self, frame: int) -> Ids:
        """The bodies that moved, came or went since the frame before, ascending."""
        return self._parts(frame)[0]

    def frame(self, frame: int) -> Floats:
        """The boxes (n, 2, 3) of a frame; EMPTY_BOX: absent."""
        boxes = np.empty((self.bodies, 2, 3), np.float32)
        for k in range(int(self._entry(frame)["key"]), frame + 1):
            self._apply(k, boxes)
        return boxes

    def frames(self) -> Iterator[tuple[Floats, Ids]]:
        """The boxes (n, 2, 3) of each frame, and which bodies changed. It is always the same array:
        copy what is to be kept."""
        boxes = np.empty((self.bodies, 2, 3), np.float32)
        seen = boxes.view()
        seen.flags.writeable = False
        for k in range(self.last_frame + 1):
            yield seen, self._apply(k, boxes)

    @functools.cached_property
    def boxes(self) -> Floats:
        """All frames (F + 1, n, 2, 3), made when first asked for."""
        all_boxes = np.empty((self.last_frame + 1, self.bodies, 2, 3), np.float32)
        for k, (boxes, _) in enumerate(self.frames()):
            all_boxes[k] = boxes
        return all_boxes

    def _entry(self, frame: int) -> Any:
        if not 0 <= frame <= self.last_frame:
            raise InputError(f"{self.name}: no frame {frame}: the last one is {self.last_frame}")
        return self._index[frame]

    def _parts(self, frame: int) -> tuple[Ids, Floats]:
        """Of a frame: who changed, and the boxes in it."""
        entry = self._entry(frame)
        count, whole = int(entry["changed"]), int(entry["key"]) == frame
        start = int(entry["offset"])
        if count == self.bodies:
            ids = np.arange(count, dtype=np.uint32)
        else:
            ids = self._content[start : start + 4 * count].view("<u4")
            if (ids >= self.bodies).any():
                raise InputError(f"{self.name}: frame {frame}: changes a body that does not exist")
            start += _aligned(4 * count)
        rows = self.bodies if whole else count
        packed = self._content[start : start + BOX_BYTES * rows].view("<f4")
        return ids, packed.reshape(rows, 2, 3)

    def _apply(self, frame: int, boxes: Floats) -> Ids:
        ids, rows = self._parts(frame)
        if len(rows) == len(boxes):
            boxes[:] = rows
        else:
            boxes[ids] = rows
        return ids


def present(boxes: Floats) -> npt.NDArray[np.bool_]:
    """Of boxes (…, n, 2, 3): which bodies are there (…, n)."""
    return np.asarray(boxes[..., 0, 0] <= boxes[..., 1, 0])


def _aligned(size: int) -> int:
    return -(-size // ALIGNMENT) * ALIGNMENT


def read(path: pathlib.Path, content: npt.NDArray[np.uint8]) -> ChangingRecording:
    """The recording in a mapped file. Raises InputError for one that is not laid out as such; the
    values are checked by `broadmark verify`."""

    def require(right: bool, what: str) -> None:
        if not right:
            raise InputError(f"{path}: {what}")

    size = content.size
    require(size >= START.itemsize + END.itemsize, f"has only {size} bytes")
    start, end = content[: START.itemsize].view(START)[0], content[-END.itemsize :].view(END)[0]
    require(start["magic"] == MAGIC, f"does not begin with {MAGIC.decode()}")
    require(end["magic"] == MAGIC, f"does not end with {MAGIC.decode()}: is cut short")
    at = START.itemsize + int(start["header_bytes"])
    require(at <= size and at % ALIGNMENT == 0, "states a wrong size of its header")
    try:
        header = json.loads(content[START.itemsize : at].tobytes())
        require(header["schema"] == SCHEMA, f"is no {SCHEMA}")
        bodies, last = int(header["objects"]), int(header["frames"])
        world = np.array(header["world"], np.float32).reshape(2, 3)
        named = [str(group) for group in header["groups"]]
        colliding = tuple((int(a), int(b)) for a, b in header["colliding_layers"])
        about = dict(
            name=str(header["name"]),
            object_type=str(header["object_type"]),
            all_present=bool(header["all_present"]),
            source=header.get("source"),
            scene_parameters=header.get("scene_parameters"),
        )
        numbers: dict[str, Any] = {}
        for group in named:
            kind, shape = GROUPS[group]
            count = bodies * int(np.prod(shape, dtype=int))
            length = count * np.dtype(kind).itemsize
            require(0 <= length <= size - at, f"is too short for the {group} of its bodies")
            numbers[group] = content[at : at + length].view(kind).reshape(bodies, *shape)
            at += _aligned(length)
    except (KeyError, TypeError, ValueError, OverflowError, RecursionError) as error:
        raise InputError(f"{path}: its header is none of a recording: {error}") from None
    index_at = int(end["index_offset"])
    index_end = size - END.itemsize
    require(
        bodies >= 0 and last >= 0 and index_end - index_at == INDEX.itemsize * (1 + last),
        f"its size is not that of {bodies} bodies and {last} frames",
    )
    index = content[index_at:index_end].view(INDEX)
    _require_index(path, index, at, index_at, bodies)
    groups = Groups(**numbers, colliding_layers=colliding)
    return ChangingRecording(
        **about,
        world=world,
        bodies=bodies,
        last_frame=last,
        groups=groups,
        _content=content,
        _index=index,
    )


def _require_index(path: pathlib.Path, index: Any, begin: int, end: int, bodies: int) -> None:
    """Frames follow each other, and nothing else lies between `begin` and `end`."""
    number = np.arange(len(index))
    changed = index["changed"].astype(np.int64)
    whole = index["key"] == number
    ids = np.where(changed < bodies, -(-4 * changed // ALIGNMENT), 0)
    boxes = -(-BOX_BYTES * np.where(whole, bodies, changed) // ALIGNMENT)
    ends = begin + ALIGNMENT * (ids + boxes).cumsum()
    starts = np.concatenate(([begin], ends[:-1]))
    before = np.concatenate(([0], index["key"][:-1]))
    if (
        not whole[0]
        or ends[-1] != end
        or (index["offset"] != starts).any()
        or (changed > bodies).any()
        or (~whole & (index["key"] != before)).any()
    ):
        raise InputError(f"{path}: its index does not fit to its frames")


class Writer:
    """Writes a recording into an open file, frame by frame."""

    def __init__(self, file: Any, header: dict[str, Any], groups: Groups, bodies: int) -> None:
        self._hash = _hasher()
        self._file = file
        self._header = header
        self._groups = groups
        self._bodies = bodies
        self._before: Floats | None = None
        self._index: list[tuple[int, int, int, tuple[int, int]]] = []
        self._since_key = 0
        # The world and the number of frames become known at the end.
        room = len(self._header_text(0)) + 256
        self._header_bytes = _aligned(START.itemsize + room) - START.itemsize
        file.seek(START.itemsize + self._header_bytes)
        self._group_bytes = b""
        for group, (kind, shape) in GROUPS.items():
            numbers = getattr(groups, group)
            if numbers is not None:
                self._group_bytes += _padded(_numbers(group, numbers, kind, (bodies, *shape)))
        file.write(self._group_bytes)

    def write(self, boxes: Floats) -> None:
        """Appends a frame (n, 2, 3)."""
        number = len(self._index)
        packed = np.ascontiguousarray(boxes, "<f4")
        if self._before is None:
            ids = np.empty(0, np.uint32)
        else:
            differs = packed.view("<u4") != self._before.view("<u4")
            ids = np.flatnonzero(differs.any((1, 2))).astype("<u4")
        self._since_key += (4 + BOX_BYTES) * len(ids)
        key = self._index[-1][2] if self._index else 0
        if (
            number == 0
            or self._since_key >= BOX_BYTES * self._bodies
            or number - key >= MOST_BETWEEN_KEYS
        ):
            key, self._since_key = number, 0
        block = b"" if len(ids) == self._bodies else _padded(ids.tobytes())
        block += _padded((packed if key == number else packed[ids]).tobytes())
        self._header["all_present"] &= bool(present(packed).all())
        self._index.append((self._file.tell(), len(ids), key, _digest(block)))
        self._file.write(block)
        self._before = packed.copy()

    def finish(self, world: Floats) -> None:
        """Writes what the file begins and ends with."""
        self._header["world"] = world.astype(float).tolist()
        index = np.array(self._index, INDEX)
        end = np.zeros(1, END)
        end["index_offset"], end["magic"] = self._file.tell(), MAGIC
        start = np.zeros(1, START)
        start["magic"], start["header_bytes"] = MAGIC, self._header_bytes
        head = start.tobytes() + self._header_text(self._header_bytes) + self._group_bytes
        end["hash"] = _digest(head + index.tobytes())
        self._file.write(index.tobytes() + end.tobytes())
        self._file.seek(0)
        self._file.write(head)

    def _header_text(self, size: int) -> bytes:
        self._header["frames"] = len(self._index) - 1
        text = json.dumps(self._header, indent=1, ensure_ascii=True).encode()
        return text.ljust(size - 1) + b"\n"


def new_header(name: str, object_type: str, bodies: int, groups: Groups) -> dict[str, Any]:
    """What a header says before the first frame is known."""
    for pair in groups.colliding_layers:
        if len(pair) != 2 or not all(0 <= layer < LAYERS for layer in pair):
            raise InputError(f"colliding layers {pair}: pairs of 0 to {LAYERS - 1} are expected")
    return {
        "schema": SCHEMA,
        "name": name,
        "object_type": object_type,
        "objects": bodies,
        "frames": 0,
        "world": [[0.0] * 3] * 2,
        "all_present": True,
        "colliding_layers": [list(pair) for pair in groups.colliding_layers],
        "groups": [group for group in GROUPS if getattr(groups, group) is not None],
        "source": None,
        "scene_parameters": None,
    }


def _numbers(group: str, numbers: Any, kind: str, shape: tuple[int, ...]) -> bytes:
    array = np.asarray(numbers)
    most = LAYERS - 1 if group == "layers" else NO_TAG
    if array.shape != shape or array.dtype.kind not in "iu":
        raise InputError(f"{group}: an array of integers of shape {shape} is expected")
    if array.size and (array.min() < 0 or array.max() > most):
        raise InputError(f"{group}: numbers from 0 to {most} are expected")
    return array.astype(kind).tobytes()


def _padded(data: bytes) -> bytes:
    return data.ljust(_aligned(len(data)), b"\0")


def _hasher() -> Any:
    try:
        import xxhash
    except ImportError:
        raise InputError("writing .broadmark needs the Python package xxhash") from None
    return xxhash


def _digest(data: bytes) -> tuple[int, int]:
    value = _hasher().xxh3_128_intdigest(data)
    return value & (2**64 - 1), value >> 64
