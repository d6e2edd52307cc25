"""Atomic writing of files."""

from __future__ import annotations

import contextlib
import os
import pathlib
import sys
from collections.abc import Iterator
from typing import Any

from broadmark.errors import InputError


@contextlib.contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Iterator[Any]:
    """A binary file that replaces `path` once it is complete and on the disk. An error removes it."""
    path = pathlib.Path(path)
    partial = path.with_name(path.name + f".{os.getpid()}.partial")
    try:
        with open(partial, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(partial, path)
        sync_folder(path.parent)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
    finally:
        partial.unlink(missing_ok=True)


def sync_folder(path: pathlib.Path) -> None:
    """Flushes a folder's entries to the disk, so that renames survive a power failure."""
    folder = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def write_text(path: str | None, text: str) -> None:
    """Writes a text to a file; prints it if `path` is None or "-"."""
    write_bytes(path or "-", text.encode())


def write_bytes(path: str, content: bytes) -> None:
    """Writes a file, or standard output if `path` is "-"."""
    if path == "-":
        sys.stdout.flush()
        sys.stdout.buffer.write(content)
        return
    with atomic_write(path) as file:
        file.write(content)
