"""The campaign file: JSON, described in docs/campaigns.md.

Keys are named like the program's options. This module checks keys and types; the program checks the
values.
"""

from __future__ import annotations

import difflib
import json
import math
import pathlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from broadmark.errors import InputError

SCHEMA = "broadmark-campaign/1"

#: A parameter's value. The program accepts strings; scene parameter files distinguish numbers.
Value = str | int | float | bool
#: Names with their values; every combination is run.
Values = tuple[tuple[str, tuple[Value, ...]], ...]


Span = tuple[int, int]  #: the first and last frame of a part of a recording


@dataclass(frozen=True)
class Block:
    """A grid of recordings: every combination of these values."""

    where: str  #: the path in the file, for messages
    scenes: tuple[str, ...]
    object_types: tuple[str, ...]
    objects: tuple[int, ...]
    frames: tuple[int, ...]
    engines: tuple[str, ...]  #: "": each scene's default
    seeds: tuple[int, ...]
    parameters: Values
    split: bool  #: split from recordings with an eighth of the bodies, not simulated
    spans: tuple[Span, ...]  #: parts, each run as a recording of its own; (): all is run
    options: tuple[tuple[str, Any], ...]  #: for measuring, instead of the campaign's


@dataclass(frozen=True)
class Selection:
    """A grid of variants: every combination of these values. None: the program's default."""

    where: str
    algorithms: tuple[str, ...]
    threads: tuple[int, ...] | None
    isas: tuple[str, ...] | None
    parameters: Values


@dataclass(frozen=True)
class Campaign:
    """The content of a campaign file."""

    path: pathlib.Path
    text: str
    title: str
    blocks: tuple[Block, ...]
    selections: tuple[Selection, ...]
    options: dict[str, Any]  #: the program's options for measuring a case


def read_campaign(path: pathlib.Path) -> Campaign:
    """Reads a campaign file. Raises InputError with the file and the key."""
    try:
        text = path.read_text(encoding="utf-8")
        document = json.loads(text, object_pairs_hook=_without_repeated_keys)
    except (OSError, UnicodeDecodeError, ValueError, RecursionError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
    try:
        return _campaign(path, text, document)
    except _InvalidKey as error:
        raise InputError(f"{path}: {error}") from None


class _InvalidKey(Exception):
    """The path of a key and its error."""


def _without_repeated_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) < len(pairs):
        names = [name for name, _ in pairs]
        repeated = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"'{repeated}' is repeated in an object")
    return members


def _campaign(path: pathlib.Path, text: str, document: Any) -> Campaign:
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        raise _InvalidKey(f"not a campaign: the \"schema\" is not '{SCHEMA}'")
    keys = _convert_members(document, "", CAMPAIGN_KEYS, required=["recordings", "algorithm"])
    del keys["schema"]
    common = {name: keys.pop(name) for name in ("threads", "isa", "parameters") if name in keys}
    return Campaign(
        path,
        text,
        keys.pop("title", ""),
        tuple(_blocks(keys.pop("recordings"))),
        tuple(_selections(keys.pop("algorithm"), common)),
        options=keys,
    )


def _blocks(blocks: list[Any]) -> Iterator[Block]:
    for number, block in enumerate(blocks):
        where = f"recordings[{number}]"
        keys = _convert_members(block, where, BLOCK_KEYS, required=["scenes", "objects", "frames"])
        yield Block(
            where,
            scenes=keys["scenes"],
            object_types=keys.get("object_type", ("cubes",)),
            objects=keys["objects"],
            frames=keys["frames"],
            engines=keys.get("engine", ("",)),
            seeds=keys.get("seed", (1,)),
            parameters=keys.get("parameters", ()),
            split=keys.get("split", False),
            spans=keys.get("span", ()),
            options=tuple((name, keys[name]) for name in BLOCK_OPTIONS if name in keys),
        )


def _selections(algorithms: list[Any], common: dict[str, Any]) -> Iterator[Selection]:
    """A selection for all plain names together and a selection for each object."""
    named = [entry for entry in algorithms if isinstance(entry, str)]
    if named:
        yield _selection("algorithm", {**common, "algorithm": tuple(named)})
    for number, entry in enumerate(algorithms):
        if not isinstance(entry, str):
            where = f"algorithm[{number}]"
            own = _convert_members(entry, where, SELECTION_KEYS, required=["algorithm"])
            yield _selection(where, common | own)


def _selection(where: str, keys: dict[str, Any]) -> Selection:
    return Selection(
        where,
        algorithms=keys["algorithm"],
        threads=keys.get("threads"),
        isas=keys.get("isa"),
        parameters=keys.get("parameters", ()),
    )


