"""Files that appear only when they are complete."""

from __future__ import annotations

import contextlib
import os
import pathlib
from collections.abc import Iterator
from typing import Any

from broadmark.errors import InputError


@contextlib.contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Any]:
    """A binary file that gets its name when it is complete and on the disc, and is removed when it
    does not get so far."""
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
    """Makes sure that the names in a folder outlive a power failure."""
    folder = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def write_text(path: str | None, text: str) -> None:
    """Writes a text to a file, or prints it where none is named."""
    if path is None:
        print(text, end="")
        return
    with whole_file(path) as file:
        file.write(text.encode())
