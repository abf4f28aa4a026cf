# SPDX-FileCopyrightText: 2026 the flocklift authors
# SPDX-License-Identifier: BSD-3-Clause
"""Animals as rods grown together [m]: they face +x, z is up, the ground is z = 0."""

import numpy as np

from meshes.implicit import ball, both_sides, chain, surface, union


def _grown(parts, blend, cell, margin=0.3):
    """The surface of the parts; the box around them is found by looking, coarsely."""
    f = union(parts, blend)
    axes = [np.arange(-3.5, 3.5, 0.2)] * 3
    points = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    near = points[f(points) < 0.2]
    return surface(f, near.min(0) - margin, near.max(0) + margin, cell)


def mammoth():
    parts = chain((-0.75, 0, 1.3, 0.42), (-0.3, 0, 1.45, 0.5), (0.3, 0, 1.62, 0.52))  # back
    parts += chain((-0.6, 0, 1.05, 0.4), (0.35, 0, 1.1, 0.42))  # the wool of the belly
    parts += chain((0.4, 0, 1.65, 0.42), (0.85, 0, 1.85, 0.3))  # neck
    parts += [ball((0.98, 0, 1.8), (0.34, 0.3, 0.36)), ball((0.9, 0, 2.1), (0.22, 0.2, 0.22))]
    parts += chain(
        (1.2, 0, 1.65, 0.18), (1.42, 0, 1.25, 0.14), (1.48, 0, 0.8, 0.12), (1.55, 0, 0.45, 0.11),
        (1.74, 0, 0.33, 0.1),
    )  # trunk
    parts += both_sides(
        (1.12, 0.2, 1.5, 0.11), (1.35, 0.4, 1.1, 0.105), (1.65, 0.5, 0.85, 0.1),
        (2.0, 0.46, 0.9, 0.095), (2.22, 0.34, 1.1, 0.09), (2.26, 0.22, 1.35, 0.08),
    )  # tusks
    parts += [ball((0.82, s * 0.33, 1.78), (0.11, 0.07, 0.17)) for s in (-1, 1)]  # ears
    parts += both_sides((-0.72, 0.27, 1.0, 0.25), (-0.78, 0.29, 0.5, 0.18), (-0.74, 0.29, 0.17, 0.18))
    parts += both_sides((0.38, 0.29, 1.1, 0.26), (0.42, 0.31, 0.5, 0.18), (0.42, 0.31, 0.17, 0.18))
    parts += chain((-1.15, 0, 1.4, 0.1), (-1.3, 0, 0.85, 0.09))  # tail
    return _grown(parts, 0.035, 0.08)


def shark():
    parts = chain(
        (-1.45, 0, 1.02, 0.07), (-0.9, 0, 1.0, 0.17), (-0.2, 0, 1.0, 0.31), (0.45, 0, 1.0, 0.34),
        (0.95, 0, 0.98, 0.25), (1.35, 0, 0.98, 0.1), flat=(1, 0.85, 1),
    )
    fin = (1, 0.5, 1)
    parts += chain((0.15, 0, 1.25, 0.22), (-0.05, 0, 1.55, 0.13), (-0.2, 0, 1.72, 0.09), flat=fin)
    parts += chain((-0.85, 0, 1.15, 0.09), (-0.97, 0, 1.25, 0.07), flat=(1, 0.7, 1))
    parts += chain((-1.4, 0, 1.02, 0.1), (-1.62, 0, 1.3, 0.1), (-1.85, 0, 1.62, 0.08), flat=(1, 0.6, 1))
    parts += chain((-1.4, 0, 1.0, 0.1), (-1.58, 0, 0.8, 0.09), (-1.68, 0, 0.62, 0.07), flat=(1, 0.7, 1))
    parts += both_sides(
        (0.5, 0.2, 0.85, 0.2), (0.25, 0.55, 0.72, 0.14), (0.02, 0.85, 0.62, 0.09), flat=(1, 1, 0.55)
    )
    parts += both_sides((-0.6, 0.1, 0.85, 0.1), (-0.78, 0.34, 0.76, 0.07), flat=(1, 1, 0.8))
    return _grown(parts, 0.02, 0.055)