def _convert_members(
    members: Any, where: str, known: dict[str, Callable[[Any], Any]], required: list[str]
) -> dict[str, Any]:
    """The members of an object, each converted by its key's function in `known`."""
    prefix = f"{where}: " if where else ""
    if not isinstance(members, dict):
        raise _InvalidKey(f"{prefix}expected an object with {', '.join(required)}")
    for name in members:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"one of: {', '.join(known)}"
            raise _InvalidKey(f"{prefix}unknown key '{name}' ({hint})")
    for name in required:
        if members.get(name) is None:
            raise _InvalidKey(f"{prefix}'{name}' is missing")
    converted = {}
    for name, value in members.items():
        try:
            if value is not None:
                converted[name] = known[name](value)
        except _InvalidKey as error:
            shown = json.dumps(value)
            shown = shown if len(shown) < 60 else shown[:57] + "..."
            raise _InvalidKey(
                f"{where}{'.' if where else ''}{name}: {shown} is not {error}"
            ) from None
    return converted


def _single(description: str, fits: Callable[[Any], bool]) -> Callable[[Any], Any]:
    def convert(value: Any) -> Any:
        if not fits(value):
            raise _InvalidKey(description)
        return value

    return convert


def _one_or_more(description: str, fits: Callable[[Any], bool]) -> Callable[[Any], Any]:
    def convert(value: Any) -> Any:
        values = value if isinstance(value, list) else [value]
        if not values or not all(map(fits, values)):
            raise _InvalidKey(f"{description} or a list of such values")
        return tuple(dict.fromkeys(values))

    return convert


def _is_string(value: Any) -> bool:
    return isinstance(value, str) and value != ""


def _is_integer(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def _is_number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return 0 <= value < math.inf


def _is_value(value: Any) -> bool:
    return _is_string(value) or isinstance(value, bool) or isinstance(value, (int, float))


_string = _single("a string", _is_string)
_strings = _one_or_more("a string", _is_string)
_number = _single("a non-negative number", _is_number)
_integer = _single("a non-negative integer", _is_integer)
_integers = _one_or_more("a non-negative integer", _is_integer)
_boolean = _single("true or false", lambda value: isinstance(value, bool))
_list = _single("a non-empty list", lambda value: isinstance(value, list) and value != [])


def _parameters(value: Any) -> Values:
    if not isinstance(value, dict):
        raise _InvalidKey("an object of parameters and their values")
    convert = _one_or_more(
        "an object with members that are strings, numbers, true or false", _is_value
    )
    return tuple((name, convert(values)) for name, values in value.items())


def _precision(value: Any) -> Any:
    if not _is_string(value) and not _is_number(value):
        raise _InvalidKey("a number or a string such as '2%'")
    return value


def _repetitions(value: Any) -> Any:
    if value != "auto" and not _is_integer(value):
        raise _InvalidKey("a non-negative integer or 'auto'")
    return value


def _spans(value: Any) -> Any:
    flat = [frame for span in value if isinstance(span, list) for frame in span]
    pairs = isinstance(value, list) and all(
        isinstance(span, list) and len(span) == 2 and span[0] < span[1] for span in value
    )
    if not pairs or not all(map(_is_integer, flat)) or flat != sorted(set(flat)) or not flat:
        raise _InvalidKey("a list of frames in ascending order, such as [[0, 99], [900, 999]]")
    return tuple(map(tuple, value))


#: Keys of CAMPAIGN_KEYS that a block may have, too.
BLOCK_OPTIONS = ("repetitions",)

BLOCK_KEYS: dict[str, Callable[[Any], Any]] = {
    "scenes": _strings,
    "object_type": _strings,
    "objects": _integers,
    "frames": _integers,
    "engine": _strings,
    "seed": _integers,
    "parameters": _parameters,
    "split": _boolean,
    "span": _spans,
    "repetitions": _repetitions,
}
SELECTION_KEYS: dict[str, Callable[[Any], Any]] = {
    "algorithm": _strings,
    "threads": _integers,
    "isa": _strings,
    "parameters": _parameters,
}
CAMPAIGN_KEYS: dict[str, Callable[[Any], Any]] = {
    "schema": _string,
    "title": _string,
    "recordings": _list,
    **SELECTION_KEYS,
    "algorithm": _list,
    "plugin": _strings,
    "device": _string,
    "answer": _string,
    "queries": _string,
    "repetitions": _repetitions,
    "precision": _precision,
    "max_seconds": _number,
    "most_seconds": _number,  # its former name
    "order_seed": _integer,
    "warmup": _integer,
    "time_limit": _number,
    "hard_limit": _number,
    "memory_limit": _number,
    "check": _string,
    "pin": _boolean,
}
