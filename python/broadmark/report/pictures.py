"""Pictures of the scenes, drawn by the program `broadmark`.

Each scene and object type has a picture of its largest recording that can be drawn quickly. A
recording without a file is simulated again up to the frame of the picture.
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

MAX_PICTURES = 12
MAX_BODIES = 200_000  #: of a recording file
MAX_SIMULATED_BOXES = 200_000  #: bodies times frames, some seconds of simulation
MAX_FRAME = 60
SIZE = "480x360"


def draw_pictures(
    recordings: list[dict[str, Any]], sources: list[list[str]]
) -> tuple[list[dict[str, Any]], list[str]]:
    """The pictures (recording, frame, uri), and a sentence for each scene without a picture.

    `sources` are the command-line arguments that open each recording.
    """
    try:
        find_program()
    except InputError as error:
        return [], [f"No pictures of the scenes: {error}."]
    scenes = list(_by_scene(recordings))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as executor:
        results = list(
            executor.map(
                lambda scene: _first_drawn(scene[1], recordings, sources), scenes[:MAX_PICTURES]
            )
        )
    results += [f"the limit of {MAX_PICTURES} pictures is reached"] * (len(scenes) - len(results))
    pictures = [result for result in results if isinstance(result, dict)]
    notes = [
        f"{scene}: no picture: {reason}."
        for (scene, _), reason in zip(scenes, results)
        if isinstance(reason, str)
    ]
    return pictures, notes


def _first_drawn(
    indices: list[int], recordings: list[dict[str, Any]], sources: list[list[str]]
) -> dict[str, Any] | str:
    """The picture of the first recording that can be drawn, or the reason for its absence."""
    reason = ""
    for index in indices:
        frame = min(MAX_FRAME, recordings[index]["frames"])
        try:
            _require_drawable(recordings[index], sources[index])
            uri = _drawn(recordings[index], sources[index], frame)
        except InputError as error:
            reason = textwrap.shorten(str(error), 120, placeholder=" …")
            continue
        return {"recording": index, "frame": frame, "uri": uri}
    return reason


def _by_scene(recordings: list[dict[str, Any]]) -> Iterator[tuple[str, list[int]]]:
    """Scene and object type with the indices of their recordings, the largest first."""
    scenes: dict[str, list[int]] = {}
    for index, recording in enumerate(recordings):
        scene = f"{recording['scene']} {recording['object_type']}"
        scenes.setdefault(scene, []).append(index)
    for scene, indices in scenes.items():
        yield scene, sorted(indices, key=lambda index: -int(recordings[index]["objects"]))


def _require_drawable(recording: dict[str, Any], source: list[str]) -> None:
    """Raises InputError if there is no source, or drawing it takes long."""
    if not source:
        raise InputError("its boxes were passed from Python")
    if recording["file"] and not pathlib.Path(source[0]).exists():
        raise InputError(f"{source[0]}: no such file")
    boxes = recording["objects"] * min(MAX_FRAME, recording["frames"])
    is_quick = (
        recording["objects"] <= MAX_BODIES if recording["file"] else boxes <= MAX_SIMULATED_BOXES
    )
    if not is_quick:
        raise InputError("too large to be drawn quickly")


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
    """Raises InputError if the file now holds another recording."""
    if pathlib.PurePath(path).suffix != ".aabbs":
        return
    current = read_recording(path)
    assert isinstance(current, Recording)
    shape = (recording["frames"] + 1, recording["objects"])
    if current.boxes.shape[:2] != shape:
        raise InputError(f"{path} now holds another recording")
