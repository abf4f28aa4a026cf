# SPDX-FileCopyrightText: 2026 the flocklift authors
# SPDX-License-Identifier: BSD-3-Clause
"""Solid shapes as implicit functions, and their surfaces as triangles.

f(p) < 0 inside, about the distance [m] near the surface. The surface is found by surface nets
(one vertex a cell that the surface passes, one quadrangle an edge that it cuts; Gibson 1998), then
pulled onto f = 0.
"""

import numpy as np


def cone(a, b, radius_a, radius_b, flat=(1, 1, 1)):
    """A rod from a to b with a radius at each end; `flat` squeezes its section along the axes."""
    a, b, flat = (np.asarray(v, float) for v in (a, b, flat))

    def distance(p):
        axis = b - a
        share = np.clip((p - a) @ axis / max(axis @ axis, 1e-12), 0, 1)
        offset = (p - a - share[:, None] * axis) / flat
        return (np.sqrt((offset**2).sum(1)) - (radius_a + share * (radius_b - radius_a))) * flat.min()

    return distance


def chain(*stations, flat=(1, 1, 1)):
    """Rods through stations (x, y, z, radius)."""
    return [
        cone(s[:3], t[:3], s[3], t[3], flat) for s, t in zip(stations, stations[1:], strict=False)
    ]


def both_sides(*stations, flat=(1, 1, 1)):
    """A chain, and its mirror image at y = 0."""
    mirrored = [(x, -y, z, r) for x, y, z, r in stations]
    return chain(*stations, flat=flat) + chain(*mirrored, flat=flat)


def ball(center, radii):
    center, radii = np.asarray(center, float), np.asarray(radii, float)

    def distance(p):
        scaled = np.sqrt((((p - center) / radii) ** 2).sum(1))
        slope = np.sqrt((((p - center) / radii**2) ** 2).sum(1))
        return scaled * (scaled - 1) / np.maximum(slope, 1e-9)

    return distance


def union(parts, blend):
    """Parts grown together over about `blend` [m]."""

    def distance(p):
        values = np.stack([part(p) for part in parts])
        least = values.min(0)
        return least - blend * np.log(np.exp((least - values) / blend).sum(0))

    return distance


def _gradient(f, p, step):
    shift = np.eye(3) * step
    return np.stack([f(p + s) - f(p - s) for s in shift], 1) / (2 * step)


def _pull_onto(f, p, cell, rounds=4):
    for _ in range(rounds):
        gradient = _gradient(f, p, cell / 10)
        way = f(p)[:, None] * gradient / np.maximum((gradient**2).sum(1), 0.05)[:, None]
        p = p - np.clip(way, -cell / 4, cell / 4)
    return p


def _fill_pinches(value, depth):
    """Fills the sides of cells of which only two corners in a diagonal lie inside: four sheets would
    meet there."""
    found = True
    while found:
        found = False
        for axis in range(3):
            v = np.moveaxis(value, axis, 0)  # a view
            corners = [v[:, :-1, :-1], v[:, 1:, :-1], v[:, :-1, 1:], v[:, 1:, 1:]]
            a, b, c, d = (corner < 0 for corner in corners)
            pinch = (a == d) & (b == c) & (a != b)
            found = found or pinch.any()
            for corner in corners:
                corner[pinch & (corner >= 0)] = depth


def surface(f, low, high, cell):
    """(vertices V x 3, triangles T x 3) of f = 0 inside the box; outwards is counter-clockwise."""
    axes = [np.arange(l, h + cell, cell) for l, h in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
    shape = points.shape[:3]
    value = f(points.reshape(-1, 3)).reshape(shape)
    _fill_pinches(value, -0.02 * cell)
    inside = value < 0
    assert not (inside[[0, -1]].any() or inside[:, [0, -1]].any() or inside[:, :, [0, -1]].any())

    cells = tuple(n - 1 for n in shape)
    corner = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]

    def at(array, c):
        return array[c[0] : c[0] + cells[0], c[1] : c[1] + cells[1], c[2] : c[2] + cells[2]]

    sums, counts = np.zeros((*cells, 3)), np.zeros(cells)
    for a in corner:
        for b in corner:
            if b <= a or sum(x != y for x, y in zip(a, b, strict=True)) != 1:
                continue
            cut = at(inside, a) != at(inside, b)
            share = np.where(cut, at(value, a) / np.where(cut, at(value, a) - at(value, b), 1), 0)
            place = at(points, a) + share[..., None] * (at(points, b) - at(points, a))
            sums += np.where(cut[..., None], place, 0)
            counts += cut
    active = counts > 0
    number = np.full(cells, -1)
    number[active] = np.arange(active.sum())
    vertices = sums[active] / counts[active][:, None]

    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        first, second = inside.take(range(shape[axis] - 1), axis), inside.take(
            range(1, shape[axis]), axis
        )
        for outwards, cut in ((True, first & ~second), (False, ~first & second)):
            base = np.argwhere(cut)
            around = []
            for du, dv in ((-1, -1), (0, -1), (0, 0), (-1, 0)):
                index = base.copy()
                index[:, u] += du
                index[:, v] += dv
                around.append(number[tuple(index.T)])
            quads.append(np.stack(around if outwards else around[::-1], 1))
    quads = np.concatenate(quads)
    vertices = _relax(f, vertices, quads, cell)
    p = vertices[quads]
    # Where both diagonals are as long, rounding must not choose.
    short = ((p[:, 0] - p[:, 2]) ** 2).sum(1) <= ((p[:, 1] - p[:, 3]) ** 2).sum(1) + 1e-9
    one = np.where(short[:, None], quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    two = np.where(short[:, None], quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    return vertices, np.concatenate([one, two])


def _relax(f, vertices, quads, cell):
    """Evens the vertices out along the surface, and pulls them onto it."""
    for _ in range(3):
        sums, counts = np.zeros_like(vertices), np.zeros(len(vertices))
        for k in range(4):
            np.add.at(sums, quads[:, k], vertices[quads[:, (k + 1) % 4]])
            np.add.at(sums, quads[:, k], vertices[quads[:, (k + 3) % 4]])
            np.add.at(counts, quads[:, k], 2)
        vertices = _pull_onto(f, 0.5 * vertices + 0.5 * sums / counts[:, None], cell)
    return vertices
