# SPDX-FileCopyrightText: 2026 the flocklift authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces from outlines: extruded polygons with holes, revolved and swept profiles."""

import numpy as np


def ring(points, clockwise=False):
    """A closed outline as an array, counter-clockwise (or clockwise: a hole); rounded, so that the
    last bits of sines do not decide where it is cut into triangles."""
    p = np.round(np.asarray(points, float), 9)
    area = (p[:, 0] * np.roll(p[:, 1], -1) - np.roll(p[:, 0], -1) * p[:, 1]).sum()
    return p[::-1] if (area < 0) != clockwise else p


def stroke(path, width):
    """The outline of a pen of this width that follows a path (mitred)."""
    p = np.asarray(path, float)
    along = np.gradient(p, axis=0)
    along[1:-1] = _bisector(p)
    normal = np.stack([-along[:, 1], along[:, 0]], 1)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    segment = np.diff(p, axis=0)
    segment = np.stack([-segment[:, 1], segment[:, 0]], 1)
    segment /= np.linalg.norm(segment, axis=1)[:, None]
    miter = np.ones(len(p))
    miter[1:-1] = 1 / np.maximum((normal[1:-1] * segment[1:]).sum(1), 0.5)
    offset = normal * (miter * width / 2)[:, None]
    return ring(np.concatenate([p + offset, (p - offset)[::-1]]))


def _bisector(p):
    unit = np.diff(p, axis=0)
    unit /= np.linalg.norm(unit, axis=1)[:, None]
    return unit[:-1] + unit[1:]


def arc(center, radii, start_deg, end_deg, count):
    angle = np.radians(np.linspace(start_deg, end_deg, count))
    return np.stack([center[0] + radii[0] * np.cos(angle), center[1] + radii[1] * np.sin(angle)], 1)


def _cross(o, a, b):
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def _bridge(points, outer, hole):
    """Joins a hole to the loop of indices `outer`, at the first pair of corners that see each other."""
    edges = list(zip(outer, outer[1:] + outer[:1], strict=True))
    edges += list(zip(hole, hole[1:] + hole[:1], strict=True))

    def crosses(a, b, c, d):
        if len({a, b, c, d}) < 4:
            return False
        p, q, r, s = (points[k] for k in (a, b, c, d))
        return _cross(p, q, r) * _cross(p, q, s) < 0 and _cross(r, s, p) * _cross(r, s, q) < 0

    pairs = sorted(
        (round(float(((points[o] - points[h]) ** 2).sum()), 9), i, j)
        for i, o in enumerate(outer)
        for j, h in enumerate(hole)
    )
    for _, i, j in pairs:
        if not any(crosses(outer[i], hole[j], a, b) for a, b in edges):
            return outer[: i + 1] + hole[j:] + hole[: j + 1] + outer[i:]
    raise ValueError("the hole lies outside")


def fill(points, outer, holes):
    """Triangles of a polygon with holes, by clipping ears; indices of points."""
    loop = list(outer)
    for hole in holes:
        loop = _bridge(points, loop, list(hole))
    triangles = []
    while len(loop) > 3:
        best = None
        for k in range(len(loop)):
            a, b, c = loop[k - 1], loop[k], loop[(k + 1) % len(loop)]
            area = _cross(points[a], points[b], points[c])
            if area <= 1e-12:
                continue
            blocked = any(
                q not in (a, b, c)
                and min(
                    _cross(points[a], points[b], points[q]),
                    _cross(points[b], points[c], points[q]),
                    _cross(points[c], points[a], points[q]),
                )
                >= 0
                for q in loop
            )
            longest = max(((points[i] - points[j]) ** 2).sum() for i, j in ((a, b), (b, c), (c, a)))
            if not blocked and (best is None or area / longest > best[0] + 1e-9):
                best = (area / longest, k)
        k = best[1]
        triangles.append([loop[k - 1], loop[k], loop[(k + 1) % len(loop)]])
        del loop[k]
    triangles.append(loop)
    return triangles


