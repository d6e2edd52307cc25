"""Draws the paper's figure 3: Gravity with increasing numbers of bodies, same camera, same frame.

The program simulates and draws each panel; 32,000 bodies take some minutes. Given recordings are
drawn instead.
"""

from __future__ import annotations

import argparse
import pathlib

from broadmark.errors import InputError
from broadmark.files import report_written
from broadmark.paper.strip import StripPanel, write_strip
from broadmark.recordings import read_recording


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "recordings", nargs="*", metavar="RECORDING", help="recordings to draw instead (.aabbs)"
    )
    parser.add_argument(
        "-o", "--output", required=True, metavar="FILE", help="the strip (.png, .svg, .pdf)"
    )
    parser.add_argument("--scene", default="gravity", help="default: %(default)s")
    parser.add_argument(
        "--objects",
        default="100,1000,8000,32000",
        metavar="N[,N…]",
        help="numbers of bodies (default: %(default)s)",
    )
    parser.add_argument("--frame", type=int, default=60, metavar="K", help="default: %(default)s")


def main(options: argparse.Namespace) -> None:
    panels = [_recording_panel(path) for path in options.recordings]
    if not panels:
        panels = [_scene_panel(options.scene, text) for text in options.objects.split(",")]
    write_strip(options.output, panels, options.frame)
    report_written(options.output)


def _recording_panel(path: str) -> StripPanel:
    recording = read_recording(path)
    objects = recording.boxes.shape[-3]
    return StripPanel(path, f"{recording.name}, {objects:,} objects")


def _scene_panel(scene: str, objects: str) -> StripPanel:
    if not objects.isdigit() or int(objects) == 0:
        raise InputError(f"--objects '{objects}': expected a number of bodies, such as 1000")
    name = pathlib.PurePath(scene).stem
    return StripPanel(scene, f"{name.capitalize()}, {int(objects):,} objects", int(objects))
