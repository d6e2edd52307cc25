"""The recordings of a campaign as plain values, without access to files or the program."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from broadmark.campaign.description import Block, Campaign, Span, Value
from broadmark.errors import InputError
from broadmark.recordings import HEADER, RECORD_BYTES

#: The number of bodies that the engine `splitter` makes of each body.
SPLIT_FACTOR = 8


@dataclass(frozen=True)
class Series:
    """The common settings of recordings that differ only in size. The cap applies within a series."""

    scene: str
    object_type: str
    engine: str  #: "": the scene's default
    seed: int
    parameters: tuple[tuple[str, Value], ...]

    @property
    def variation(self) -> str:
        """Engine, seed and parameters as part of file and folder names."""
        stated = [f"{name}={as_text(value)}" for name, value in self.parameters]
        text = " ".join([*filter(None, [self.engine]), f"seed={self.seed}", *stated])
        return text.replace("/", "_")


@dataclass(frozen=True)
class Recording:
    """A recording of the campaign."""

    series: Series
    objects: int
    frames: int
    source: Recording | None  #: the recording to split; None: simulated
    is_split: bool = False  #: a source of other recordings: its poses are recorded, too
    is_cut: bool = False  #: only spans of it are run
    span: Span | None = None  #: the part of `whole` that it is
    whole: Recording | None = None
    options: tuple[tuple[str, Any], ...] = ()  #: for measuring, instead of the campaign's

    @property
    def name(self) -> str:
        series = self.series
        span = f" {span_text(self.span)}" if self.span else ""
        return (
            f"{series.scene} {series.object_type} N{self.objects} F{self.frames}{span} "
            f"{series.variation}"
        )

    @property
    def bytes(self) -> int:
        """The size on disk."""
        file_bytes = HEADER.itemsize + RECORD_BYTES * self.objects * (1 + self.frames)
        return file_bytes * (2 if self.is_split else 1)


def planned_recordings(campaign: Campaign) -> list[Recording]:
    """The distinct recordings, the smallest first. Raises InputError for a missing source."""
    baked: dict[tuple[Series, int, int], Block] = {}
    run: dict[tuple[tuple[Series, int, int], Span | None], Block] = {}
    for block in campaign.blocks:
        for key in _combinations(block):
            other = baked.setdefault(key, block)
            if other.split != block.split:
                raise InputError(
                    f"{campaign.path}: {block.where}: {_name_of(key)} is split in this block and "
                    "simulated in another: remove it from one of them"
                )
            for span in block.spans or (None,):
                if run.setdefault((key, span), block).options != block.options:
                    raise InputError(
                        f"{campaign.path}: {block.where}: {_name_of(key)} is measured in another way "
                        "in another block: remove it from one of them"
                    )
            if block.spans and block.spans[-1][1] > key[2]:
                raise InputError(
                    f"{campaign.path}: {block.where}.span: frame {block.spans[-1][1]} does not exist: "
                    f"{_name_of(key)} has frames 0 to {key[2]}"
                )
    sources = {
        key: _source_key(campaign, key, baked) for key, block in baked.items() if block.split
    }
    split = set(sources.values())
    cut = {key for key, span in run if span} - {key for key, span in run if not span}

    def recording(
        key: tuple[Series, int, int], options: tuple[tuple[str, Any], ...] = ()
    ) -> Recording:
        source = recording(sources[key]) if key in sources else None
        return Recording(
            *key, source=source, is_split=key in split, is_cut=key in cut, options=options
        )

    def to_run(key: tuple[Series, int, int], span: Span | None, block: Block) -> Recording:
        if not span:
            return recording(key, block.options)
        series, objects, _ = key
        return Recording(
            series,
            objects,
            frames=span[1] - span[0],
            source=None,
            span=span,
            whole=recording(key),
            options=block.options,
        )

    recordings = [to_run(key, span, block) for (key, span), block in run.items()]
    return sorted(recordings, key=lambda recording: recording.objects)


def levels(recordings: Iterable[Recording]) -> Iterator[tuple[int, list[Recording]]]:
    """The recordings grouped by their number of bodies, ascending."""
    ordered = sorted(recordings, key=lambda recording: recording.objects)
    for objects, group in itertools.groupby(ordered, key=lambda recording: recording.objects):
        yield objects, list(group)


def with_sources(recordings: Iterable[Recording]) -> list[Recording]:
    """The recordings and all that they are made of, sources first."""
    needed: dict[Recording, None] = {}

    def add(recording: Recording) -> None:
        for other in (recording.source, recording.whole):
            if other:
                add(other)
        needed[recording] = None

    for recording in recordings:
        add(recording)
    return list(needed)


def incompatibility(former: Campaign, campaign: Campaign) -> str:
    """The reason why `campaign` does not extend `former`; "" if it does."""
    for name in sorted(former.options.keys() | campaign.options.keys()):
        if former.options.get(name) != campaign.options.get(name):
            return f"the '{name}' is {former.options.get(name)}, not {campaign.options.get(name)}"
    options = {recording.name: recording.options for recording in planned_recordings(campaign)}
    for recording in planned_recordings(former):
        if recording.name not in options:
            return f"it has the recording '{recording.name}'"
        if options[recording.name] != recording.options:
            return f"it measures the recording '{recording.name}' in another way"
    for old in former.selections:
        if not any(
            new.parameters == old.parameters
            and _includes(new.algorithms, old.algorithms)
            and _includes(new.threads, old.threads)
            and _includes(new.isas, old.isas)
            for new in campaign.selections
        ):
            return f"it runs {', '.join(old.algorithms)} with other threads, isa or parameters"
    return ""


def span_text(span: Span) -> str:
    first, last = span
    return f"{first}-{last}"


def as_text(value: Value) -> str:
    """A parameter's value as on the command line."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _includes(new: tuple[object, ...] | None, old: tuple[object, ...] | None) -> bool:
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


def _name_of(key: tuple[Series, int, int]) -> str:
    return Recording(*key, source=None).name


def _source_key(
    campaign: Campaign, key: tuple[Series, int, int], planned: dict[tuple[Series, int, int], Block]
) -> tuple[Series, int, int]:
    """The key of the recording to split."""
    series, objects, frames = key
    where = f"{campaign.path}: {planned[key].where}: {_name_of(key)}"
    if objects % SPLIT_FACTOR or objects == 0:
        raise InputError(f"{where}: cannot be split: {objects} is not a multiple of {SPLIT_FACTOR}")
    candidates = [
        source
        for source in planned
        if source[0] == series and source[1] == objects // SPLIT_FACTOR and source[2] >= frames
    ]
    if not candidates:
        raise InputError(
            f"{where}: requires a recording of {objects // SPLIT_FACTOR} bodies and at least "
            f"{frames} frames: add it to a block with the same engine, seed and parameters"
        )
    return min(candidates, key=lambda source: source[2])
