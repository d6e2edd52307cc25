"""Draws the paper's figure 3: Gravity with more and more bodies, same camera, same frame.

The program simulates and draws each part; 32,000 bodies take some minutes. Recordings that are given
are drawn instead.
"""

from __future__ import annotations

import argparse
import pathlib

from broadmark.errors import InputError
from broadmark.paper.strip import Part, write_strip
from broadmark.recordings import read_recording


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("recordings", nargs="*", metavar="RECORDING", help="drawn instead (.aabbs)")
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
    parts = [_of_recording(path) for path in options.recordings]
    if not parts:
        parts = [_of_scene(options.scene, text) for text in options.objects.split(",")]
    write_strip(options.output, parts, options.frame)
    print(f"written: {options.output}")


def _of_recording(path: str) -> Part:
    recording = read_recording(path)
    objects = recording.boxes.shape[-3]
    return Part(path, f"{recording.name}, {objects:,} objects")


def _of_scene(scene: str, objects: str) -> Part:
    if not objects.isdigit() or int(objects) == 0:
        raise InputError(f"--objects '{objects}': is no number of bodies, such as 1000")
    name = pathlib.PurePath(scene).stem
    return Part(scene, f"{name.capitalize()}, {int(objects):,} objects", int(objects))
