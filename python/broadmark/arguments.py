"""Arguments that users pass: arrays and numbers, converted and checked."""

from __future__ import annotations

import operator
import os
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from broadmark.errors import InputError

Floats = npt.NDArray[np.float32]

#: The box of an absent body.
EMPTY_BOX: Floats = np.array([[np.inf] * 3, [-np.inf] * 3], np.float32)
EMPTY_BOX.flags.writeable = False


def as_boxes(boxes: Any, *, may_be_absent: bool = False) -> Floats:
    """Boxes as an array (n, 2, 3) of 32-bit floats; an array of this type is not copied.

    Accepts (n, 2, 3) and (n, 6): min x y z, max x y z, and an empty list. Other numbers are rounded
    outward: min down, max up. Raises InputError for other shapes, masked arrays, NaN, infinite
    coordinates and boxes with min > max. With `may_be_absent`, EMPTY_BOX marks an absent body.
    """
    array = as_floats(boxes)
    low, high = array[:, 0], array[:, 1]
    if len(array) and not (
        (low <= high).all() and array.min() > -np.inf and array.max() < np.inf  # false for NaN
    ):
        _require_valid(array, may_be_absent)
    return array


def as_floats(boxes: Any) -> Floats:
    """As as_boxes, but 32-bit floats may have any values."""
    array = _as_array("boxes", boxes)
    if array.dtype.kind not in "iuf":
        raise InputError(f"boxes: expected numbers, not type {array.dtype}")
    if array.shape == (0,):
        array = array.reshape(0, 6)
    if array.ndim == 2 and array.shape[1] == 6:
        array = array.reshape(-1, 2, 3)
    if array.ndim != 3 or array.shape[1:] != (2, 3):
        raise InputError(f"boxes: of shape {array.shape}, expected (n, 2, 3) or (n, 6)")
    is_exact = array.dtype.kind == "f" and array.dtype.itemsize <= 4
    return array.astype(np.float32, copy=False) if is_exact else _rounded_outward(array)


def _as_array(name: str, values: Any) -> npt.NDArray[Any]:
    if isinstance(values, np.ma.MaskedArray):
        raise InputError(f"{name}: a masked array; expected an array without a mask")
    try:
        return np.asarray(values)
    except (ValueError, TypeError) as error:  # rows of different lengths
        raise InputError(f"{name}: not an array: {error}") from None


def _rounded_outward(array: npt.NDArray[Any]) -> Floats:
    if array.dtype.kind in "iu":
        array = array.astype(np.longdouble)  # holds all integers of 64 bits
    if (array[:, 0] > array[:, 1]).any():  # by less than rounding moves them, perhaps
        _require_valid(array, may_be_absent=True)
    with np.errstate(over="ignore"):
        rounded = array.astype(np.float32)
    low, high = rounded[:, 0], rounded[:, 1]
    np.nextafter(low, np.float32(-np.inf), out=low, where=low > array[:, 0])
    np.nextafter(high, np.float32(np.inf), out=high, where=high < array[:, 1])
    return rounded


def _require_valid(boxes: npt.NDArray[Any], may_be_absent: bool) -> None:
    """Raises InputError for the first invalid box."""
    not_finite = ~np.isfinite(boxes).all((1, 2))
    invalid = not_finite | (boxes[:, 0] > boxes[:, 1]).any(1)
    if may_be_absent:
        invalid &= (boxes != EMPTY_BOX).any((1, 2))
        if not invalid.any():
            return
    body = int(invalid.argmax())
    if not_finite[body]:
        raise InputError(
            f"boxes: body {body} has a coordinate that is not a finite number of 32 bits"
        )
    raise InputError(
        f"boxes: body {body} has a min {boxes[body, 0]} greater than its max {boxes[body, 1]}"
    )


def as_vectors(name: str, vectors: Any) -> Floats:
    """Points or directions as a contiguous array (n, 3) of finite 32-bit floats."""
    array = _as_array(name, vectors)
    if array.shape == (0,):
        array = np.empty((0, 3), np.float32)
    if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "iuf":
        raise InputError(
            f"{name}: of shape {array.shape} and type {array.dtype}, expected numbers (n, 3)"
        )
    with np.errstate(over="ignore"):
        rounded = np.ascontiguousarray(array, np.float32)
    invalid = ~np.isfinite(rounded).all(1)
    if invalid.any():
        raise InputError(
            f"{name}: row {int(invalid.argmax())} has a number that is not a finite one of 32 bits"
        )
    return rounded


def as_limits(name: str, limits: Any, count: int) -> Floats:
    """A limit, or one for each of `count` queries, as an array (count,); inf: none."""
    array = _as_array(name, limits)
    if array.shape not in ((), (count,)) or array.dtype.kind not in "iuf":
        raise InputError(f"{name}: expected a number, or an array of {count}")
    if not (array >= 0).all():  # false for NaN
        raise InputError(f"{name}: negative, or not a number")
    with np.errstate(over="ignore"):
        return np.array(np.broadcast_to(array, (count,)), np.float32)


def as_layers(layers: Iterable[int] | None) -> int:
    """Bit b: layer b is among the layers; None for all."""
    if layers is None:
        return 0xFFFF_FFFF
    try:
        bits = [1 << as_integer("layer", layer, 0, 31) for layer in layers]
    except TypeError:
        raise InputError(f"layers {layers!r}: expected a list of numbers") from None
    return sum(set(bits))


def as_integer(name: str, value: Any, low: int, high: int) -> int:
    """The value as an integer from `low` to `high`. Raises InputError otherwise."""
    try:
        number = operator.index(value)
    except TypeError:
        number = low - 1
    if not low <= number <= high:
        raise InputError(f"{name} {value}: expected an integer from {low} to {high}")
    return number


def as_threads(threads: Any) -> int:
    """The number of threads; None: all cores."""
    if threads is None:
        return len(os.sched_getaffinity(0))
    return as_integer("threads", threads, 1, 1024)


def as_bodies(name: str, bodies: Any, count: int) -> npt.NDArray[np.uint32]:
    """Numbers of bodies as an array; there are `count` bodies."""
    array = _as_array(name, bodies)
    if array.shape == (0,):
        return np.empty(0, np.uint32)
    if array.ndim != 1 or array.dtype.kind not in "iu":
        raise InputError(
            f"{name}: expected a list of integers, not shape {array.shape} of type {array.dtype}"
        )
    unknown = (array < 0) | (array >= count)
    if unknown.any():
        raise InputError(f"{name}: no body {array[unknown][0]}: there are {count}")
    return np.ascontiguousarray(array, np.uint32)


def as_collisions(layers: Any, limit: int) -> list[int]:
    """Bit b of row a: layers a and b collide. `layers` is a symmetric matrix of at most `limit` rows."""
    matrix = _as_array("layers", layers)
    size = len(matrix) if matrix.ndim else 0
    if matrix.shape != (size, size) or not 1 <= size <= limit or matrix.dtype.kind not in "biu":
        raise InputError(
            f"layers: of shape {matrix.shape} and type {matrix.dtype}, expected a matrix of booleans"
            f" with 1 to {limit} rows and as many columns"
        )
    matrix = matrix != 0
    if (matrix != matrix.T).any():
        a, b = np.argwhere(matrix != matrix.T)[0]
        raise InputError(f"layers: not symmetric: layers {a} and {b}")
    return [sum(1 << b for b in np.flatnonzero(row).tolist()) for row in matrix]
