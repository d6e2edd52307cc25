"""Writes an array of boxes as a recording (.aabbs).

The array is a numpy file (.npy) of shape (F + 1, n, 2, 3) or (F + 1, n, 6): the min and max corners
of each body in the initial pose and in each frame.
"""

from __future__ import annotations

import argparse

import numpy as np

from broadmark.errors import InputError
from broadmark.recordings import write_recording


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("array", metavar="FILE.npy", help="the boxes")
    parser.add_argument("-o", "--output", required=True, metavar="FILE.aabbs", help="the recording")
    parser.add_argument("--name", default="Custom", help="name of the scene (default: %(default)s)")
    parser.add_argument("--object-type", default="Boxes", help="default: %(default)s")


def main(options: argparse.Namespace) -> None:
    try:
        boxes = np.load(options.array, mmap_mode="r", allow_pickle=False)
    except (OSError, ValueError) as error:
        raise InputError(f"{options.array}: cannot be read: {error}") from None
    write_recording(options.output, boxes, name=options.name, object_type=options.object_type)
