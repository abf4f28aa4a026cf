# SPDX-FileCopyrightText: 2026 the flocklift authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes to files: binary PLY, and GLB with a skin. The same bytes on every machine: coordinates are
rounded to 0.1 mm before they are written; and before that to where the last bits, in which sines
differ between processors, cannot decide what lies halfway."""

import json
import struct

import numpy as np


def _rounded(values):
    return (np.round(np.round(np.asarray(values, float), 9), 4) + 0.0).astype("<f4")


def ply(vertices, triangles):
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar uint vertex_indices\nend_header\n"
    )
    faces = np.zeros(len(triangles), dtype=[("count", "u1"), ("corners", "<u4", 3)])
    faces["count"] = 3
    faces["corners"] = triangles
    return head.encode() + _rounded(vertices).tobytes() + faces.tobytes()


def _y_up(p):
    p = np.asarray(p, float)
    return np.stack([p[..., 0], p[..., 2], -p[..., 1]], -1)


class _Buffer:
    """The binary part of a GLB and what its JSON part says of it."""

    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def add(self, array, component, kind, extremes=False):
        data = np.ascontiguousarray(array)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": data.nbytes})
        entry = {"bufferView": len(self.views) - 1, "componentType": component,
                 "count": len(data), "type": kind}
        if extremes:
            flat = data.reshape(len(data), -1)
            entry |= {"min": flat.min(0).tolist(), "max": flat.max(0).tolist()}
        self.accessors.append(entry)
        self.bytes += data.tobytes() + bytes(-data.nbytes % 4)
        return len(self.accessors) - 1


def skinned_glb(vertices, triangles, bones, joints, weights, poses, duration):
    """`bones`: {name: (parent, joint, ...)}; `poses`: evenly spaced (angles, rise), closed to a loop.
    A positive angle turns what hangs down forwards, about the axis across."""
    names = list(bones)
    buffer = _Buffer()
    attributes = {
        "POSITION": buffer.add(_rounded(_y_up(vertices)), 5126, "VEC3", True),
        "JOINTS_0": buffer.add(np.asarray(joints, "u1"), 5121, "VEC4"),
        "WEIGHTS_0": buffer.add(np.asarray(_rounded(weights)), 5126, "VEC4"),
    }
    indices = buffer.add(np.asarray(triangles, "<u2").reshape(-1), 5123, "SCALAR")
    inverse = np.tile(np.eye(4, dtype="<f4"), (len(names), 1, 1))
    for k, name in enumerate(names):
        inverse[k, 3, :3] = -_rounded(_y_up(bones[name][1]))
    inverse_bind = buffer.add(inverse.reshape(len(names), 16), 5126, "MAT4")

    nodes, origin = [], {name: _y_up(bones[name][1]) for name in names}
    for name in names:
        parent = bones[name][0]
        offset = origin[name] - (origin[parent] if parent else 0)
        children = [names.index(other) for other in names if bones[other][0] == name]
        node = {"name": name, "translation": _rounded(offset).tolist()}
        nodes.append(node | ({"children": children} if children else {}))
    nodes.append({"name": "horse", "mesh": 0, "skin": 0})

    looped = [*poses, poses[0]]
    times = buffer.add(_rounded(np.linspace(0, duration, len(looped))), 5126, "SCALAR", True)
    samplers, channels = [], []
    for k, name in enumerate(names):
        half = np.array([angles.get(name, 0) for angles, _ in looped]) / 2
        zero = np.zeros(len(looped))
        turn = np.stack([zero, zero, np.sin(half), np.cos(half)], 1)
        samplers.append({"input": times, "output": buffer.add(_rounded(turn), 5126, "VEC4")})
        channels.append({"sampler": k, "target": {"node": k, "path": "rotation"}})
    rise = np.array([[0, rise, 0] for _, rise in looped]) + origin[names[0]]
    samplers.append({"input": times, "output": buffer.add(_rounded(rise), 5126, "VEC3")})
    channels.append({"sampler": len(names), "target": {"node": 0, "path": "translation"}})

    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, len(nodes) - 1]}],
        "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices}]}],
        "skins": [{"joints": list(range(len(names))), "inverseBindMatrices": inverse_bind}],
        "animations": [{"name": "gallop", "samplers": samplers, "channels": channels}],
        "buffers": [{"byteLength": len(buffer.bytes)}],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(buffer.bytes)
    return (
        struct.pack("<4sIIII", b"glTF", 2, total, len(text), 0x4E4F534A) + text
        + struct.pack("<II", len(buffer.bytes), 0x004E4942) + buffer.bytes
    )
