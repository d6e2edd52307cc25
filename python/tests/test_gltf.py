"""Random glTF scenes from a writer that shares no code with the program, read back by `import`."""

from __future__ import annotations

import base64
import json
import pathlib
from typing import Any

import numpy as np
import pytest

import broadmark
from broadmark.program import call

RATE = 5
TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}


class Scene:
    """A random scene: the JSON object, and the boxes of its triangles in every frame."""

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)
        self.bytes = bytearray()
        self.json: dict[str, Any] = {"asset": {"version": "2.0"}}
        self.curves: dict[tuple[int, str], tuple[str, Any, Any, bool]] = {}  # by node and path
        self.copies: dict[int, Any] = {}  # by node: translations of instances
        self.meshes = [self.mesh() for _ in range(2)]
        self.parents = [int(self.random.integers(-1, i)) for i in range(7)]
        self.json["nodes"] = [self.node(i) for i in range(7)]
        self.skins = [self.skin() for _ in range(2)]
        self.end = 0.0
        self.json["animations"] = [self.animation(nodes) for nodes in (range(3), range(3, 7))]
        roots = [i for i, parent in enumerate(self.parents) if parent < 0]
        self.roots = [int(i) for i in self.random.permutation(roots)]
        self.json["scenes"] = [{"nodes": []}, {"nodes": self.roots}]
        self.json["scene"] = 1

    def chance(self, probability: float) -> bool:
        return bool(self.random.random() < probability)

    # ---- Accessors: each returns its index, and the values that a reader must find.

    def view(self, array: Any, pad: int = 0) -> int:
        """A buffer view of rows, each followed by `pad` bytes, behind a gap."""
        self.bytes += bytes(4 * int(self.random.integers(1, 4)))
        rows = [row.tobytes() for row in np.atleast_2d(array)]
        view = {"buffer": 0, "byteOffset": len(self.bytes)}
        for row in rows:
            self.bytes += row + b"\x7f" * pad
        view["byteLength"] = len(self.bytes) - view["byteOffset"]
        if pad:
            view["byteStride"] = len(rows[0]) + pad
        self.bytes += bytes(-len(self.bytes) % 4)
        return self.add("bufferViews", view)

    def add(self, key: str, item: Any) -> int:
        self.json.setdefault(key, []).append(item)
        return len(self.json[key]) - 1

    def accessor(self, values: Any, kinds: str, normalized: bool | None = False) -> tuple[int, Any]:
        """Stores values of shape (count, width) as one of these component types.

        `normalized` None: at random, for integers."""
        kind = str(self.random.choice(kinds.split()))
        values = np.asarray(values, float)
        is_normalized = kind != "f4" and (self.chance(0.5) if normalized is None else normalized)
        scale = float(np.iinfo(kind).max) if is_normalized else 1.0
        limits = (-np.inf, np.inf) if kind == "f4" else (np.iinfo(kind).min, np.iinfo(kind).max)
        scaled = np.clip(values * scale, *limits)
        stored = (scaled if kind == "f4" else np.rint(scaled)).astype("<" + kind)
        accessor: dict[str, Any] = {
            "componentType": COMPONENTS[kind],
            "count": len(stored),
            "type": TYPES[stored.shape[1]],
        }
        if is_normalized:
            accessor["normalized"] = True
        written = stored.copy()
        if self.chance(0.3):  # some elements are wrong, and replaced by sparse ones
            places = np.flatnonzero(self.random.random(len(stored)) < 0.5)
            if len(places):
                written[places] = 77
                accessor["sparse"] = {
                    "count": len(places),
                    "indices": {
                        "bufferView": self.view(places.astype("<u2")),
                        "componentType": 5123,
                    },
                    "values": {"bufferView": self.view(stored[places])},
                }
        accessor["bufferView"] = self.view(written, pad=4 * int(self.random.integers(0, 3)))
        read = np.maximum(stored.astype(float) / scale, -1 if is_normalized else -np.inf)
        return self.add("accessors", accessor), read

    # ---- Parts of a scene.

    def mesh(self) -> dict[str, Any]:
        targets = int(self.random.integers(0, 3))
        mesh: dict[str, Any] = {"primitives": [], "weights": [0.5, -1.0][:targets]}
        read = []
        for _ in range(int(self.random.integers(1, 4))):
            count = 3 * int(self.random.integers(1, 5))
            everything = "f4 i1 i2 u1 u2"
            position, points = self.accessor(
                self.random.uniform(-5, 5, (count, 3)), everything, None
            )
            attributes = {"POSITION": position}
            sums = self.random.dirichlet(np.ones(8), count)
            joints, weights = [], []
            for part in range(2):
                joint, which = self.accessor(self.random.integers(0, 3, (count, 4)), "u1 u2")
                weight, share = self.accessor(sums[:, 4 * part : 4 * part + 4], "f4 u1 u2", True)
                attributes |= {f"JOINTS_{part}": joint, f"WEIGHTS_{part}": weight}
                joints.append(which)
                weights.append(share)
            shares = np.hstack(weights)
            shares /= shares.sum(axis=1, keepdims=True)
            moved = [
                self.accessor(self.random.uniform(-2, 2, (count, 3)), everything, None)
                for _ in range(targets)
            ]
            primitive: dict[str, Any] = {"attributes": attributes}
            if targets:
                primitive["targets"] = [{"POSITION": target} for target, _ in moved]
            corners = np.arange(count)
            if self.chance(0.7):
                corners = self.random.permutation(count)
                primitive["indices"], _ = self.accessor(corners[:, None], "u1 u2 u4")
            mode = int(self.random.choice([4, 5, 6]))
            if mode != 4 or self.chance(0.5):
                primitive["mode"] = mode
            if mode == 4:
                faces = corners.reshape(-1, 3)
            elif mode == 5:  # the order of corners does not change a box
                faces = np.array([corners[i : i + 3] for i in range(count - 2)])
            else:
                faces = np.array([[corners[0], *corners[i : i + 2]] for i in range(1, count - 1)])
            mesh["primitives"].append(primitive)
            read.append(
                (points, [d for _, d in moved], np.hstack(joints).astype(int), shares, faces)
            )
        if not targets:
            del mesh["weights"]
        return {"index": self.add("meshes", mesh), "primitives": read, "targets": targets}

    def rotation(self) -> Any:
        rotation = self.random.normal(size=4)
        return rotation / np.linalg.norm(rotation)

    def node(self, index: int) -> dict[str, Any]:
        node: dict[str, Any] = {"name": "same"}
        children = [i for i, parent in enumerate(self.parents) if parent == index]
        if children:
            node["children"] = children
        parts = {
            "translation": self.random.uniform(-9, 9, 3),
            "rotation": self.rotation(),
            "scale": self.random.uniform(-2, 2, 3),
        }
        if self.chance(0.3):
            node["matrix"] = placed(**parts).T.ravel().tolist()
        else:
            node |= {key: value.tolist() for key, value in parts.items() if self.chance(0.7)}
        if self.chance(0.7):
            node["mesh"] = int(self.random.integers(0, 2))
            targets = self.meshes[node["mesh"]]["targets"]
            if targets and self.chance(0.5):
                node["weights"] = self.random.uniform(-1, 1, targets).tolist()
            if self.chance(0.4):
                node["skin"] = int(self.random.integers(0, 2))
            elif self.chance(0.3):
                count = int(self.random.integers(1, 4))
                moves, self.copies[index] = self.accessor(
                    self.random.uniform(-9, 9, (count, 3)), "f4"
                )
                attributes = {"TRANSLATION": moves}
                node["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
        return node

    def skin(self) -> Any:
        joints = [int(i) for i in self.random.permutation(7)[:3]]
        skin: dict[str, Any] = {"joints": joints}
        inverse = np.tile(np.eye(4), (3, 1, 1))
        if self.chance(0.7):
            inverse[:, :3] += self.random.uniform(-1, 1, (3, 3, 4))
            columns = inverse.transpose(0, 2, 1).reshape(3, 16)
            skin["inverseBindMatrices"], read = self.accessor(columns, "f4")
            inverse = read.reshape(3, 4, 4).transpose(0, 2, 1)
        self.add("skins", skin)
        return joints, inverse

    def animation(self, nodes: range) -> dict[str, Any]:
        animation: dict[str, Any] = {"channels": [], "samplers": []}
        for node in nodes:
            for path in ("translation", "rotation", "scale", "weights"):
                of = self.json["nodes"][node]
                targets = self.meshes[of["mesh"]]["targets"] if "mesh" in of else 0
                impossible = not targets if path == "weights" else "matrix" in of
                if impossible or self.chance(0.5):
                    continue
                self.curve(animation, node, path, targets)
        return animation

    def curve(self, animation: dict[str, Any], node: int, path: str, targets: int) -> None:
        width = {"rotation": 4, "weights": targets}.get(path, 3)
        keys = int(self.random.integers(1, 5))
        kind = str(self.random.choice(["STEP", "LINEAR", "CUBICSPLINE"]))
        times = np.cumsum(self.random.uniform(0.1, 0.9, keys)).reshape(-1, 1)
        values = self.random.uniform(-1, 1, (keys, 3, width))
        if path == "rotation":
            values[:, 1] = [self.rotation() for _ in range(keys)]
        if kind != "CUBICSPLINE":
            values = values[:, 1:2]
        flat = values.reshape(-1, 1 if path == "weights" else width)
        kinds = "f4" if path in ("translation", "scale") else "f4 i1 i2"
        output, read = self.accessor(flat, kinds, True)
        start, seconds = self.accessor(times, "f4")
        animation["channels"].append(
            {"sampler": len(animation["samplers"]), "target": {"node": node, "path": path}}
        )
        sampler = {"input": start, "output": output, "interpolation": kind}
        animation["samplers"].append(sampler)
        seconds = seconds.ravel()
        self.end = max(self.end, seconds[-1])
        self.curves[node, path] = (kind, seconds, read.reshape(values.shape), path == "rotation")

    # ---- What is to be read.

    def boxes(self, time: float) -> Any:
        state: list[Any] = []
        for index, node in enumerate(self.json["nodes"]):
            at = {
                path: value_at(*curve, time)
                for (i, path), curve in self.curves.items()
                if i == index
            }
            if "matrix" in node:
                local = np.array(node["matrix"]).reshape(4, 4).T
            else:
                parts = {"translation": [0, 0, 0], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]}
                local = placed(**{key: at.get(key, node.get(key, parts[key])) for key in parts})
            parent = self.parents[index]
            state.append((state[parent][0] @ local if parent >= 0 else local, at))
        found: list[Any] = []
        for root in self.roots:
            self.add_boxes(root, state, found)
        return np.array(found).reshape(-1, 2, 3)

    def add_boxes(self, index: int, state: Any, found: list[Any]) -> None:
        node = self.json["nodes"][index]
        if "mesh" in node:
            matrix, at = state[index]
            stated = self.json["meshes"][node["mesh"]].get("weights")
            weights = at.get("weights", node.get("weights", stated or []))
            for copy in self.copies.get(index, np.zeros((1, 3))):
                for points, targets, joints, shares, faces in self.meshes[node["mesh"]][
                    "primitives"
                ]:
                    moved = points + sum(w * d for w, d in zip(weights, targets))
                    whole = np.hstack([moved + copy, np.ones((len(points), 1))])
                    if "skin" in node:
                        bones, inverse = self.skins[node["skin"]]
                        bent = np.array([state[j][0] @ m for j, m in zip(bones, inverse)])
                        blend = np.einsum("vi,vixy->vxy", shares, bent[joints])
                        placed_points = np.einsum("vxy,vy->vx", blend, whole)[:, :3]
                    else:
                        placed_points = (whole @ matrix.T)[:, :3]
                    corners = placed_points[faces]
                    found += list(np.stack([corners.min(axis=1), corners.max(axis=1)], axis=1))
        for child in node.get("children", []):
            self.add_boxes(child, state, found)