def _deer_leg(x, knee_x, side, top):
    return chain(
        (x, side, top, 0.15), (knee_x, side, 0.62, 0.085), (x - 0.02, side, 0.3, 0.055),
        (x + 0.03, side, 0.05, 0.058),
    )


def deer():
    parts = chain((-0.5, 0, 1.15, 0.23), (0.05, 0, 1.12, 0.22), (0.42, 0, 1.15, 0.25))
    parts += chain((0.5, 0, 1.25, 0.19), (0.72, 0, 1.55, 0.12), (0.85, 0, 1.78, 0.1))  # neck
    parts += chain((0.86, 0, 1.82, 0.11), (1.2, 0, 1.7, 0.055))  # head
    parts += both_sides((0.8, 0.1, 1.88, 0.05), (0.7, 0.27, 1.95, 0.055))  # ears
    for side in (-0.15, 0.15):
        parts += _deer_leg(-0.6, -0.52, side, 1.05) + _deer_leg(0.45, 0.47, side, 1.05)
    parts += chain((-0.72, 0, 1.25, 0.07), (-0.83, 0, 1.12, 0.055))  # tail
    beam = [(0.86, 0.07, 1.92, 0.046), (0.74, 0.26, 2.12, 0.044), (0.72, 0.42, 2.38, 0.042),
            (0.84, 0.48, 2.62, 0.04), (1.0, 0.44, 2.8, 0.036)]
    parts += both_sides(*beam)
    for root, tip in ((1, (0.98, 0.3, 2.22)), (2, (0.98, 0.5, 2.5)), (3, (0.66, 0.56, 2.82))):
        parts += both_sides(beam[root], (*tip, 0.036))
    return _grown(parts, 0.02, 0.048)


def sauropod():
    parts = chain((-0.6, 0, 0.95, 0.36), (0.0, 0, 1.02, 0.42), (0.4, 0, 1.02, 0.34))
    parts += chain(
        (0.5, 0, 1.15, 0.28), (0.85, 0, 1.55, 0.17), (1.15, 0, 2.05, 0.12), (1.45, 0, 2.35, 0.1)
    )
    parts += chain((1.45, 0, 2.38, 0.12), (1.75, 0, 2.3, 0.075))
    parts += chain(
        (-0.75, 0, 0.98, 0.28), (-1.25, 0, 0.85, 0.16), (-1.8, 0, 0.65, 0.1), (-2.4, 0, 0.6, 0.06)
    )
    parts += both_sides((-0.5, 0.25, 0.8, 0.2), (-0.5, 0.28, 0.14, 0.14))
    parts += both_sides((0.35, 0.23, 0.8, 0.18), (0.35, 0.26, 0.13, 0.13))
    return _grown(parts, 0.035, 0.07)


def bird():
    parts = chain((-0.75, 0, 1.0, 0.13), (-0.2, 0, 1.0, 0.25), (0.35, 0, 1.05, 0.23))
    parts += chain((0.45, 0, 1.12, 0.16), (0.65, 0, 1.22, 0.15)) + chain(
        (0.75, 0, 1.2, 0.08), (0.98, 0, 1.14, 0.05)
    )
    wing = (1, 1, 0.32)
    parts += both_sides((0.05, 0.15, 1.1, 0.34), (0.15, 0.75, 1.3, 0.32), flat=wing)
    parts += both_sides((0.12, 0.7, 1.28, 0.32), (-0.15, 1.4, 1.45, 0.24), flat=wing)
    parts += both_sides((-0.12, 1.35, 1.43, 0.24), (-0.5, 1.95, 1.45, 0.24), flat=wing)
    parts += chain((-0.8, 0, 1.0, 0.16), (-1.05, 0, 1.0, 0.3), flat=(1, 1, 0.32))
    return _grown(parts, 0.03, 0.068)