def extrude(outer, holes, depth):
    """A polygon in the plane (x, z), made solid from y = -depth/2 to depth/2."""
    loops = [ring(outer)] + [ring(h, clockwise=True) for h in holes]
    flat = np.concatenate(loops)
    starts = np.cumsum([0] + [len(loop) for loop in loops])
    indices = [list(range(a, b)) for a, b in zip(starts, starts[1:], strict=False)]
    faces = fill(flat, indices[0], indices[1:])
    n = len(flat)
    front = np.stack([flat[:, 0], np.full(n, -depth / 2), flat[:, 1]], 1)
    back = front + [0, depth, 0]
    triangles = [list(t) for t in faces] + [[n + a, n + c, n + b] for a, b, c in faces]
    for loop in indices:
        for a, b in zip(loop, loop[1:] + loop[:1], strict=True):
            triangles += [[a, n + a, n + b], [a, n + b, b]]
    return np.concatenate([front, back]), np.array(triangles)


def sweep(rings, start, end):
    """Closed rings of equal length one after the other, the ends drawn together in two points."""
    count, m = len(rings), len(rings[0])
    vertices = np.concatenate([np.reshape(start, (1, 3)), *rings, np.reshape(end, (1, 3))])
    triangles = []
    for j in range(m):
        k = (j + 1) % m
        triangles.append([0, 1 + k, 1 + j])
        for i in range(count - 1):
            a, b = 1 + i * m, 1 + (i + 1) * m
            triangles += [[a + j, a + k, b + k], [a + j, b + k, b + j]]
        a = 1 + (count - 1) * m
        triangles.append([a + j, a + k, 1 + count * m])
    return vertices, np.array(triangles)


def revolve(profile, m=32):
    """Stations (radius, z), or (radius x, radius y, z), upwards; the first and last lie on the axis."""
    rows = [(s[0], s[0], s[1]) if len(s) == 2 else s for s in profile]
    angle = 2 * np.pi * np.arange(m) / m
    rings = [
        np.stack([rx * np.cos(angle), ry * np.sin(angle), np.full(m, z)], 1)
        for rx, ry, z in rows[1:-1]
    ]
    return sweep(rings, (0, 0, rows[0][2]), (0, 0, rows[-1][2]))


def box(low, high):
    x, y = (low[0], high[0]), (low[1], high[1])
    outline = [(x[0], low[2]), (x[1], low[2]), (x[1], high[2]), (x[0], high[2])]
    vertices, triangles = extrude(outline, [], y[1] - y[0])
    return vertices + [0, (y[0] + y[1]) / 2, 0], triangles


def together(*solids):
    """Solids that do not touch, as one mesh."""
    vertices, triangles, first = [], [], 0
    for v, t in solids:
        vertices.append(v)
        triangles.append(np.asarray(t) + first)
        first += len(v)
    return np.concatenate(vertices), np.concatenate(triangles)


def refine(vertices, triangles, longest):
    """Halves edges until none is longer."""
    vertices, triangles = [tuple(v) for v in vertices], [tuple(t) for t in triangles]
    while True:
        middle, done, result = {}, True, []

        def halved(a, b):
            nonlocal done
            edge = (min(a, b), max(a, b))
            if edge not in middle:
                p, q = np.array(vertices[edge[0]]), np.array(vertices[edge[1]])
                if ((p - q) ** 2).sum() <= longest**2:
                    return None
                done = False
                middle[edge] = len(vertices)
                vertices.append(tuple((p + q) / 2))
            return middle[edge]

        for a, b, c in triangles:
            ab, bc, ca = halved(a, b), halved(b, c), halved(c, a)
            while (ab is None) and (bc is not None or ca is not None):  # a halved edge comes first
                a, b, c, ab, bc, ca = b, c, a, bc, ca, ab
            if ab is None:
                result.append((a, b, c))
            elif bc is None and ca is None:
                result += [(a, ab, c), (ab, b, c)]
            elif bc is not None and ca is not None:
                result += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
            elif bc is not None:
                result += [(ab, b, bc), (a, ab, c), (ab, bc, c)]
            else:
                result += [(a, ab, ca), (ab, b, c), (ab, c, ca)]
        triangles = result
        if done:
            return np.array(vertices), np.array(triangles)
