"""Records boxes and pairs that a running program holds in arrays, for `broadmark audit`: NAME.broadmark
and NAME.csv. Needs numpy and xxhash: copy this file. The document docs/integrations.md of Broadmark has
an introduction, docs/recordings.md the format.

    with Recorder("session") as session:
        for step in simulation:
            session.frame(lower, upper, pairs)

Both files are complete after each frame, so a crash leaves the frames before it.

SPDX-License-Identifier: MIT
Copyright (c) 2026 The Broadmark authors
"""

import json
import os

import numpy as np
import xxhash

MAGIC = b"BRDMARK2"
HEADER_BYTES = 8192 - 16  #: with 16 bytes before it, a multiple of 32
INDEX = np.dtype([("offset", "<u8"), ("changed", "<u4"), ("key", "<u4"), ("hash", "<u8", 2)])


class Recorder:
    """Files NAME.broadmark and NAME.csv, which must not exist.

    `layers` (n,): a layer from 0 to 31 of each body, if only bodies of `colliding_layers` (pairs of
    layers) are pairs. `worlds` (n,): numbers of worlds, if only bodies of the same one are pairs.
    """

    def __init__(self, name, *, layers=None, worlds=None, colliding_layers=((0, 0),)):
        self._boxes = open(f"{name}.broadmark", "xb")
        self._pairs = open(f"{name}.csv", "x", encoding="ascii", newline="\n")
        self._pairs.write("frame,a,b\n")
        self._groups = {
            key: np.ascontiguousarray(values, type_)
            for key, values, type_ in (("layers", layers, "u1"), ("worlds", worlds, "<u4"))
            if values is not None
        }
        self._header = {
            "schema": "broadmark-recording/2",
            "name": os.path.basename(str(name)).encode("ascii", "replace").decode() or "session",
            "object_type": "Bodies",
            "all_present": True,
            "colliding_layers": [list(map(int, pair)) for pair in colliding_layers],
            "groups": list(self._groups),
            "source": None,
            "scene_parameters": None,
        }
        self._index = np.empty(0, INDEX)
        self._last = None
        self._end = 0
        self._world = np.array([[np.inf] * 3, [-np.inf] * 3])

    def frame(self, lower, upper, pairs):
        """Appends a frame: corners (n, 3) of the boxes, and pairs (m, 2) of their numbers. A body with a
        NaN is absent. Numbers other than 32-bit floats are rounded into the box, so that rounding alone
        makes no pair missed."""
        frame = len(self._index)
        lower, upper = np.atleast_2d(np.asarray(lower)), np.atleast_2d(np.asarray(upper))
        absent = np.isnan(lower).any(1) | np.isnan(upper).any(1)
        boxes = np.stack([_rounded(lower, np.inf), _rounded(upper, -np.inf)], 1)
        boxes[:, 0] = np.minimum(boxes[:, 0], boxes[:, 1])  # thinner than a float
        boxes[absent] = [[np.inf] * 3, [-np.inf] * 3]
        pairs = np.asarray(pairs).reshape(-1, 2)
        if self._last is not None and boxes.shape != self._last.shape:
            raise ValueError(f"frame {frame}: boxes {boxes.shape}, before {self._last.shape}")
        if (lower[~absent] > upper[~absent]).any():
            raise ValueError(f"frame {frame}: the lower end of a box is over its upper one")
        if any(len(values) != len(boxes) for values in self._groups.values()):
            raise ValueError(f"layers and worlds of {len(boxes)} bodies are expected")
        if pairs.size and (pairs.dtype.kind not in "iu" or pairs.min() < 0):
            raise ValueError(f"frame {frame}: pairs are expected to be integers from 0 on")
        self._header["all_present"] &= not absent.any()
        in_world = np.where(np.abs(boxes) < 1e15, boxes, np.nan)  # not the ends of half-spaces
        self._world[0] = np.fmin(self._world[0], np.fmin.reduce(in_world[:, 0], initial=np.inf))
        self._world[1] = np.fmax(self._world[1], np.fmax.reduce(in_world[:, 1], initial=-np.inf))
        # Pairs first: a log that is ahead of its recording is refused, one that is behind would look
        # as if pairs were missed.
        np.savetxt(self._pairs, np.insert(pairs, 0, frame, 1), "%d", ",")
        self._pairs.flush()
        self._write(boxes)

    def _write(self, boxes):
        ids = np.empty(0, "<u4")
        rows = boxes
        if self._last is None:
            groups = b"".join(_padded(values.tobytes()) for values in self._groups.values())
            self._head, self._end = groups, 16 + HEADER_BYTES + len(groups)
        else:
            changed = (boxes.view("<u4") != self._last.view("<u4")).any((1, 2))
            ids = np.flatnonzero(changed).astype("<u4")
            rows = boxes[ids]
        block = b"" if len(ids) == len(boxes) else _padded(ids.tobytes())
        block += _padded(rows.tobytes())
        entry = np.array([(self._end, len(ids), 0, _hash(block))], INDEX)
        self._index = np.concatenate([self._index, entry])
        world = np.where(self._world[0] <= self._world[1], self._world, 0)
        header = self._header | {"objects": len(boxes), "frames": len(self._index) - 1}
        text = (
            json.dumps(header | {"world": world.tolist()}).encode().ljust(HEADER_BYTES - 1) + b"\n"
        )
        if len(text) > HEADER_BYTES:
            raise ValueError("there are too many colliding layers")
        head = MAGIC + HEADER_BYTES.to_bytes(8, "little") + text + self._head
        digest = _hash(head + self._index.tobytes())
        self._boxes.seek(self._end)
        self._end += len(block)
        trailer = np.array([self._end, *digest], "<u8").tobytes() + MAGIC
        self._boxes.write(block + self._index.tobytes() + trailer)
        self._boxes.seek(0)
        self._boxes.write(head)
        self._boxes.flush()
        self._last = boxes

    def close(self):
        self._boxes.close()
        self._pairs.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def _rounded(bounds, towards):
    """As 32-bit floats, rounded up or down."""
    limit = np.finfo(np.float32).max
    bounds = np.clip(bounds, -limit, limit)
    floats = bounds.astype("<f4")
    is_outside = floats < bounds if towards > 0 else floats > bounds
    return np.where(is_outside, np.nextafter(floats, np.float32(towards)), floats)


def _padded(data):
    return data.ljust(-(-len(data) // 32) * 32, b"\0")


def _hash(data):
    value = xxhash.xxh3_128_intdigest(data)
    return value & (2**64 - 1), value >> 64
