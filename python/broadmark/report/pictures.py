"""Pictures of the scenes, drawn by the program `broadmark`.

One for each scene and object type: its largest recording that is quickly drawn. A recording that is
no file here is simulated again, as far as the frame that is drawn.
"""

from __future__ import annotations

import base64
import concurrent.futures
import contextlib
import os
import pathlib
import tempfile
import textwrap
from collections.abc import Iterator
from typing import Any

from broadmark.errors import InputError
from broadmark.program import call, find_program
from broadmark.recordings import Recording, read_recording

MOST_PICTURES = 12
MOST_BODIES = 200_000  #: that are drawn
MOST_SIMULATED = 200_000  #: bodies times frames: some seconds
LATEST_FRAME = 60
SIZE = "480x360"


def draw_pictures(
    recordings: list[dict[str, Any]], sources: list[list[str]]
) -> tuple[list[dict[str, Any]], list[str]]:
    """Pictures (recording, caption, uri) and, for scenes without one, why: a sentence each.

    `sources` are the words of the command line that open each recording.
    """
    try:
        find_program()
    except InputError as error:
        return [], [f"No pictures of the scenes: {error}."]
    scenes = list(_by_scene(recordings))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as side_by_side:
        found = list(
            side_by_side.map(
                lambda scene: _first_drawn(scene[1], recordings, sources), scenes[:MOST_PICTURES]
            )
        )
    found += [f"{MOST_PICTURES} are enough"] * (len(scenes) - len(found))
    pictures = [one for one in found if isinstance(one, dict)]
    notes = [
        f"{scene}: no picture: {reason}."
        for (scene, _), reason in zip(scenes, found)
        if isinstance(reason, str)
    ]
    return pictures, notes


def _first_drawn(
    numbers: list[int], recordings: list[dict[str, Any]], sources: list[list[str]]
) -> dict[str, Any] | str:
    """A picture of the first of these recordings that can be drawn, or why there is none."""
    reason = "too large to be drawn quickly"
    for number in numbers:
        if not _is_quick(recordings[number], sources[number]):
            continue
        frame = min(LATEST_FRAME, recordings[number]["frames"])
        try:
            uri = _drawn(recordings[number], sources[number], frame)
        except InputError as error:
            reason = textwrap.shorten(str(error), 120, placeholder=" …")
            continue
        return {"recording": number, "frame": frame, "uri": uri}
    return reason


def _by_scene(recordings: list[dict[str, Any]]) -> Iterator[tuple[str, list[int]]]:
    """Scene and object type, with the numbers of their recordings, the largest first."""
    scenes: dict[str, list[int]] = {}
    for number, one in enumerate(recordings):
        scenes.setdefault(f"{one['scene']} {one['object_type']}", []).append(number)
    for scene, numbers in scenes.items():
        yield scene, sorted(numbers, key=lambda number: -int(recordings[number]["objects"]))


def _is_quick(recording: dict[str, Any], source: list[str]) -> bool:
    if recording["file"]:
        return recording["objects"] <= MOST_BODIES and pathlib.Path(source[0]).exists()
    frames = min(LATEST_FRAME, recording["frames"])
    return bool(recording["objects"] * frames <= MOST_SIMULATED)


def _drawn(recording: dict[str, Any], source: list[str], frame: int) -> str:
    """The picture as a data URI."""
    words = list(source)
    if recording["file"]:
        _check_same(recording, words[0])
    elif "--frames" in words:
        words[words.index("--frames") + 1] = str(frame)
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        picture = pathlib.Path(folder) / "picture.png"
        call(
            *("--headless", *words, "--algorithm", "none", "--check", "off", "--quiet"),
            *("--frame", str(frame), "--size", SIZE, "--screenshot", str(picture)),
            accept=(0, 4),
        )
        with contextlib.suppress(OSError):
            return "data:image/png;base64," + base64.b64encode(picture.read_bytes()).decode("ascii")
    raise InputError("the program wrote no picture")


def _check_same(recording: dict[str, Any], path: str) -> None:
    """Raises InputError if the file has become another recording."""
    there = read_recording(path)
    if not isinstance(there, Recording):
        return
    shape = (recording["frames"] + 1, recording["objects"])
    if there.boxes.shape[:2] != shape:
        raise InputError(f"{path} is another recording now")