# The horse's bones: (parent, joint, rods). It stands; the gallop turns the joints.
def _horse_leg(name, x, knee, fetlock, side):
    return {
        name: ("body", (x, side, 1.05), chain((x, side, 1.05, 0.15), (*knee, 0.085))),
        name + " shank": (name, knee, chain((*knee, 0.085), (*fetlock, 0.055))),
        name + " hoof": (
            name + " shank",
            fetlock,
            chain((*fetlock, 0.055), (fetlock[0] + 0.05, fetlock[1], 0.06, 0.065)),
        ),
    }


def horse_bones():
    bones = {
        "body": (
            None,
            (0, 0, 1.15),
            chain((-0.58, 0, 1.2, 0.29), (0.0, 0, 1.14, 0.27), (0.5, 0, 1.17, 0.28)),
        ),
        "neck": (
            "body",
            (0.6, 0, 1.3),
            chain((0.6, 0, 1.3, 0.22), (0.85, 0, 1.6, 0.16), (1.02, 0, 1.82, 0.12))
            + chain((0.5, 0, 1.5, 0.06), (0.74, 0, 1.76, 0.06), (0.94, 0, 1.95, 0.06)),  # mane
        ),
        "head": (
            "neck",
            (1.02, 0, 1.85),
            chain((1.02, 0, 1.87, 0.13), (1.25, 0, 1.7, 0.1), (1.42, 0, 1.56, 0.08))
            + both_sides((0.98, 0.06, 1.95, 0.055), (0.99, 0.1, 2.1, 0.045)),
        ),
        "tail": (
            "body",
            (-0.82, 0, 1.32),
            chain((-0.8, 0, 1.32, 0.08), (-1.02, 0, 1.2, 0.09), (-1.15, 0, 0.75, 0.07)),
        ),
    }
    for side, name in ((0.17, "left"), (-0.17, "right")):
        hock, knee = (-0.68, side, 0.58), (0.52, side, 0.6)
        bones |= _horse_leg("hind " + name, -0.6, hock, (-0.62, side, 0.2), side)
        bones |= _horse_leg("fore " + name, 0.5, knee, (0.5, side, 0.2), side)
    return bones


def horse():
    return _grown([rod for _, _, rods in horse_bones().values() for rod in rods], 0.025, 0.056)


def horse_weights(vertices, count=4):
    """(joints V x count, weights V x count): what moves with which bone, by nearness."""
    distance = np.stack([union(rods, 0.01)(vertices) for _, _, rods in horse_bones().values()], 1)
    weight = np.round(np.exp(-(distance - distance.min(1)[:, None]) / 0.035), 6)
    joints = np.argsort(-weight, 1, kind="stable")[:, :count]
    weight = np.take_along_axis(weight, joints, 1)
    weight[weight < 0.01] = 0
    return joints, weight / weight.sum(1)[:, None]


def gallop(phase):
    """Angles [rad] by bone, forwards positive for what hangs down, and the body's rise [m]."""
    turn = 2 * np.pi
    angles = {
        "body": 0.09 * np.sin(turn * phase),
        "neck": 0.14 * np.sin(turn * (phase - 0.4)) - 0.2,
        "head": 0.1 * np.sin(turn * (phase - 0.5)),
        "tail": -0.75 + 0.2 * np.sin(turn * phase),
    }
    for name, delay, reach, fold in (
        ("hind left", 0.0, 0.62, 0.75), ("hind right", 0.1, 0.62, 0.75),
        ("fore left", 0.52, 0.7, 1.35), ("fore right", 0.64, 0.7, 1.35),
    ):
        at = phase - delay
        angles[name] = reach * np.sin(turn * at) + 0.08
        # The shank folds while the leg swings forwards.
        swing = np.maximum(0, np.cos(turn * at))
        angles[name + " shank"] = -fold * swing**1.5 - 0.08
        angles[name + " hoof"] = -0.5 * fold * swing
    return angles, 0.07 * np.sin(turn * (phase + 0.2))
