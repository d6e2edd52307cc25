"""Recordings of changing worlds (.broadmark) as arrays, read and written; docs/recordings.md
describes the format. A frame holds the boxes, and the layers and tags, that changed since the
previous frame, a key frame all of them.
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

from broadmark.arguments import EMPTY_BOX, Floats
from broadmark.errors import InputError
from broadmark.files import atomic_write

Ids = npt.NDArray[np.uint32]

MAGIC = b"BRDMARK2"
SCHEMA = "broadmark-recording/2"
#: With layers and tags that change.
FILTER_CHANGES_SCHEMA = "broadmark-recording/2.1"
#: Of a periodic world.
PERIODIC_SCHEMA = "broadmark-recording/2.2"
ALIGNMENT = 32
LAYERS = 32
NO_TAG = 0xFFFFFFFF
START = np.dtype([("magic", "S8"), ("header_bytes", "<u8")])
INDEX = np.dtype([("offset", "<u8"), ("changed", "<u4"), ("key", "<u4"), ("hash", "<u8", 2)])
TRAILER = np.dtype([("index_offset", "<u8"), ("hash", "<u8", 2), ("magic", "S8")])
#: Per-body data that may follow the header, in this order: type and shape per body.
GROUPS: dict[str, tuple[str, tuple[int, ...]]] = {
    "layers": ("u1", ()),
    "worlds": ("<u4", ()),
    "tags": ("<u4", (3,)),
}
BOX_BYTES = 24
#: A layer and three tags.
FILTER_BYTES = 16
MAX_KEY_INTERVAL = 256


@dataclass(frozen=True)
class Groups:
    """The collision filter: pairs of non-colliding layers, of two worlds or with a common tag are
    not reported."""

    layers: Any = None  #: an array (n,); None: all in layer 0
    worlds: Any = None  #: (n,); None: all in world 0
    tags: Any = None  #: (n, 3), NO_TAG for an unused entry; None: no body has tags
    #: unordered pairs of layers that collide
    colliding_layers: tuple[tuple[int, int], ...] = ((0, 0),)


@dataclass(frozen=True)
class ChangingRecording:
    """Boxes of n bodies in the initial pose and F frames, mapped from the file. Bodies may be
    absent."""

    name: str
    object_type: str
    world: Floats  #: (2, 3): min, max
    bodies: int  #: n
    last_frame: int  #: F
    all_present: bool  #: no body is ever absent
    groups: Groups  #: of the initial pose, and of all frames unless filter_changes
    filter_changes: bool  #: layers and tags change from frame to frame
    periodic: str | None  #: the periodic box, as in --periodic=0:10,0:10,-
    source: str | None  #: the file that it was converted from
    scene_parameters: dict[str, Any] | None  #: as in the sidecar of a baked recording
    _content: npt.NDArray[np.uint8] = dataclasses.field(repr=False)
    _index: Any = dataclasses.field(repr=False)
    _filter_counts: Any = dataclasses.field(repr=False)

    def changed(self, frame: int) -> Ids:
        """The bodies that moved, appeared or disappeared since the previous frame, ascending."""
        return self._block(frame)[0]

    def frame(self, frame: int) -> Floats:
        """The boxes (n, 2, 3) of a frame; absent bodies have EMPTY_BOX."""
        boxes = np.empty((self.bodies, 2, 3), np.float32)
        for k in range(int(self._entry(frame)["key"]), frame + 1):
            self._apply(k, boxes)
        return boxes

    def frames(self) -> Iterator[tuple[Floats, Ids]]:
        """The boxes (n, 2, 3) of each frame and the changed bodies. Every frame reuses the same array
        of boxes."""
        boxes = np.empty((self.bodies, 2, 3), np.float32)
        view = boxes.view()
        view.flags.writeable = False
        for k in range(self.last_frame + 1):
            yield view, self._apply(k, boxes)

    @functools.cached_property
    def boxes(self) -> Floats:
        """All frames (F + 1, n, 2, 3), decoded on first access."""
        all_boxes = np.empty((self.last_frame + 1, self.bodies, 2, 3), np.float32)
        for k, (boxes, _) in enumerate(self.frames()):
            all_boxes[k] = boxes
        return all_boxes

    def filter_changed(self, frame: int) -> Ids:
        """The bodies with other layers or tags than in the previous frame, ascending."""
        return self._filter_block(frame)[0]

    def groups_at(self, frame: int) -> Groups:
        """The collision filter of a frame."""
        key = int(self._entry(frame)["key"])
        if not self.filter_changes:
            return self.groups
        values = _filter_values(self.groups, self.bodies)
        for k in range(max(key, 1), frame + 1):
            ids, rows = self._filter_block(k)
            values[slice(None) if len(rows) == self.bodies else ids] = rows
        return dataclasses.replace(
            self.groups, layers=values[:, 0].astype(np.uint8), tags=values[:, 1:]
        )

    def _entry(self, frame: int) -> Any:
        if not 0 <= frame <= self.last_frame:
            raise InputError(f"{self.name}: no frame {frame}: the last frame is {self.last_frame}")
        return self._index[frame]

    def _block(self, frame: int) -> tuple[Ids, Floats]:
        """A frame's changed bodies and stored boxes."""
        entry = self._entry(frame)
        return self._rows(frame, int(entry["offset"]), int(entry["changed"]), BOX_BYTES)[:2]

    def _filter_block(self, frame: int) -> tuple[Ids, Any]:
        """A frame's bodies with changed filters, and the stored layers and tags (…, 4)."""
        entry = self._entry(frame)
        if frame == 0 or not self.filter_changes:
            return np.empty(0, np.uint32), np.empty((0, 4), np.uint32)
        *_, start = self._rows(frame, int(entry["offset"]), int(entry["changed"]), BOX_BYTES)
        ids, rows, _ = self._rows(frame, start, int(self._filter_counts[frame]), FILTER_BYTES)
        return ids, rows.view("<u4").reshape(len(rows), 4)

    def _rows(self, frame: int, start: int, count: int, row_bytes: int) -> tuple[Ids, Any, int]:
        """Ids, their rows, and the end of both."""
        is_key = int(self._entry(frame)["key"]) == frame
        if count == self.bodies:
            ids = np.arange(count, dtype=np.uint32)
        else:
            ids = self._content[start : start + 4 * count].view("<u4")
            if (ids >= self.bodies).any():
                raise InputError(f"{self.name}: frame {frame}: changes a body that does not exist")
            start += _aligned(4 * count)
        rows = self.bodies if is_key else count
        packed = self._content[start : start + row_bytes * rows].view("<f4")
        return ids, packed.reshape(rows, 2, row_bytes // 8), start + _aligned(row_bytes * rows)

    def _apply(self, frame: int, boxes: Floats) -> Ids:
        ids, rows = self._block(frame)
        if len(rows) == len(boxes):
            boxes[:] = rows
        else:
            boxes[ids] = rows
        return ids


def present(boxes: Floats) -> npt.NDArray[np.bool_]:
    """A mask (…, n) of the bodies that are present, from boxes (…, n, 2, 3)."""
    return np.asarray(boxes[..., 0, 0] <= boxes[..., 1, 0])


def _aligned(size: int) -> int:
    return -(-size // ALIGNMENT) * ALIGNMENT


def read(path: pathlib.Path, content: npt.NDArray[np.uint8]) -> ChangingRecording:
    """The recording in a mapped file. Raises InputError for an invalid layout; `broadmark verify`
    checks the values."""

    def require(condition: bool, message: str) -> None:
        if not condition:
            raise InputError(f"{path}: {message}")

    size = content.size
    require(size >= START.itemsize + TRAILER.itemsize, f"has only {size} bytes")
    start, trailer = (
        content[: START.itemsize].view(START)[0],
        content[-TRAILER.itemsize :].view(TRAILER)[0],
    )
    require(start["magic"] == MAGIC, f"does not begin with {MAGIC.decode()}")
    require(trailer["magic"] == MAGIC, f"does not end with {MAGIC.decode()}: the file is truncated")
    offset = START.itemsize + int(start["header_bytes"])
    require(offset <= size and offset % ALIGNMENT == 0, "the header states a wrong size for itself")
    try:
        header = json.loads(content[START.itemsize : offset].tobytes())
        schema = header["schema"]
        require(
            schema in (SCHEMA, FILTER_CHANGES_SCHEMA, PERIODIC_SCHEMA),
            f"is not a {SCHEMA}, nor 2.1 or 2.2",
        )
        is_periodic = schema == PERIODIC_SCHEMA
        filter_changes = schema == FILTER_CHANGES_SCHEMA
        if is_periodic:
            filter_changes = bool(header["filter_changes"])
        bodies, last = int(header["objects"]), int(header["frames"])
        world = np.array(header["world"], np.float32).reshape(2, 3)
        group_names = [str(group) for group in header["groups"]]
        colliding = tuple((int(a), int(b)) for a, b in header["colliding_layers"])
        metadata = dict(
            name=str(header["name"]),
            object_type=str(header["object_type"]),
            all_present=bool(header["all_present"]),
            periodic=str(header["periodic"]) if is_periodic else None,
            source=header.get("source"),
            scene_parameters=header.get("scene_parameters"),
        )
        group_data: dict[str, Any] = {}
        for group in group_names:
            type_, shape = GROUPS[group]
            count = bodies * int(np.prod(shape, dtype=int))
            length = count * np.dtype(type_).itemsize
            require(0 <= length <= size - offset, f"is too short for the {group} of its bodies")
            group_data[group] = (
                content[offset : offset + length].view(type_).reshape(bodies, *shape)
            )
            offset += _aligned(length)
    except InputError:
        raise
    except (KeyError, TypeError, ValueError, OverflowError, RecursionError) as error:
        raise InputError(f"{path}: the header is invalid: {error}") from None
    index_at = int(trailer["index_offset"])
    index_end = size - TRAILER.itemsize
    require(
        bodies >= 0 and last >= 0 and index_end - index_at == INDEX.itemsize * (1 + last),
        f"the size does not match {bodies} bodies and {last} frames",
    )
    index = content[index_at:index_end].view(INDEX)
    frames_end = index_at - (_aligned(4 * (1 + last)) if filter_changes else 0)
    require(frames_end >= offset, "is too short for its frames")
    filter_counts = content[frames_end:index_at].view("<u4")[: 1 + last]
    _require_index(path, index, filter_counts, offset, frames_end, bodies)
    groups = Groups(**group_data, colliding_layers=colliding)
    return ChangingRecording(
        **metadata,
        world=world,
        bodies=bodies,
        last_frame=last,
        groups=groups,
        filter_changes=filter_changes,
        _content=content,
        _index=index,
        _filter_counts=filter_counts,
    )


def _require_index(
    path: pathlib.Path, index: Any, filter_counts: Any, begin: int, end: int, bodies: int
) -> None:
    """Raises InputError unless the frames fill the range from `begin` to `end` without gaps."""
    number = np.arange(len(index))
    changed = index["changed"].astype(np.int64)
    is_key = index["key"] == number

    def units(count: Any, row_bytes: int) -> Any:
        ids = np.where(count < bodies, -(-4 * count // ALIGNMENT), 0)
        return ids + -(-row_bytes * np.where(is_key, bodies, count) // ALIGNMENT)

    sizes = units(changed, BOX_BYTES)
    if len(filter_counts) > 0:
        # Frame 0 has the header's.
        sizes += np.where(number > 0, units(filter_counts.astype(np.int64), FILTER_BYTES), 0)
    ends = begin + ALIGNMENT * sizes.cumsum()
    starts = np.concatenate(([begin], ends[:-1]))
    before = np.concatenate(([0], index["key"][:-1]))
    if (
        not is_key[0]
        or ends[-1] != end
        or (index["offset"] != starts).any()
        or (changed > bodies).any()
        or (filter_counts > bodies).any()
        or filter_counts[:1].any()
        or (~is_key & (index["key"] != before)).any()
    ):
        raise InputError(f"{path}: the index does not match the frames")


def write_copy(path: str, recording: ChangingRecording) -> None:
    """Writes a recording as it was read."""
    with atomic_write(path) as file:
        file.write(recording._content)


class Writer:
    """Writes a recording to an open file, frame by frame. `groups` are the first frame's."""

    def __init__(self, file: Any, header: dict[str, Any], groups: Groups, bodies: int) -> None:
        self._hash = _hasher()
        self._file = file
        self._header = header
        self._groups = groups
        self._bodies = bodies
        self._previous: Floats | None = None
        self._filter_changes = header["schema"] == FILTER_CHANGES_SCHEMA
        self._filter_counts: list[int] = []
        self._index: list[tuple[int, int, int, tuple[int, int]]] = []
        self._since_key = 0
        # Reserve room: the world box and the number of frames are known only at the end.
        reserved = len(self._header_text(0)) + 256
        self._header_bytes = _aligned(START.itemsize + reserved) - START.itemsize
        file.seek(START.itemsize + self._header_bytes)
        self._group_bytes = b""
        for group, (type_, shape) in GROUPS.items():
            values = getattr(groups, group)
            if values is not None:
                self._group_bytes += _padded(_group_data(group, values, type_, (bodies, *shape)))
        file.write(self._group_bytes)
        self._filter = _filter_values(groups, bodies)

    def write(self, boxes: Floats, groups: Groups | None = None) -> None:
        """Appends a frame (n, 2, 3), with its own groups if filters change."""
        number = len(self._index)
        packed = np.ascontiguousarray(boxes, "<f4")
        if self._previous is None:
            ids = np.empty(0, np.uint32)
        else:
            differs = packed.view("<u4") != self._previous.view("<u4")
            ids = np.flatnonzero(differs.any((1, 2))).astype("<u4")
        filter_ids = self._update_filter(groups) if groups else np.empty(0, np.uint32)
        self._since_key += (4 + BOX_BYTES) * len(ids) + (4 + FILTER_BYTES) * len(filter_ids)
        row_bytes = BOX_BYTES + (FILTER_BYTES if self._filter_changes else 0)
        key = self._index[-1][2] if self._index else 0
        if (
            number == 0
            or self._since_key >= row_bytes * self._bodies
            or number - key >= MAX_KEY_INTERVAL
        ):
            key, self._since_key = number, 0
        block = self._rows(ids, packed, key == number)
        if self._filter_changes and number > 0:
            block += self._rows(filter_ids, self._filter, key == number)
        self._filter_counts.append(len(filter_ids))
        self._header["all_present"] &= bool(present(packed).all())
        self._index.append((self._file.tell(), len(ids), key, _digest(block)))
        self._file.write(block)
        self._previous = packed.copy()

    def _rows(self, ids: Any, rows: Any, is_key: bool) -> bytes:
        """The ids, unless they are all, and their rows, or all of a key frame."""
        block = b"" if len(ids) == self._bodies else _padded(ids.tobytes())
        return block + _padded((rows if is_key else rows[ids]).tobytes())

    def _update_filter(self, groups: Groups) -> Any:
        """Applies the groups of the next frame. Returns the bodies with changes."""
        number = len(self._index)
        for group in ("layers", "tags"):
            values = getattr(groups, group)
            if values is not None:
                type_, shape = GROUPS[group]
                _group_data(f"frame {number}: {group}", values, type_, (self._bodies, *shape))
        same_worlds = np.array_equal(
            _worlds(groups, self._bodies), _worlds(self._groups, self._bodies)
        )
        if not same_worlds or groups.colliding_layers != self._groups.colliding_layers:
            raise InputError(f"frame {number}: groups: only layers and tags may change")
        before, self._filter = self._filter, _filter_values(groups, self._bodies)
        return np.flatnonzero((before != self._filter).any(1)).astype("<u4")

    def finish(self, world: Floats) -> None:
        """Writes the header, the index and the trailer."""
        self._header["world"] = world.astype(float).tolist()
        index = np.array(self._index, INDEX)
        trailer = np.zeros(1, TRAILER)
        counts = _padded(np.array(self._filter_counts, "<u4").tobytes())
        counts = counts if self._filter_changes else b""
        trailer["index_offset"], trailer["magic"] = self._file.tell() + len(counts), MAGIC
        start = np.zeros(1, START)
        start["magic"], start["header_bytes"] = MAGIC, self._header_bytes
        head = start.tobytes() + self._header_text(self._header_bytes) + self._group_bytes
        trailer["hash"] = _digest(head + counts + index.tobytes())
        self._file.write(counts + index.tobytes() + trailer.tobytes())
        self._file.seek(0)
        self._file.write(head)

    def _header_text(self, size: int) -> bytes:
        self._header["frames"] = len(self._index) - 1
        text = json.dumps(self._header, indent=1, ensure_ascii=True).encode()
        return text.ljust(size - 1) + b"\n"


def new_header(
    name: str, object_type: str, bodies: int, groups: Groups, filter_changes: bool = False
) -> dict[str, Any]:
    """The header of a recording without frames."""
    for pair in groups.colliding_layers:
        if len(pair) != 2 or not all(0 <= layer < LAYERS for layer in pair):
            raise InputError(
                f"colliding layers {pair}: expected pairs of layers from 0 to {LAYERS - 1}"
            )
    return {
        "schema": FILTER_CHANGES_SCHEMA if filter_changes else SCHEMA,
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


def _filter_values(groups: Groups, bodies: int) -> Any:
    """The layer and the tags of each body, as stored in a frame (n, 4)."""
    values = np.full((bodies, 4), NO_TAG, "<u4")
    values[:, 0] = 0 if groups.layers is None else groups.layers
    if groups.tags is not None:
        values[:, 1:] = groups.tags
    return values


def _worlds(groups: Groups, bodies: int) -> Any:
    return np.zeros(bodies) if groups.worlds is None else np.asarray(groups.worlds)


def _group_data(group: str, values: Any, type_: str, shape: tuple[int, ...]) -> bytes:
    array = np.asarray(values)
    maximum = LAYERS - 1 if group.endswith("layers") else NO_TAG
    if array.shape != shape or array.dtype.kind not in "iu":
        raise InputError(f"{group}: expected an array of integers of shape {shape}")
    if array.size and (array.min() < 0 or array.max() > maximum):
        raise InputError(f"{group}: expected numbers from 0 to {maximum}")
    return array.astype(type_).tobytes()


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
