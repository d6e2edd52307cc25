"""The paper's figure 3: a strip of one scene with more and more bodies, same camera, same frame."""

from __future__ import annotations

import os
import pathlib
import string
import sys
import tempfile
from dataclasses import dataclass

import matplotlib.image
from matplotlib.figure import Figure

from broadmark.drawing import check_format, draw
from broadmark.program import as_options, call

SIDE = 640  #: pixels of a picture


@dataclass(frozen=True)
class Part:
    """A picture of the strip: a source of the program, and what to simulate if it is a scene."""

    source: str
    caption: str
    objects: int | None = None


def write_strip(path: str, parts: list[Part], frame: int) -> None:
    """Has the program draw every part, and joins the pictures."""
    check_format(path)
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        pictures = [_picture(part, frame, folder) for part in parts]
        draw([path], lambda: _strip(pictures, [part.caption for part in parts]))


def _picture(part: Part, frame: int, folder: str) -> pathlib.Path:
    print(f"drawing {part.caption}, frame {frame}", file=sys.stderr, flush=True)
    files = pathlib.Path(tempfile.mkdtemp(dir=folder))
    simulated = {"objects": part.objects, "frames": frame} if part.objects else {}
    call(
        *("--headless", part.source, "--quiet", "--algorithm", "none"),
        *as_options(**simulated, frame=frame, size=f"{SIDE}x{SIDE}"),
        *("--screenshot", os.fspath(files / "part.png")),
    )
    return files / "part.png"


def _strip(pictures: list[pathlib.Path], captions: list[str]) -> Figure:
    figure = Figure(figsize=(3 * len(pictures), 3.3), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.02, h_pad=0.02, wspace=0.01)
    panels = figure.subplots(1, len(pictures), squeeze=False)[0]
    for axes, picture, caption, letter in zip(panels, pictures, captions, string.ascii_lowercase):
        axes.imshow(matplotlib.image.imread(picture), interpolation="antialiased")
        axes.set(xticks=[], yticks=[], xlabel=f"({letter}) {caption}")
        axes.spines[:].set_visible(False)
        axes.set_anchor("N")
    return figure
