"""The paper's figure 3: a scene with increasing numbers of bodies, same camera, same frame."""

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

SIDE = 640  #: the size of a picture in pixels


@dataclass(frozen=True)
class StripPanel:
    """A panel of the strip: a source for the program, and the number of bodies for a scene."""

    source: str
    caption: str
    objects: int | None = None


def write_strip(path: str, panels: list[StripPanel], frame: int) -> None:
    """Draws every panel by the program and joins the pictures."""
    check_format(path)
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        pictures = [_picture(panel, frame, folder) for panel in panels]
        draw([path], lambda: _strip(pictures, [panel.caption for panel in panels]))


def _picture(panel: StripPanel, frame: int, folder: str) -> pathlib.Path:
    print(f"drawing {panel.caption}, frame {frame}", file=sys.stderr, flush=True)
    files = pathlib.Path(tempfile.mkdtemp(dir=folder))
    simulated = {"objects": panel.objects, "frames": frame} if panel.objects else {}
    call(
        *("--headless", panel.source, "--quiet", "--algorithm", "none"),
        *as_options(**simulated, frame=frame, size=f"{SIDE}x{SIDE}"),
        *("--screenshot", os.fspath(files / "panel.png")),
    )
    return files / "panel.png"


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
