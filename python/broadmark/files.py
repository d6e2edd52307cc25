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
    """A binary file that replaces `path` once it is complete and on the disk. An error removes it.
    A symbolic link's target is replaced. "-" is standard output."""
    if is_standard_output(path):
        sys.stdout.flush()
        yield sys.stdout.buffer
        return
    if os.path.exists(path) and not os.path.isfile(path):
        # Renaming over a device (/dev/null) would replace it.
        raise InputError(f"{path}: cannot be written: not a regular file")
    target = pathlib.Path(os.path.realpath(path))
    partial = target.with_name(target.name + f".{os.getpid()}.partial")
    try:
        with open(partial, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(partial, target)
        sync_folder(target.parent)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
    finally:
        with contextlib.suppress(OSError):  # it was renamed, or could not be made
            partial.unlink()


def is_standard_output(path: str | os.PathLike[str]) -> bool:
    return os.fspath(path) == "-"


def report_written(path: str | os.PathLike[str], more: str = "") -> None:
    """Prints that a file was written; not among what is written to standard output."""
    if not is_standard_output(path):
        print(f"written: {os.fspath(path)}{more}")


def sync_folder(path: pathlib.Path) -> None:
    """Flushes a folder's entries to the disk, so that renames survive a power failure."""
    folder = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def write_text(path: str | None, text: str) -> None:
    """Writes a text to a file, or standard output if `path` is None."""
    write_bytes(path or "-", text.encode())


def write_bytes(path: str, content: bytes) -> None:
    """Writes a file, as atomic_write()."""
    with atomic_write(path) as file:
        file.write(content)
