"""Property test of imports: random worlds, written by independent writers, are read as they are."""

from __future__ import annotations

import gzip
import pathlib
import random
from typing import Any

import numpy as np
import pytest

import broadmark
from broadmark.program import call

World = list[dict[int, Any]]  #: for each frame the centre of each body by id


def random_world(chance: random.Random, varying: bool) -> World:
    """Frames of bodies, by ids with gaps; the first and the last have all of them."""
    ids = chance.sample(range(1, 1000), chance.randint(1, 8))
    count = chance.randint(2, 5)
    frames = []
    for frame in range(count):
        whole = not varying or frame in (0, count - 1)
        present = [i for i in ids if whole or chance.random() < 0.7]
        frames.append({i: [chance.uniform(-20, 20) for _ in range(3)] for i in present})
    return frames


def shuffled(chance: random.Random, items: Any) -> list[Any]:
    shuffled_items = list(items)
    chance.shuffle(shuffled_items)
    return shuffled_items


def number(chance: random.Random, value: float) -> str:
    """In one of the ways to write a number without loss."""
    return chance.choice((f"{value!r}", f"{value:+.17e}", f"{value:.17G}"))


def written_csv(chance: random.Random, world: World, radius: float) -> str:
    delimiter = chance.choice((",", ";", "\t", " , "))
    first, second = chance.choice((("min_{}", "max_{}"), ("{}Min", "{}Max"), ("c{}", "h{}")))
    forms = {axis: (first.format(axis), second.format(axis)) for axis in "xyz"}
    columns = [name for pair in forms.values() for name in pair] + ["frame", "id", "remark"]
    columns = shuffled(chance, columns)
    lines = ["# boxes", delimiter.join(map(str.upper, columns))]
    for frame, bodies in enumerate(world):
        for body, centre in shuffled(chance, bodies.items()):
            row = {"frame": str(frame), "id": str(body), "remark": f'"a{delimiter}b"'}
            for axis, value in zip("xyz", centre):
                pair = (value - radius, value + radius)
                if first == "c{}":
                    pair = (value, radius)
                for name, part in zip(forms[axis], pair):
                    row[name] = number(chance, part)
            lines.append(delimiter.join(row[name] for name in columns))
    return "\n".join(lines) + "\n"


def written_xyz(chance: random.Random, world: World, radius: float) -> str:
    lines = []
    for bodies in world:
        columns = shuffled(chance, ("id:I:1", "species:S:1", "pos:R:3", "forces:R:3", "radius:R:1"))
        key = chance.choice(("Properties", "properties", "PROPERTIES"))
        value = ":".join(columns)
        comment = shuffled(
            chance,
            (
                chance.choice((f"{key}={value}", f'{key} = "{value}"')),
                'Lattice="9 0 0 0 9 0 0 0 9"',
                "energy=-3.5",
                "note='some = text'",
            ),
        )
        lines += [str(len(bodies)), " ".join(comment)]
        for body, centre in shuffled(chance, bodies.items()):
            cells = {
                "id": str(body),
                "species": "Si",
                "pos": " ".join(number(chance, value) for value in centre),
                "forces": "7 8 9",
                "radius": number(chance, radius),
            }
            lines.append("  ".join(cells[column.split(":")[0]] for column in columns))
    return "\n".join(lines) + "\n"


def written_lammps(chance: random.Random, world: World, radius: float) -> str:
    form = chance.choice(("cuboid", "slanted", "general"))
    names = chance.choice(("x y z", "xu yu zu", "xs ys zs", "xsu ysu zsu"))
    lines = []
    for step, bodies in enumerate(world):
        edges = np.diag([chance.uniform(5, 30) for _ in range(3)])
        if form != "cuboid":
            edges += np.tril([[chance.uniform(-4, 4) for _ in range(3)] for _ in range(3)], -1)
        if form == "general":  # any rotation of it
            edges = (
                edges @ np.linalg.qr(np.reshape([chance.gauss(0, 1) for _ in range(9)], (3, 3)))[0]
            )
        origin = np.array([chance.uniform(-9, 9) for _ in range(3)])
        bounds = np.stack([origin, origin + np.diag(edges)], axis=1)
        boundaries = "pp ff sm"
        if form == "slanted":
            xy, xz, yz = edges[1, 0], edges[2, 0], edges[2, 1]
            corners = np.array([[0, xy, xz, xy + xz], [0, 0, yz, yz], [0, 0, 0, 0]])
            bounds += np.stack([corners.min(1), corners.max(1)], axis=1)
            bounds = np.column_stack([bounds, (xy, xz, yz)])
            boundaries = "xy xz yz " + boundaries
        elif form == "general":
            bounds = np.column_stack([edges, origin])
            boundaries = "abc origin " + boundaries
        lines += ["ITEM: TIMESTEP", str(100 * step), "ITEM: NUMBER OF ATOMS", str(len(bodies))]
        lines.append(f"ITEM: BOX BOUNDS {boundaries}")
        lines += [" ".join(number(chance, value) for value in row) for row in bounds.tolist()]
        columns = shuffled(chance, ("id", "type", names, "ix iy iz", "vx", "radius"))
        lines.append("ITEM: ATOMS " + " ".join(columns))
        for body, centre in shuffled(chance, bodies.items()):
            images = [chance.randint(-2, 2) for _ in range(3)]
            position = np.array(centre)
            if "u" not in names:  # back into the first cell
                position = position - np.array(images) @ edges
            if "s" in names:
                position = np.linalg.solve(edges.T, position - origin)
            cells = {
                "id": str(body),
                "type": "1",
                names: " ".join(number(chance, value) for value in position.tolist()),
                "ix iy iz": " ".join(map(str, images)),
                "vx": "5",
                "radius": number(chance, radius),
            }
            lines.append(" ".join(cells[column] for column in columns))
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("write", (written_csv, written_xyz, written_lammps))
def test_random_worlds_are_read_as_they_are(tmp_path: pathlib.Path, write: Any) -> None:
    for seed in range(25):
        chance = random.Random(seed)
        world = random_world(chance, varying=seed % 2 == 1)
        radius = chance.uniform(0.01, 3)
        text = write(chance, world, radius)
        text = chance.choice(("", "\ufeff")) + text.replace(
            "\n", chance.choice(("\n", "\r\n", "\r"))
        )
        source = tmp_path / f"world.{seed}"  # recognised by its content
        data = text.encode()
        source.write_bytes(gzip.compress(data) if chance.random() < 0.3 else data)
        path = tmp_path / f"{seed}.broadmark"
        call("import", str(source), "-o", str(path), "--quiet")
        recording = broadmark.read_recording(path)
        assert isinstance(recording, broadmark.ChangingRecording)
        ids = sorted(set().union(*world))
        assert recording.bodies == len(ids) and recording.last_frame == len(world) - 1
        for frame, bodies in enumerate(world):
            boxes = recording.frame(frame)
            for box, body in zip(boxes, ids):
                if body not in bodies:
                    assert np.isinf(box).all(), (seed, frame, body)
                    continue
                centre = np.array(bodies[body])
                expected = np.stack([centre - radius, centre + radius])
                np.testing.assert_allclose(box, expected, rtol=1e-6, atol=1e-5, err_msg=str(seed))
