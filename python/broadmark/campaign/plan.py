"""The recordings of a campaign, as plain values: nothing is baked or looked up here."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from broadmark.campaign.description import Block, Campaign, Value
from broadmark.errors import InputError
from broadmark.recordings import HEADER, RECORD_BYTES

#: The engine `splitter` makes so many bodies of one.
PARTS = 8


@dataclass(frozen=True)
class Series:
    """Recordings that differ in size only: the cap goes from one of them to the next."""

    scene: str
    object_type: str
    engine: str  #: "": the scene's own
    seed: int
    parameters: tuple[tuple[str, Value], ...]

    @property
    def variation(self) -> str:
        """All but scene and object type, as names of files and folders have it."""
        stated = [f"{name}={as_text(value)}" for name, value in self.parameters]
        text = " ".join([*filter(None, [self.engine]), f"seed={self.seed}", *stated])
        return text.replace("/", "_")


@dataclass(frozen=True)
class Recording:
    """A recording that the campaign runs its variants on."""

    series: Series
    objects: int
    frames: int
    source: Recording | None  #: what it is split from; None: it is simulated
    is_split: bool = False  #: another one is split from it, so its poses are recorded, too

    @property
    def name(self) -> str:
        series = self.series
        return (
            f"{series.scene} {series.object_type} N{self.objects} F{self.frames} {series.variation}"
        )

    @property
    def bytes(self) -> int:
        """On the disc."""
        one = HEADER.itemsize + RECORD_BYTES * self.objects * (1 + self.frames)
        return one * (2 if self.is_split else 1)


def planned_recordings(campaign: Campaign) -> list[Recording]:
    """Every recording once, the smallest first. Raises InputError when a source is missing."""
    made: dict[tuple[Series, int, int], Block] = {}
    for block in campaign.blocks:
        for key in _combinations(block):
            other = made.setdefault(key, block)
            if other.split != block.split:
                raise InputError(
                    f"{campaign.path}: {block.where}: {_named(key)} is made by splitting and, in "
                    "another block, by simulating: leave it out of one of them"
                )
    sources = {key: _source(campaign, key, made) for key, block in made.items() if block.split}
    split = set(sources.values())

    def recording(key: tuple[Series, int, int]) -> Recording:
        source = recording(sources[key]) if key in sources else None
        return Recording(*key, source=source, is_split=key in split)

    return sorted(map(recording, made), key=lambda one: one.objects)


def levels(recordings: Iterable[Recording]) -> Iterator[tuple[int, list[Recording]]]:
    """The recordings by their number of bodies, ascending."""
    ordered = sorted(recordings, key=lambda one: one.objects)
    for objects, same in itertools.groupby(ordered, key=lambda one: one.objects):
        yield objects, list(same)


def with_sources(recordings: Iterable[Recording]) -> list[Recording]:
    """These and all that they are split from, sources first."""
    needed: dict[Recording, None] = {}

    def add(one: Recording) -> None:
        if one.source:
            add(one.source)
        needed[one] = None

    for one in recordings:
        add(one)
    return list(needed)


def shrunk(former: Campaign, campaign: Campaign) -> str:
    """ "" if `campaign` is `former`, perhaps with more; else what has changed."""
    for name in sorted(former.options.keys() | campaign.options.keys()):
        if former.options.get(name) != campaign.options.get(name):
            return f"its '{name}' is {former.options.get(name)}, not {campaign.options.get(name)}"
    now = {one.name for one in planned_recordings(campaign)}
    for recording in planned_recordings(former):
        if recording.name not in now:
            return f"it has the recording '{recording.name}'"
    for old in former.selections:
        if not any(
            new.parameters == old.parameters
            and _holds(new.algorithms, old.algorithms)
            and _holds(new.threads, old.threads)
            and _holds(new.isas, old.isas)
            for new in campaign.selections
        ):
            return f"it runs {', '.join(old.algorithms)} with other threads, isa or parameters"
    return ""


def as_text(value: Value) -> str:
    """A parameter's value as the command line has it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _holds(new: tuple[object, ...] | None, old: tuple[object, ...] | None) -> bool:
    return new == old if new is None or old is None else set(new) >= set(old)


def _combinations(block: Block) -> Iterator[tuple[Series, int, int]]:
    names = [name for name, _ in block.parameters]
    axes = (block.scenes, block.object_types, block.engines, block.seeds)
    for scene, object_type, engine, seed in itertools.product(*axes):
        for values in itertools.product(*(values for _, values in block.parameters)):
            parameters = tuple(sorted(zip(names, values)))
            series = Series(scene, object_type, engine, seed, parameters)
            for objects, frames in itertools.product(block.objects, block.frames):
                yield series, objects, frames


def _named(key: tuple[Series, int, int]) -> str:
    return Recording(*key, source=None).name


def _source(
    campaign: Campaign, key: tuple[Series, int, int], made: dict[tuple[Series, int, int], Block]
) -> tuple[Series, int, int]:
    """What a recording is split from."""
    series, objects, frames = key
    where = f"{campaign.path}: {made[key].where}: {_named(key)}"
    if objects % PARTS or objects == 0:
        raise InputError(f"{where}: cannot be split: {objects} is no multiple of {PARTS}")
    candidates = [
        one for one in made if one[0] == series and one[1] == objects // PARTS and one[2] >= frames
    ]
    if not candidates:
        raise InputError(
            f"{where}: is split from one of {objects // PARTS} bodies and at least {frames} "
            "frames: add that to a block with the same engine, seed and parameters"
        )
    return min(candidates, key=lambda one: one[2])