def placed(translation: Any, rotation: Any, scale: Any) -> Any:
    """The matrix of a translation, a rotation x, y, z, w, and a scale."""
    x, y, z, w = np.asarray(rotation) / np.linalg.norm(rotation)
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] *= np.asarray(scale)
    matrix[:3, 3] = translation
    return matrix


def value_at(kind: str, times: Any, values: Any, is_rotation: bool, time: float) -> Any:
    """A curve's value; of a cubic spline, values are tangent in, value, tangent out."""
    middle = values.shape[1] // 2
    points = values[:, middle]
    if time <= times[0]:
        return points[0]
    if time >= times[-1]:
        return points[-1]
    last = int(np.searchsorted(times, time, side="right")) - 1
    if kind == "STEP":
        return points[last]
    duration = times[last + 1] - times[last]
    t = (time - times[last]) / duration
    a, b = points[last], points[last + 1]
    if kind == "LINEAR" and is_rotation:
        a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
        b = b * (-1 if a @ b < 0 else 1)
        angle = np.arccos(min(a @ b, 1.0))
        if angle > 1e-6:
            return (np.sin((1 - t) * angle) * a + np.sin(t * angle) * b) / np.sin(angle)
    if kind == "LINEAR":
        return a + t * (b - a)
    if is_rotation:
        a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    tangents = duration * values[last, 2], duration * values[last + 1, 0]
    basis = [
        2 * t**3 - 3 * t**2 + 1,
        t**3 - 2 * t**2 + t,
        3 * t**2 - 2 * t**3,
        t**3 - t**2,
    ]
    return basis[0] * a + basis[1] * tangents[0] + basis[2] * b + basis[3] * tangents[1]


