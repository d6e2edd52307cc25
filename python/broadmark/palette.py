"""The colours by their meaning, read from assets/palette.txt as by the program."""

from __future__ import annotations

import pathlib
import zlib

_MODULE = pathlib.Path(__file__).resolve()
_CANDIDATES = [_MODULE.with_name("palette.txt"), _MODULE.parents[2] / "assets/palette.txt"]

#: Colours by name, for light and for dark backgrounds.
LIGHT: dict[str, list[str]] = {}
DARK: dict[str, list[str]] = {}

#: The indices of each listed algorithm's curve colour and symbol, without -mt.
LOOKS: dict[str, tuple[int, int]] = {}

#: The number of symbols, all well apart: circle, square, triangle, diamond, star, cross.
SYMBOLS = 6

for _line in next(path for path in _CANDIDATES if path.exists()).read_text("utf-8").splitlines():
    if _line and not _line.startswith("#"):
        _name, _light, _dark, *_meaning = _line.split(maxsplit=3)
        if _name == "curve":
            LOOKS |= {
                _algorithm: (len(LIGHT.get("curve", [])), _symbol)
                for _symbol, _algorithm in enumerate(_meaning[0].split(", "))
            }
        LIGHT.setdefault(_name, []).append(f"#{_light}")
        DARK.setdefault(_name, []).append(f"#{_dark}")


def light(name: str) -> str:
    """The colour `name` on light backgrounds."""
    (colour,) = LIGHT[name]
    return colour


def look_of(algorithm: str) -> tuple[int, int]:
    """The indices of an algorithm's curve colour and symbol, the same in every figure. A multi-threaded
    variant has those of the single-threaded one; an algorithm that the palette does not list, those that
    its name hashes to."""
    name = algorithm.removesuffix("-mt")
    hashed = zlib.crc32(name.encode())
    count = len(LIGHT["curve"])
    return LOOKS.get(name, (hashed % count, hashed // count % SYMBOLS))


def css(colours: dict[str, list[str]]) -> str:
    """CSS custom properties: --NAME, or --NAME-0, --NAME-1, … for a list of colours."""
    named = [
        (name if len(values) == 1 else f"{name}-{i}", colour)
        for name, values in colours.items()
        for i, colour in enumerate(values)
    ]
    return " ".join(f"--{name}: {colour};" for name, colour in named)
