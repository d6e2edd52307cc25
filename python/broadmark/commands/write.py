"""Writes an array of boxes as a recording (.aabbs, .broadmark).

The array is a numpy file (.npy, or .npz with one array or one named boxes) of shape (F + 1, n, 2, 3)
or (F + 1, n, 6): the min and max corners of each body in the initial pose and in each frame.
"""

from __future__ import annotations

import argparse
import zipfile
import zlib
from typing import Any

import numpy as np

from broadmark.errors import InputError
from broadmark.recordings import write_recording


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("array", metavar="FILE", help="the boxes (.npy, .npz)")
    parser.add_argument(
        "-o", "--output", required=True, metavar="FILE", help="the recording (.aabbs, .broadmark)"
    )
    parser.add_argument("--name", default="Custom", help="name of the scene (default: %(default)s)")
    parser.add_argument("--object-type", default="Boxes", help="default: %(default)s")


def main(options: argparse.Namespace) -> None:
    boxes = _read_array(options.array)
    write_recording(options.output, boxes, name=options.name, object_type=options.object_type)


def _read_array(path: str) -> Any:
    try:
        content = np.load(path, mmap_mode="r", allow_pickle=False)
        if isinstance(content, np.ndarray):
            return content
        names = content.files
        return content[names[0] if len(names) == 1 else "boxes"]
    except KeyError:
        raise InputError(f"{path}: holds {len(names)} arrays, none named boxes") from None
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
