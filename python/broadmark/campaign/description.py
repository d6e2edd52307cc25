"""The campaign file: JSON, described in docs/campaigns.md.

A key is called as the program's option is, and its values are the program's to judge: here it is
only checked that keys are known and values of their type.
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

#: A parameter's value: the program takes texts, files of scene parameters tell numbers from texts.
Value = str | int | float | bool
#: Names with one or several values; every combination is meant.
Values = tuple[tuple[str, tuple[Value, ...]], ...]


@dataclass(frozen=True)
class Block:
    """Recordings: every combination of these."""

    where: str  #: in the file, for messages
    scenes: tuple[str, ...]
    object_types: tuple[str, ...]
    objects: tuple[int, ...]
    frames: tuple[int, ...]
    engines: tuple[str, ...]  #: "": each scene's own
    seeds: tuple[int, ...]
    parameters: Values
    split: bool  #: not simulated, but made of recordings with an eighth of the bodies


@dataclass(frozen=True)
class Selection:
    """Variants: every combination of these. None: the program's default."""

    where: str
    algorithms: tuple[str, ...]
    threads: tuple[int, ...] | None
    isas: tuple[str, ...] | None
    parameters: Values


@dataclass(frozen=True)
class Campaign:
    """What a campaign file says."""

    path: pathlib.Path
    text: str
    title: str
    blocks: tuple[Block, ...]
    selections: tuple[Selection, ...]
    options: dict[str, Any]  #: how every case is measured: options of the program


def read_campaign(path: pathlib.Path) -> Campaign:
    """Reads a campaign file. Raises InputError that names file and key."""
    try:
        text = path.read_text(encoding="utf-8")
        document = json.loads(text, object_pairs_hook=_without_repeated_keys)
    except (OSError, UnicodeDecodeError, ValueError, RecursionError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
    try:
        return _campaign(path, text, document)
    except _Wrong as wrong:
        raise InputError(f"{path}: {wrong}") from None


class _Wrong(Exception):
    """A key and what is wrong with it."""


def _without_repeated_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) < len(pairs):
        names = [name for name, _ in pairs]
        repeated = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"'{repeated}' is there twice in one object")
    return members


def _campaign(path: pathlib.Path, text: str, document: Any) -> Campaign:
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        raise _Wrong(f"is no campaign: its \"schema\" is not '{SCHEMA}'")
    keys = _taken(document, "", CAMPAIGN_KEYS, required=["recordings", "algorithm"])
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
        keys = _taken(block, where, BLOCK_KEYS, required=["scenes", "objects", "frames"])
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
        )


def _selections(algorithms: list[Any], common: dict[str, Any]) -> Iterator[Selection]:
    """Those that are only named are run together; an object is a selection of its own."""
    named = [one for one in algorithms if isinstance(one, str)]
    if named:
        yield _selection("algorithm", {**common, "algorithm": tuple(named)})
    for number, one in enumerate(algorithms):
        if not isinstance(one, str):
            where = f"algorithm[{number}]"
            own = _taken(one, where, SELECTION_KEYS, required=["algorithm"])
            yield _selection(where, common | own)


def _selection(where: str, keys: dict[str, Any]) -> Selection:
    return Selection(
        where,
        algorithms=keys["algorithm"],
        threads=keys.get("threads"),
        isas=keys.get("isa"),
        parameters=keys.get("parameters", ()),
    )


def _taken(
    members: Any, where: str, known: dict[str, Callable[[Any], Any]], required: list[str]
) -> dict[str, Any]:
    """The members, each as its key has it."""
    place = f"{where}: " if where else ""
    if not isinstance(members, dict):
        raise _Wrong(f"{place}an object with {', '.join(required)} is expected")
    for name in members:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"one of: {', '.join(known)}"
            raise _Wrong(f"{place}unknown key '{name}' ({hint})")
    for name in required:
        if members.get(name) is None:
            raise _Wrong(f"{place}'{name}' is missing")
    taken = {}
    for name, value in members.items():
        try:
            if value is not None:
                taken[name] = known[name](value)
        except _Wrong as wrong:
            shown = json.dumps(value)
            shown = shown if len(shown) < 60 else shown[:57] + "..."
            raise _Wrong(f"{where}{'.' if where else ''}{name}: {shown} is not {wrong}") from None
    return taken


def _one(what: str, fits: Callable[[Any], bool]) -> Callable[[Any], Any]:
    def take(value: Any) -> Any:
        if not fits(value):
            raise _Wrong(what)
        return value

    return take


def _one_or_several(what: str, fits: Callable[[Any], bool]) -> Callable[[Any], Any]:
    def take(value: Any) -> Any:
        values = value if isinstance(value, list) else [value]
        if not values or not all(map(fits, values)):
            raise _Wrong(f"{what} or a list of those")
        return tuple(dict.fromkeys(values))

    return take


def _is_text(value: Any) -> bool:
    return isinstance(value, str) and value != ""


def _is_whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def _is_number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return 0 <= value < math.inf


def _is_value(value: Any) -> bool:
    return _is_text(value) or isinstance(value, bool) or isinstance(value, (int, float))


_text = _one("a text", _is_text)
_texts = _one_or_several("a text", _is_text)
_number = _one("a number from 0", _is_number)
_whole = _one("a whole number from 0", _is_whole)
_wholes = _one_or_several("a whole number from 0", _is_whole)
_switch = _one("true or false", lambda value: isinstance(value, bool))
_list = _one("a list with something in it", lambda value: isinstance(value, list) and value != [])


def _parameters(value: Any) -> Values:
    if not isinstance(value, dict):
        raise _Wrong("an object of parameters and their values")
    take = _one_or_several("an object whose members are a text, a number, true or false", _is_value)
    return tuple((name, take(values)) for name, values in value.items())


def _precision(value: Any) -> Any:
    if not _is_text(value) and not _is_number(value):
        raise _Wrong("a number or a text such as '2%'")
    return value


def _repetitions(value: Any) -> Any:
    if value != "auto" and not _is_whole(value):
        raise _Wrong("a whole number or 'auto'")
    return value


BLOCK_KEYS: dict[str, Callable[[Any], Any]] = {
    "scenes": _texts,
    "object_type": _texts,
    "objects": _wholes,
    "frames": _wholes,
    "engine": _texts,
    "seed": _wholes,
    "parameters": _parameters,
    "split": _switch,
}
SELECTION_KEYS: dict[str, Callable[[Any], Any]] = {
    "algorithm": _texts,
    "threads": _wholes,
    "isa": _texts,
    "parameters": _parameters,
}
CAMPAIGN_KEYS: dict[str, Callable[[Any], Any]] = {
    "schema": _text,
    "title": _text,
    "recordings": _list,
    **SELECTION_KEYS,
    "algorithm": _list,
    "plugin": _texts,
    "device": _text,
    "answer": _text,
    "repetitions": _repetitions,
    "precision": _precision,
    "max_seconds": _number,
    "most_seconds": _number,  # its former name
    "order_seed": _whole,
    "warmup": _whole,
    "time_limit": _number,
    "hard_limit": _number,
    "memory_limit": _number,
    "check": _text,
    "pin": _switch,
}
