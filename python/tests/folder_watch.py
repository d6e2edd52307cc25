"""Waits for changes in a folder."""

from __future__ import annotations

import ctypes
import os
import pathlib
from collections.abc import Callable

#: IN_MODIFY, IN_CLOSE_WRITE, IN_MOVED_FROM, IN_MOVED_TO, IN_CREATE, IN_DELETE.
CHANGES = 0x2 | 0x8 | 0x40 | 0x80 | 0x100 | 0x200


def wait_until(folder: pathlib.Path, condition: Callable[[], object]) -> None:
    """Waits until the condition holds, checked after every change below the folder."""
    libc = ctypes.CDLL(None)
    events = libc.inotify_init1(os.O_CLOEXEC)
    try:
        while True:
            # Add the watches before the check, so that no change is missed.
            for path, _, _ in os.walk(folder):
                libc.inotify_add_watch(events, os.fsencode(path), CHANGES)
            if condition():
                return
            os.read(events, 1 << 16)
    finally:
        os.close(events)
