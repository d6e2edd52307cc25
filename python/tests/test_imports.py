"""Property test of imports: random worlds, written by independent writers, are read as they are."""

from __future__ import annotations

import gzip
import pathlib
import random
import zipfile
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


NUMPY_TYPES = ["<f4", ">f4", "<f8", ">f8", "|i1", "|u1", "<i2", ">u2", "<i4", ">u4", "<i8", ">u8"]


@pytest.mark.parametrize("kind", NUMPY_TYPES)
@pytest.mark.parametrize("archive", ["npy", "npz", "compressed"])
def test_arrays_are_read_as_python_reads_them(
    kind: str, archive: str, tmp_path: pathlib.Path
) -> None:
    generator = np.random.default_rng(len(kind) + ord(kind[1]))
    low = generator.uniform(0, 100, (4, 9, 1, 3)).astype(kind)
    boxes = np.concatenate([low, low + np.array(3).astype(kind)], axis=2)
    if kind[1:] in ("i8", "u8"):
        boxes = boxes + np.array(2**62 + 1).astype(kind)  # between doubles
    source = tmp_path / "boxes.dat"  # recognised by its content
    with open(source, "wb") as file:
        if archive == "npy":
            np.save(file, boxes)
        elif archive == "npz":
            np.savez(file, other=[1, 2], boxes=boxes.reshape(4, 9, 6))
        else:
            np.savez_compressed(file, anything=boxes)
    call("import", str(source), "-o", str(tmp_path / "read.aabbs"), "--quiet")
    broadmark.write_recording(tmp_path / "written.aabbs", boxes)
    read, written = (
        broadmark.read_recording(tmp_path / f"{name}.aabbs") for name in ("read", "written")
    )
    np.testing.assert_array_equal(read.boxes, written.boxes)
    np.testing.assert_array_equal(read.world, written.world)


def test_an_array_may_be_far_larger_than_its_archive(tmp_path: pathlib.Path) -> None:
    boxes = np.zeros((40, 3000, 6))
    boxes[-1, -1, 3:] = 7
    np.savez_compressed(tmp_path / "a.npz", boxes)
    assert (tmp_path / "a.npz").stat().st_size < boxes.nbytes / 500
    call("import", str(tmp_path / "a.npz"), "-o", str(tmp_path / "a.aabbs"), "--quiet")
    recording = broadmark.read_recording(tmp_path / "a.aabbs")
    np.testing.assert_array_equal(recording.boxes, boxes.reshape(40, 3000, 2, 3))


def test_arrays_may_have_absent_bodies_and_be_a_sequence(tmp_path: pathlib.Path) -> None:
    box = np.array([[0, 0, 0], [1, 1, 1]], np.float32)
    for number in range(12):  # frame10 comes after frame9
        second = broadmark.EMPTY_BOX if number == 5 else box + np.float32(number / 20)
        np.save(tmp_path / f"frame{number}.npy", np.stack([box, second]))
    results = broadmark.run(f"{tmp_path}/frame*.npy", algorithm="bf,tide")
    assert set(results.cases["status"]) == {"ok"} and results.cases["frames"][0] == 11
    assert list(results.frames["pairs"][:11]) == [1] * 4 + [0] + [1] * 6


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (np.zeros((3, 2, 5)), r"its shape is \(3, 2, 5\): \(frames, bodies, 2, 3\)"),
        (np.zeros(6), "its shape is"),
        (np.zeros((0, 2, 6)), ".*: it has no frame"),
        (np.asfortranarray(np.zeros((3, 2, 6))), ".*Fortran order"),
        (np.zeros((2, 2, 6), np.float16), "its type is '<f2': integers, or floats of 32 or 64"),
        (np.zeros((2, 2, 6), complex), "its type is '<c16'"),
        (np.zeros((2, 2, 6), [("a", "f4")]), "its type is"),
        (np.full((2, 2, 6), np.nan), "frame 0, body 0: nan"),
        (np.full((2, 2, 6), 1e300), "frame 0, body 0: .* is not finite in 32 bits"),
        (np.array([[[0, 0, 0, 1, 1, 1]], [[0, 2, 0, 1, 1, 1]]]), "frame 1, body 0: min 2 is above"),
    ],
)
def test_other_arrays_are_refused(array: Any, message: str, tmp_path: pathlib.Path) -> None:
    np.save(tmp_path / "a.npy", array)
    with pytest.raises(broadmark.InputError, match="a.npy: " + message):
        call("verify", str(tmp_path / "a.npy"))


def test_other_archives_are_refused(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "a.npz"

    def refused(message: str) -> None:
        with pytest.raises(broadmark.InputError, match="a.npz: " + message):
            call("verify", str(path))

    boxes = np.random.default_rng(1).uniform(0, 1, (20, 9, 1, 3)) + [[0, 0, 0], [1, 1, 1]]
    np.savez(path, first=boxes, second=boxes)
    refused("holds first, second: a single array, or one named 'boxes', is expected")
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("readme.txt", "none")
    refused("holds no array")
    with zipfile.ZipFile(path, "w", zipfile.ZIP_BZIP2) as archive:
        np.save(tmp_path / "a.npy", boxes)
        archive.write(tmp_path / "a.npy", "a.npy")
    refused("array 'a': is compressed by method 12: use numpy.savez")
    np.savez_compressed(path, boxes)
    whole = path.read_bytes()
    path.write_bytes(whole[:-30])
    refused("the archive has no directory")
    path.write_bytes(whole[:2000] + bytes([whole[2000] ^ 64]) + whole[2001:])
    refused("array 'arr_0': its c")  # compressed data, or checksum