def write(scene: Scene, path: pathlib.Path, form: str) -> None:
    buffer: dict[str, Any] = {"byteLength": len(scene.bytes)}
    whole = scene.json | {"buffers": [buffer]}
    if form == "text":
        buffer["uri"] = "data:;base64," + base64.b64encode(scene.bytes).decode()
    elif form == "beside":
        (path.parent / "my buffer.bin").write_bytes(scene.bytes)
        buffer["uri"] = "my%20buffer.bin"
    else:
        text = json.dumps(whole).encode()
        text += b" " * (-len(text) % 4)
        chunk = bytes(scene.bytes) + bytes(-len(scene.bytes) % 4)
        parts = [(text, b"JSON"), (chunk, b"BIN\0")]
        body = b"".join(len(part).to_bytes(4, "little") + kind + part for part, kind in parts)
        path.write_bytes(b"glTF\2\0\0\0" + (12 + len(body)).to_bytes(4, "little") + body)
        return
    path.write_text(json.dumps(whole))


@pytest.mark.parametrize("seed", range(24))
def test_random_scenes_are_read_back(seed: int, tmp_path: pathlib.Path) -> None:
    scene = Scene(seed)
    path = tmp_path / "a.gltf"
    write(scene, path, ["text", "beside", "binary"][seed % 3])
    frames = int(np.floor(scene.end * RATE)) + 1
    expected = np.array([scene.boxes(frame / RATE) for frame in range(frames)])
    recording = tmp_path / "a.aabbs"
    options = ["--frame-rate", str(RATE), "--keep", "shared-vertices", "--quiet"]
    if not expected.size:
        with pytest.raises(broadmark.InputError, match="no vertices"):
            call("import", str(path), *options, "-o", str(recording))
        return
    call("import", str(path), *options, "-o", str(recording))
    boxes = broadmark.read_recording(recording).boxes
    assert boxes.shape == expected.shape
    np.testing.assert_allclose(boxes, expected, rtol=1e-5, atol=1e-5 * np.abs(expected).max())
