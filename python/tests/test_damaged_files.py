"""Randomly damaged files of every type that the package reads: they are read or rejected in a line.

Some values of a JSON document are replaced, left out or repeated, or bytes of any file are. The
same seed gives the same files; BROADMARK_DAMAGED_FILES=N tries N files of each type instead of a few.
"""

from __future__ import annotations

import copy
import json
import os
import pathlib
import random
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from conftest import SOURCE_FOLDER

import broadmark
from broadmark.campaign.attempts import read_attempt
from broadmark.campaign.description import read_campaign
from broadmark.campaign.plan import planned_recordings

MANY = int(os.environ.get("BROADMARK_DAMAGED_FILES", "400"))
CORPUS = SOURCE_FOLDER / "tests/fuzz/corpus"

CAMPAIGN = {
    "schema": "broadmark-campaign/1",
    "title": "All keys",
    "recordings": [
        {
            "scenes": ["brownian", "freefall"],
            "object_type": ["cubes", "assorted"],
            "objects": [80, 640],
            "frames": 300,
            "engine": "bullet",
            "seed": [1, 2],
            "parameters": {"density": [0.05, 0.1], "walls": True},
        },
        {"scenes": "brownian", "objects": 640, "frames": 100, "engine": "bullet", "split": True},
        {"scenes": "brownian", "objects": 80, "frames": 100, "engine": "bullet"},
    ],
    "algorithm": ["bf*", {"algorithm": "kd", "threads": [1, 2], "parameters": {"margin": [0, 1]}}],
    "isa": ["scalar", "avx2"],
    "repetitions": "auto",
    "precision": "2%",
    "warmup": 1,
    "time_limit": 0.5,
    "check": "full",
    "plugin": "plugin.so",
    "pin": False,
}
ODD_VALUES: list[Any] = [
    *(None, True, False, 0, 1, -1, 8, 2**31, 2**63, 2**64, 10**400, 0.5, -0.0, 1e308),
    *(float("nan"), float("inf"), "", "a", "a\nb", "\ud800", "\0", "é" * 300, "../x", "auto"),
    *([], [[]], [None], {}, {"": ""}, [1, "a"], [1] * 100),
]


def locations(document: Any) -> Iterator[tuple[Any, Any]]:
    """Every container with each of its keys or indices."""
    members = list(document.items()) if isinstance(document, dict) else list(enumerate(document))
    for key, value in members:
        yield document, key
        if isinstance(value, (dict, list)):
            yield from locations(value)


def damaged_document(source: random.Random, document: Any) -> bytes:
    document = copy.deepcopy(document)
    for _ in range(source.randint(1, 3)):
        found = list(locations(document))
        if not found:
            break
        container, key = source.choice(found)
        deed = source.randrange(4)
        if deed == 0:
            del container[key]
        elif deed == 1 and isinstance(container, list):
            container.append(copy.deepcopy(container[key]))
        elif deed == 1:
            container[source.choice(["", "schema", "a\nb", key + "s"])] = container[key]
        else:
            container[key] = copy.deepcopy(source.choice(ODD_VALUES))
    return json.dumps(document).encode("utf-8", "surrogatepass")


def damaged_bytes(source: random.Random, content: bytes) -> bytes:
    changed = bytearray(content)
    for _ in range(source.randint(1, 4)):
        at = source.randint(0, len(changed))
        deed = source.randrange(5)
        if deed == 0:
            del changed[at:]
        elif deed == 1:
            del changed[at : at + source.randint(1, 64)]
        elif deed == 2:
            changed[at:at] = source.choice([b"\0", b"\xff" * 8, b"[" * 5000, b"\n", b"1e999", b'"'])
        else:
            changed[at : at + 1] = bytes([source.randrange(256)])
    return bytes(changed)


def is_read_or_rejected(read: Callable[[pathlib.Path], Any], path: pathlib.Path) -> bool:
    """Whether the file was read; otherwise it was rejected with a one-line error."""
    try:
        read(path)
    except broadmark.InputError as error:
        assert "\n" not in str(error), error
        return False
    return True


def read_plan(path: pathlib.Path) -> None:
    """Reads and plans a campaign, as the command does before it calls the program."""
    planned_recordings(read_campaign(path))


def read_whole_recording(path: pathlib.Path) -> None:
    recording = broadmark.read_recording(path)
    if isinstance(recording, broadmark.ChangingRecording):
        for frame in range(min(recording.last_frame, 20) + 1):
            recording.frame(frame)
            recording.changed(frame)


def read_damaged_files(
    tmp_path: pathlib.Path,
    name: str,
    read: Callable[[pathlib.Path], Any],
    damaged: Callable[[random.Random], bytes],
) -> None:
    path = tmp_path / name
    for seed in range(MANY):
        path.write_bytes(damaged(random.Random(seed)))
        try:
            is_read_or_rejected(read, path)
        except Exception as error:
            raise AssertionError(f"seed {seed}: {path.read_bytes()[:2000]!r}") from error


def test_the_undamaged_campaign_is_valid(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "campaign.json"
    path.write_text(json.dumps(CAMPAIGN))
    assert is_read_or_rejected(read_plan, path)


def test_campaigns(tmp_path: pathlib.Path) -> None:
    read_damaged_files(
        tmp_path, "campaign.json", read_plan, lambda s: damaged_document(s, CAMPAIGN)
    )
    text = json.dumps(CAMPAIGN).encode()
    read_damaged_files(tmp_path, "campaign.json", read_plan, lambda s: damaged_bytes(s, text))


def test_results(tmp_path: pathlib.Path, small_results: pathlib.Path) -> None:
    document = json.loads((small_results / "results.json").read_text())
    document["cases"] = document["cases"][:3]
    read = broadmark.read_results
    read_damaged_files(tmp_path, "results.json", read, lambda s: damaged_document(s, document))
    lines = (small_results / "results.jsonl").read_bytes()
    read_damaged_files(tmp_path, "results.jsonl", read, lambda s: damaged_bytes(s, lines))


def test_attempts(tmp_path: pathlib.Path, small_results: pathlib.Path) -> None:
    lines = [json.loads(line) for line in (small_results / "results.jsonl").open()]

    def damaged(source: random.Random) -> bytes:
        return b"".join(damaged_document(source, line) + b"\n" for line in lines[:4])

    read_damaged_files(tmp_path, "1.jsonl", read_attempt, damaged)


@pytest.mark.parametrize(
    "corpus, ending", [("recording", "aabbs"), ("recording2", "broadmark"), ("posrot", "posrot")]
)
def test_recordings(tmp_path: pathlib.Path, corpus: str, ending: str) -> None:
    seeds = [path.read_bytes() for path in sorted((CORPUS / corpus).iterdir())]

    def damaged(source: random.Random) -> bytes:
        return damaged_bytes(source, source.choice(seeds))

    read_damaged_files(tmp_path, f"a.{ending}", read_whole_recording, damaged)
