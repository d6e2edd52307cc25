"""The library for engines and games as a class, which keeps its state over frames."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from broadmark.arguments import (
    as_bodies,
    as_boxes,
    as_boxes,
    as_collisions,
    as_floats,
    as_integer,
    as_layers,
    as_limits,
    as_threads,
    as_vectors,
)
from broadmark.errors import InputError
from broadmark.native import native
from broadmark.recording2 import LAYERS, NO_TAG

Pairs = npt.NDArray[np.uint32]
Bodies = npt.NDArray[np.uint32]
Starts = npt.NDArray[np.int64]


class BroadPhase:
    """Finds the pairs of bodies whose boxes overlap, or the changes to these pairs, in each frame:

        broad_phase = BroadPhase(answer="events")
        for boxes in frames:
            broad_phase.update(boxes)
            began, ended = broad_phase.began(), broad_phase.ended()

    - `method`: the cost of "tide" grows with the number of moving bodies; "columns" finds all pairs
      in each update.
    - `answer`: "pairs" for `pairs()`, "events" for `began()` and `ended()`.
    - `margin`: each box is enlarged by this on every side, rounded outward.
    - `layers`: a symmetric matrix of at most 32 rows: whether two layers collide. Default: 32
      layers, which all collide.
    - `threads`: None for all cores. Worlds that were built with few bodies use one thread.
    - `order`: "sorted" pairs ascend by the first body, then the second: independent of threads,
      processor, method and history; "any": in the order of the search.
    - `changes`: how `update` uses its argument `changed`.
    - `isa`: the instruction set, "auto" for the best one of the processor.

    Bad arguments raise InputError and change nothing. If an update runs out of memory, only
    `restore` is allowed afterwards. Only one thread at a time may use an object.
    docs/embedding.md describes costs and limits.
    """

    def __init__(
        self,
        method: Literal["tide", "columns"] = "tide",
        *,
        answer: Literal["pairs", "events"] = "pairs",
        margin: float = 0,
        layers: Any = None,
        threads: int | None = 1,
        order: Literal["sorted", "any"] = "sorted",
        changes: Literal["verified", "trusted"] = "verified",
        isa: str = "auto",
    ) -> None:
        try:
            margin = float(margin)
        except (TypeError, ValueError):
            raise InputError(f"margin {margin!r}: expected a number") from None
        rows = [0xFFFF_FFFF] * LAYERS if layers is None else as_collisions(layers, LAYERS)
        self._last_layer = len(rows) - 1
        collides = rows + [0] * (LAYERS - len(rows))
        self._native = native().BroadPhase(
            str(method),
            str(answer),
            str(order),
            str(changes),
            as_threads(threads),
            str(isa),
            margin,
            collides,
        )

    def update(self, boxes: Any, changed: Any = None) -> None:
        """Takes the boxes of all bodies, and finds the answer. Body i has `boxes[i]`.

        `boxes` is an array (n, 2, 3) or (n, 6): min x y z, max x y z. An array of 32-bit floats is
        read in place, without a copy, if the coordinates of a corner are contiguous. Other numbers
        are converted and rounded outward: min down, max up. Touching boxes overlap. Bodies may
        appear and disappear: an absent body has EMPTY_BOX; n may change.

        `changed`: the bodies that moved, appeared or vanished; it may list others, too. Verified
        changes (the default): all boxes are compared, and a changed body that is not listed is an
        error. Trusted changes: only the listed bodies and new ones are read.

        Releases the GIL: no other thread may write to `boxes` meanwhile.
        """
        array = as_floats(boxes)
        if len(array) and (array.strides[2] != 4 or array.strides[0] < 12):
            array = np.ascontiguousarray(array)
        listed = None if changed is None else as_bodies("changed", changed, len(array))
        try:
            self._native.update(array, listed)
        except InputError:
            as_boxes(array, may_be_absent=True)  # names the fault as for all arrays of boxes
            raise

    def pairs(self) -> Pairs:
        """All pairs of the last update, if the answer is "pairs": (m, 2), the smaller body first."""
        return self._answer(self._native.pairs)

    def began(self) -> Pairs:
        """The pairs that began in the last update, if the answer is "events"."""
        return self._answer(self._native.began)

    def ended(self) -> Pairs:
        """The pairs that ended in the last update, if the answer is "events"."""
        return self._answer(self._native.ended)

    @staticmethod
    def _answer(find: Any) -> Pairs:
        pairs: Pairs = find()
        return pairs

    # Queries: about the boxes and layers of the last update or restore, with the margin. All release
    # the GIL.

    def overlapping(
        self, boxes: Any, *, layers: Iterable[int] | None = None
    ) -> tuple[Starts, Bodies]:
        """The bodies that overlap each of `boxes`, ascending: (starts, bodies). Answer i is
        `bodies[starts[i]:starts[i + 1]]`.

        `boxes` as in `update`; none may be empty. `layers`: only bodies of these; None for all.
        """
        array = np.ascontiguousarray(as_boxes(boxes))
        found: tuple[Starts, Bodies] = self._native.overlapping(array, as_layers(layers))
        return found

    def cast(
        self,
        origins: Any,
        directions: Any,
        *,
        hits: Literal["closest", "all"] = "closest",
        max_fraction: Any = 1,
        layers: Iterable[int] | None = None,
    ) -> tuple[Starts, Bodies, npt.NDArray[np.float64]]:
        """The bodies hit by rays, or by boxes that move: (starts, bodies, fractions), as for
        `overlapping`. Ascending by fraction, then body; of each ray the closest hit, or all.

        `origins`: points (n, 3), or boxes as in `update`. `directions` (n, 3): the motions of the
        origins. A hit after half of the motion has the fraction 0.5, at its end 1, which is the
        default of `max_fraction` (a number, or one for each; inf: no limit). Points and directions
        are rounded to 32-bit floats. No hit is missed; a miss within rounding errors may be a hit.
        """
        points = np.asanyarray(origins)
        if points.ndim == 2 and points.shape[1] == 3:
            points = as_vectors("origins", origins)
            boxes = np.stack([points, points], axis=1)
        else:
            boxes = np.ascontiguousarray(as_boxes(origins))
        vectors = as_vectors("directions", directions)
        if len(vectors) != len(boxes):
            raise InputError(f"directions: {len(vectors)}, but {len(boxes)} origins")
        limits = as_limits("max_fraction", max_fraction, len(boxes))
        found: tuple[Starts, Bodies, npt.NDArray[np.float64]] = self._native.cast(
            boxes, vectors, limits, str(hits), as_layers(layers)
        )
        return found

    def nearest(
        self,
        points: Any,
        count: int = 1,
        *,
        max_distance: Any = np.inf,
        layers: Iterable[int] | None = None,
    ) -> tuple[Starts, Bodies, npt.NDArray[np.float64]]:
        """The `count` bodies nearest to each of `points` (n, 3): (starts, bodies, distances), as for
        `overlapping`. Ascending by distance to the body's box, then body. Fewer if no more are within
        `max_distance` (a number, or one for each)."""
        vectors = as_vectors("points", points)
        limits = as_limits("max_distance", max_distance, len(vectors))
        count = as_integer("count", count, 0, NO_TAG)
        found: tuple[Starts, Bodies, npt.NDArray[np.float64]] = self._native.nearest(
            vectors, count, limits, as_layers(layers)
        )
        return found

    @property
    def size(self) -> int:
        """The number of boxes in the last update."""
        return int(self._native.size())

    def set_filter(self, body: int, layer: int = 0, tags: Iterable[int] = ()) -> None:
        """Sets a body's layer and at most three tags, from the next update on, which then costs at
        least as much as the first. Bodies that share a tag are no pair. The body need not exist yet;
        the filter stays when it vanishes."""
        body = as_integer("body", body, 0, NO_TAG)
        layer = as_integer("layer", layer, 0, self._last_layer)
        try:
            numbers = [as_integer("tag", tag, 0, NO_TAG - 1) for tag in tags]
        except TypeError:
            raise InputError(f"tags {tags!r}: expected a list of numbers") from None
        if len(numbers) > 3:
            raise InputError(f"tags {numbers}: a body has at most 3")
        self._native.set_filter(body, layer, numbers)

    def save(self) -> bytes:
        """The state after the last update. Equal states give equal bytes, if the answer is sorted.
        Not allowed between `set_filter` and `update`."""
        state: bytes = self._native.save()
        return state

    def restore(self, state: bytes | bytearray | memoryview) -> None:
        """Back to a saved state, of this or another object with the same answer, margin and layers:
        the answer is the saved one, the next update's events are relative to it. Releases the GIL.
        """
        if not isinstance(state, (bytes, bytearray, memoryview)):
            raise InputError(f"state: expected saved bytes, not type {type(state).__name__}")
        self._native.restore(bytes(state))
