"""Tests of the broad phase that keeps its state over frames."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import broadmark
from broadmark import EMPTY_BOX, BroadPhase

NO_TAGS = np.full(3, -1)
METHODS = ["tide", "columns"]

PairSet = set[tuple[int, int]]


class World:
    """Bodies that move, come and go, with layers and tags."""

    def __init__(self, seed: int, bodies: int = 120) -> None:
        self._generator = np.random.default_rng(seed)
        self.boxes = np.tile(EMPTY_BOX, (bodies, 1, 1))
        self.layers = np.zeros(bodies, int)
        self.tags = np.tile(NO_TAGS, (bodies, 1))

    def step(self) -> Any:
        """Some bodies move, appear or vanish, and their number may change. Returns the changed."""
        some = self._generator.random
        if some() < 0.2:
            bodies = int(self._generator.integers(60, 200))
            kept = self.boxes[:bodies]
            added = np.tile(EMPTY_BOX, (bodies - len(kept), 1, 1))
            self.boxes = np.concatenate([kept, added])
            for name, value in (("layers", 0), ("tags", NO_TAGS)):
                values = getattr(self, name)
                if len(values) < bodies:  # filters stay when bodies vanish
                    more = np.full((bodies - len(values), *values.shape[1:]), value)
                    setattr(self, name, np.concatenate([values, more]))
        bodies = len(self.boxes)
        moved = some(bodies) < some() ** 2
        low = np.round(self._generator.uniform(0, 8, (moved.sum(), 3)), 1)
        size = self._generator.integers(0, 3, (moved.sum(), 3))
        self.boxes[moved] = np.stack([low, low + size], axis=1)
        vanished = some(bodies) < 0.05
        self.boxes[vanished] = EMPTY_BOX
        return np.flatnonzero(moved | vanished)

    def change_filter(self, broad_phase: BroadPhase, layers: int) -> None:
        body = int(self._generator.integers(len(self.boxes)))
        self.layers[body] = self._generator.integers(layers)
        count = self._generator.integers(4)
        self.tags[body] = NO_TAGS
        self.tags[body, :count] = self._generator.integers(0, 4, count)
        tags = self.tags[body, :count].tolist()
        broad_phase.set_filter(body, int(self.layers[body]), tags)

    def pairs(self, matrix: Any = None, margin: float = 0) -> PairSet:
        """By brute force."""
        low, high = self.boxes[:, None, 0] - margin, self.boxes[None, :, 1] + margin
        found = (low <= high).all(2)
        found &= found.T
        bodies = len(self.boxes)
        if matrix is not None:
            layers = self.layers[:bodies]
            found &= matrix[layers[:, None], layers[None, :]]
        tags = self.tags[:bodies]
        common = (tags[:, None, :, None] == tags[None, :, None, :]) & (tags >= 0)[:, None, :, None]
        found &= ~common.any((2, 3))
        return {(a, b) for a, b in np.argwhere(found).tolist() if a < b}


def as_set(pairs: Any) -> PairSet:
    assert pairs.dtype == np.uint32 and pairs.shape == (len(pairs), 2)
    found = {(a, b) for a, b in pairs.tolist()}
    assert len(found) == len(pairs)
    return found


def frames_of(world: World, count: int = 60) -> Iterator[Any]:
    for _ in range(count):
        yield world.step()


@pytest.mark.parametrize("isa", ["auto", "scalar"])
@pytest.mark.parametrize("method", METHODS)
def test_pairs_are_those_of_brute_force(method: Any, isa: str) -> None:
    world = World(1)
    broad_phase = BroadPhase(method, isa=isa)
    found = 0
    for _ in frames_of(world):
        broad_phase.update(world.boxes)
        pairs = broad_phase.pairs()
        assert as_set(pairs) == world.pairs()
        assert pairs.tolist() == sorted(pairs.tolist())
        assert broad_phase.size == len(world.boxes)
        found += len(pairs)
    assert found > 1000


@pytest.mark.parametrize("threads", [2, None])
@pytest.mark.parametrize("method", METHODS)
def test_several_threads_find_the_pairs(method: Any, threads: int | None) -> None:
    generator = np.random.default_rng(7)
    broad_phase = BroadPhase(method, threads=threads)
    low = generator.uniform(0, 20, (6000, 1, 3)).astype(np.float32)  # enough for threads
    for _ in range(4):
        low += generator.normal(0, 0.1, low.shape).astype(np.float32)
        boxes = np.concatenate([low, low + 1], axis=1)
        broad_phase.update(boxes)
        expected = sorted(broadmark.overlaps(boxes, "bf-simd").tolist())
        assert broad_phase.pairs().tolist() == expected and len(expected) > 1000


@pytest.mark.parametrize("method", METHODS)
def test_events_with_filters_are_the_changes_of_brute_force(method: Any) -> None:
    world = World(2)
    matrix = np.array([[True, False, True], [False, True, True], [True, True, False]])
    broad_phase = BroadPhase(method, answer="events", layers=matrix)
    before: PairSet = set()
    ended = 0
    for frame, _ in enumerate(frames_of(world)):
        if frame % 3 == 0:
            for _ in range(10):
                world.change_filter(broad_phase, layers=3)
        broad_phase.update(world.boxes)
        now = world.pairs(matrix)
        assert as_set(broad_phase.began()) == now - before
        assert as_set(broad_phase.ended()) == before - now
        ended += len(before - now)
        before = now
    assert ended > 1000


def test_filters_matter() -> None:
    broad_phase = BroadPhase(layers=[[1, 0], [0, 1]])
    boxes = np.zeros((4, 6), np.float32)
    broad_phase.set_filter(0, 1)
    broad_phase.set_filter(1, tags=[7, 9])
    broad_phase.set_filter(3, tags=(9,))
    broad_phase.update(boxes)
    assert broad_phase.pairs().tolist() == [[1, 2], [2, 3]]
    broad_phase.set_filter(0)
    broad_phase.update(boxes)
    assert broad_phase.pairs().tolist() == [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]]


@pytest.mark.parametrize("changes", ["verified", "trusted"])
def test_changed_bodies_may_be_listed(changes: Any) -> None:
    world = World(3)
    broad_phase = BroadPhase(changes=changes)
    for frame, changed in enumerate(frames_of(world)):
        lists = [changed, changed.tolist(), changed[::-1], changed.astype(np.uint8)]
        broad_phase.update(world.boxes, lists[frame % len(lists)])
        assert as_set(broad_phase.pairs()) == world.pairs()


def test_a_margin_finds_near_bodies_too() -> None:
    world = World(4)
    broad_phase = BroadPhase(margin=0.25)
    for _ in frames_of(world, 5):
        broad_phase.update(world.boxes)
        assert as_set(broad_phase.pairs()) == world.pairs(margin=0.25)
    # The margin itself is rounded up: 0.1 + 2**-30 is no float.
    gap = 2 * (0.1 + 2**-30)
    broad_phase = BroadPhase(margin=gap / 2)
    broad_phase.update([[0, 0, 0, 0, 0, 0], [gap, 0, 0, gap, 0, 0]])
    assert broad_phase.pairs().tolist() == [[0, 1]]


@pytest.mark.parametrize("method", METHODS)
def test_a_restored_state_runs_on_alike(method: Any) -> None:
    world = World(5)
    broad_phase = BroadPhase(method, answer="events")
    world.change_filter(broad_phase, layers=32)
    for _ in frames_of(world, 10):
        broad_phase.update(world.boxes)
    state, began, ended = broad_phase.save(), broad_phase.began(), broad_phase.ended()
    assert isinstance(state, bytes) and len(began) + len(ended) > 0
    frames = []
    for _ in frames_of(world, 10):
        broad_phase.update(world.boxes)
        frames.append((world.boxes.copy(), broad_phase.began(), broad_phase.ended()))
    end = broad_phase.save()
    assert end != state
    for other in (broad_phase, BroadPhase(METHODS[method == "tide"], answer="events")):
        other.restore(bytearray(state))
        assert other.save() == state
        np.testing.assert_array_equal(other.began(), began)
        np.testing.assert_array_equal(other.ended(), ended)
        for boxes, *events in frames:
            other.update(boxes)
            np.testing.assert_array_equal(other.began(), events[0])
            np.testing.assert_array_equal(other.ended(), events[1])
        assert other.save() == end


def test_boxes_can_be_flat_doubles_lists_or_views() -> None:
    world = World(6)
    world.step()
    boxes = world.boxes
    padded = np.zeros((len(boxes), 2, 4), np.float32)
    padded[..., :3] = boxes
    read_only = boxes.view()
    read_only.flags.writeable = False
    reversed_corners = np.ascontiguousarray(boxes[..., ::-1])[..., ::-1]
    for array in (
        *(boxes.reshape(-1, 6), boxes.astype(float), boxes.tolist(), padded[..., :3], read_only),
        *(np.asfortranarray(boxes), boxes.astype(">f4"), boxes[::-1].copy()[::-1]),
        *(boxes.repeat(2, axis=0)[::2], reversed_corners),
    ):
        broad_phase = BroadPhase()
        broad_phase.update(array)
        assert as_set(broad_phase.pairs()) == world.pairs()
    broad_phase.update(boxes[:1].repeat(5, axis=0).reshape(5, 6)[:1])
    assert (broad_phase.size, len(broad_phase.pairs())) == (1, 0)
    broad_phase.update([])
    assert (broad_phase.size, len(broad_phase.pairs())) == (0, 0)


def test_floats_are_used_in_place(monkeypatch: pytest.MonkeyPatch) -> None:
    boxes = np.zeros((10, 2, 3), np.float32)
    padded = np.zeros((10, 2, 4), np.float32)
    broad_phase = BroadPhase()
    given: list[Any] = []

    class Recorder:
        def update(self, array: Any, _changed: Any) -> None:
            given.append(array)

    monkeypatch.setattr(broad_phase, "_native", Recorder())
    for array in (boxes, boxes.reshape(10, 6), padded[..., :3]):
        broad_phase.update(array)
        assert np.shares_memory(given[-1], array)
        assert given[-1].ctypes.data == array.ctypes.data


def test_answers_are_copies() -> None:
    broad_phase = BroadPhase()
    broad_phase.update(np.zeros((3, 6), np.float32))
    pairs = broad_phase.pairs()
    broad_phase.update(np.zeros((2, 6), np.float32))
    del broad_phase
    assert pairs.tolist() == [[0, 1], [0, 2], [1, 2]]
    pairs[0] = 9  # writable


def test_updates_release_the_gil() -> None:
    """Another thread sees that an update is going on, and is told so."""
    broad_phase = BroadPhase("columns")
    low = np.random.default_rng(1).uniform(0, 60, (50_000, 1, 3)).astype(np.float32)
    boxes = np.concatenate([low, low + 1], axis=1)
    seen = threading.Event()

    def work() -> None:
        for _ in range(5000):
            if seen.is_set():
                return
            broad_phase.update(boxes)

    worker = threading.Thread(target=work)
    worker.start()
    while worker.is_alive() and not seen.is_set():
        try:
            broad_phase.pairs()
        except broadmark.InputError as error:
            assert "a concurrent call on the same object" in str(error)
            seen.set()
    worker.join()
    assert seen.is_set()
    assert len(broad_phase.pairs()) > 0


def hits_of(world: World, box: Any, direction: Any) -> dict[int, float]:
    """By brute force: the fraction of each body that a moving box hits, up to 1."""
    low, high = box
    found = {}
    for body, (body_low, body_high) in enumerate(world.boxes.astype(float)):
        enters, leaves = 0.0, 1.0 if np.isfinite(body_low).all() else -1.0
        for axis in range(3):
            near, far = body_low[axis] - high[axis], body_high[axis] - low[axis]
            if direction[axis] == 0:
                leaves = leaves if near <= 0 <= far else -1.0
                continue
            times = sorted((near / direction[axis], far / direction[axis]))
            enters, leaves = max(enters, times[0]), min(leaves, times[1])
        if enters <= leaves:
            found[body] = enters
    return found


def test_queries_are_answered_as_by_brute_force() -> None:
    world = World(8)
    broad_phase = BroadPhase()
    generator = np.random.default_rng(9)
    answers = 0
    for _ in frames_of(world, 10):
        broad_phase.update(world.boxes)
        # Eighths, and directions of which all times are exact.
        low = np.round(generator.uniform(-1, 9, (20, 3)) * 8) / 8
        boxes = np.stack([low, low + generator.integers(0, 2, (20, 3))], axis=1)
        starts, bodies = broad_phase.overlapping(boxes)
        assert starts.dtype == np.int64 and bodies.dtype == np.uint32 and len(starts) == 21
        for i, (box_low, box_high) in enumerate(boxes):
            inside = (world.boxes[:, 0] <= box_high) & (world.boxes[:, 1] >= box_low)
            expected = np.flatnonzero(inside.all(1)).tolist()
            assert bodies[starts[i] : starts[i + 1]].tolist() == expected

        directions = generator.choice([-4.0, 0.0, 8.0], (20, 3))
        for origins, corners in ((boxes, boxes), (low, np.stack([low, low], axis=1))):
            starts, bodies, fractions = broad_phase.cast(origins, directions, hits="all")
            first, closest, _ = broad_phase.cast(origins, directions)
            for i in range(20):
                hits = hits_of(world, corners[i], directions[i])
                expected = sorted(hits, key=lambda body: (hits[body], body))
                found = slice(starts[i], starts[i + 1])
                assert bodies[found].tolist() == expected
                assert fractions[found].tolist() == [hits[body] for body in expected]
                assert closest[first[i] : first[i + 1]].tolist() == expected[:1]
                answers += len(expected)

        starts, bodies, distances = broad_phase.nearest(low, 4)
        present = np.isfinite(world.boxes[:, 0, 0])
        for i, point in enumerate(low):
            with np.errstate(invalid="ignore"):
                gap = np.maximum(
                    0, np.maximum(world.boxes[:, 0] - point, point - world.boxes[:, 1])
                )
                squares = np.where(present, (gap.astype(float) ** 2).sum(1), np.inf)
            expected = np.argsort(squares, kind="stable")[: min(4, present.sum())]
            found = slice(starts[i], starts[i + 1])
            assert bodies[found].tolist() == expected.tolist()
            np.testing.assert_allclose(distances[found], np.sqrt(squares[expected]))
    assert answers > 500


def test_queries_have_limits_and_layers() -> None:
    broad_phase = BroadPhase(margin=0.5)
    broad_phase.set_filter(1, 4)
    broad_phase.update([[0, 0, 0, 1, 1, 1], [4, 0, 0, 5, 1, 1]])
    assert broad_phase.overlapping([[0, 0, 0, 9, 9, 9]])[1].tolist() == [0, 1]
    assert broad_phase.overlapping([[0, 0, 0, 9, 9, 9]], layers=[4, 5])[1].tolist() == [1]
    assert broad_phase.overlapping([[0, 0, 0, 9, 9, 9]], layers=[])[0].tolist() == [0, 0]
    rays = [[-1, 0, 0]] * 3, [[2, 0, 0]] * 3
    starts, bodies, fractions = broad_phase.cast(
        *rays, max_fraction=[0.125, 0.25, np.inf], hits="all"
    )
    assert starts.tolist() == [0, 0, 1, 3]
    assert bodies.tolist() == [0, 0, 1]
    assert fractions.tolist() == [0.25, 0.25, 2.25]
    _, bodies, distances = broad_phase.nearest([[7, 0, 0]], 9, max_distance=2)
    assert (bodies.tolist(), distances.tolist()) == ([1], [1.5])
    nothing: list[Any] = [
        *broad_phase.overlapping([]),
        *broad_phase.cast([], []),
        *broad_phase.nearest([]),
    ]
    assert [array.tolist() for array in nothing] == [[0], [], [0], [], [], [0], [], []]


INVALID_QUERIES: list[tuple[str, tuple[Any, ...], dict[str, Any], str]] = [
    ("overlapping", ([[0, 0, 0, 1, 1]],), {}, "boxes: of shape"),
    ("overlapping", (EMPTY_BOX[None],), {}, "boxes: body 0 has a coordinate"),
    ("overlapping", ([[0] * 6],), {"layers": [32]}, "layer 32: expected an integer from 0 to 31"),
    ("overlapping", ([[0] * 6],), {"layers": 3}, "layers 3: expected a list of numbers"),
    ("cast", ([[0, 0, 0]], [[0, 0]]), {}, r"directions: of shape \(1, 2\)"),
    ("cast", ([[0, 0, 0]], [[0, 0, 1e39]]), {}, "directions: row 0 has a number"),
    ("cast", ([[0, 0, 0]], []), {}, "directions: 0, but 1 origins"),
    ("cast", ([[0, 0, np.nan]], [[1, 0, 0]]), {}, "origins: row 0 has a number"),
    ("cast", ([[0, 0, 0]], [[1, 0, 0]]), {"hits": "some"}, "unknown hits 'some'"),
    ("cast", ([[0, 0, 0]], [[1, 0, 0]]), {"max_fraction": -1}, "max_fraction: negative"),
    ("cast", ([[0, 0, 0]], [[1, 0, 0]]), {"max_fraction": [1, 2]}, "or an array of 1"),
    ("nearest", ([0, 0, 0],), {}, r"points: of shape \(3,\)"),
    ("nearest", ([[0, 0, 0]], -1), {}, "count -1: expected an integer"),
    ("nearest", ([[0, 0, 0]],), {"max_distance": np.nan}, "max_distance: negative, or not"),
]


@pytest.mark.parametrize(("query", "arguments", "options", "message"), INVALID_QUERIES)
def test_invalid_queries_are_rejected(
    query: str, arguments: tuple[Any, ...], options: dict[str, Any], message: str
) -> None:
    broad_phase = BroadPhase()
    broad_phase.update(np.zeros((2, 6)))
    with pytest.raises(broadmark.InputError, match=message):
        getattr(broad_phase, query)(*arguments, **options)


INVALID_OPTIONS: list[tuple[dict[str, Any], str]] = [
    ({"method": "tides"}, "unknown method 'tides'; did you mean 'tide'?"),
    ({"answer": "event"}, "unknown answer 'event'; did you mean 'events'?"),
    ({"order": 3}, r"unknown order '3' \(one of: sorted, any\)"),
    ({"changes": "x"}, "unknown changes 'x'"),
    ({"isa": "mmx"}, "unknown isa 'mmx'"),
    ({"threads": 0}, "threads 0: expected an integer from 1 to 1024"),
    ({"threads": 1.5}, "threads 1.5: expected an integer"),
    ({"threads": "2"}, "threads 2: expected an integer"),
    ({"margin": -1}, "margin: must be finite and not negative"),
    ({"margin": np.nan}, "margin: must be finite"),
    ({"margin": 1e300}, "margin: must be finite"),
    ({"margin": "wide"}, "margin 'wide': expected a number"),
    ({"layers": [[1, 1], [0, 1]]}, "layers: not symmetric: layers 0 and 1"),
    ({"layers": [1, 0]}, r"layers: of shape \(2,\)"),
    ({"layers": 1}, r"layers: of shape \(\)"),
    ({"layers": []}, r"layers: of shape \(0,\)"),
    ({"layers": [[1, 1], [1]]}, "layers: not an array"),
    ({"layers": np.ones((33, 33), bool)}, r"layers: of shape \(33, 33\)"),
    ({"layers": [[0.5]]}, "type float64"),
]


@pytest.mark.parametrize(("options", "message"), INVALID_OPTIONS)
def test_invalid_options_are_rejected(options: dict[str, Any], message: str) -> None:
    with pytest.raises(broadmark.InputError, match=message):
        BroadPhase(**options)


MASKED: Any = np.zeros((2, 6)).view(np.ma.MaskedArray)

INVALID_UPDATES: list[tuple[tuple[Any, ...], str]] = [
    ((np.zeros((2, 5)),), r"boxes: of shape \(2, 5\), expected"),
    (([[0] * 6, [0] * 5],), "boxes: not an array"),
    ((MASKED,), "boxes: a masked array"),
    ((5,), r"boxes: of shape \(\)"),
    ((None,), "boxes: expected numbers"),
    (([[0, 0, 0, 1, 1, np.nan]],), "boxes: body 0 has a coordinate that is not a finite number"),
    (([[0] * 6, [0, 0, 0, 1, 1, 1e39]],), "boxes: body 1 has a coordinate"),
    ((np.array([[0] * 6, [0, 0, 2, 1, 1, 1]], np.float32),), "boxes: body 1 has a min"),
    ((np.zeros((2, 6)) + 5, [0]), "changed: body 1 is not listed, but its box has changed"),
    ((np.zeros((2, 6)), [0, 2]), "changed: no body 2: there are 2"),
    ((np.zeros((2, 6)), [-1]), "changed: no body -1"),
    ((np.zeros((2, 6)), [2**32]), "changed: no body 4294967296"),
    ((np.zeros((2, 6)), [True, False]), "changed: expected a list of integers"),
    ((np.zeros((2, 6)), [0.0]), "changed: expected a list of integers"),
    ((np.zeros((2, 6)), 1), "changed: expected a list of integers"),
]


@pytest.mark.parametrize(("arguments", "message"), INVALID_UPDATES)
def test_invalid_updates_are_rejected_and_change_nothing(
    arguments: tuple[Any, ...], message: str
) -> None:
    broad_phase = BroadPhase()
    broad_phase.update(np.zeros((2, 6)))
    state = broad_phase.save()
    with pytest.raises(broadmark.InputError, match=message):
        broad_phase.update(*arguments)
    assert broad_phase.save() == state
    assert broad_phase.pairs().tolist() == [[0, 1]]


INVALID_FILTERS: list[tuple[dict[str, Any], str]] = [
    ({"body": -1}, "body -1: expected an integer"),
    ({"body": 2**29}, "body 536870912: the last one is"),
    ({"body": 0, "layer": 2}, "layer 2: expected an integer from 0 to 1"),
    ({"body": 0, "tags": [1, 2, 3, 4]}, "a body has at most 3"),
    ({"body": 0, "tags": [0xFFFFFFFF]}, "tag 4294967295: expected an integer"),
    ({"body": 0, "tags": 4}, "tags 4: expected a list of numbers"),
]


@pytest.mark.parametrize(("arguments", "message"), INVALID_FILTERS)
def test_invalid_filters_are_rejected(arguments: dict[str, Any], message: str) -> None:
    broad_phase = BroadPhase(layers=np.eye(2, dtype=bool))
    with pytest.raises(broadmark.InputError, match=message):
        broad_phase.set_filter(**arguments)


def test_other_misuse_is_an_error() -> None:
    broad_phase = BroadPhase()
    broad_phase.update(np.zeros((2, 6)))
    state = broad_phase.save()
    with pytest.raises(broadmark.InputError, match="the answer is pairs"):
        broad_phase.began()
    with pytest.raises(broadmark.InputError, match="the answer is events"):
        BroadPhase(answer="events").pairs()
    for bad, message in (
        (b"", "too few bytes"),
        (state[:-1], "too few bytes"),
        (state + b"0", "too many bytes"),
        (b"x" + state[1:], "not saved by this library"),
        ("text", "expected saved bytes, not type str"),
    ):
        with pytest.raises(broadmark.InputError, match=message):
            broad_phase.restore(bad)  # type: ignore[arg-type]
    with pytest.raises(broadmark.InputError, match="another answer, margin or layers"):
        BroadPhase(margin=1).restore(state)
    broad_phase.set_filter(0, 3)
    with pytest.raises(broadmark.InputError, match="filters have been set since"):
        broad_phase.save()
    assert broad_phase.pairs().tolist() == [[0, 1]]
