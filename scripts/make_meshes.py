#!/usr/bin/python3
"""Writes the meshes of the demos and tests into a folder (default: meshes/ of this package).

Everything is computed from formulas: no input, no random number, the same bytes at each run. Lengths in metres.
Needs Python 3.8 and numpy.

    liver.obj     organ lying on its visceral side: x to the patient's left, y to the back, z up; box centred at 0
    block.obj     0.1 x 0.04 x 0.04 box, x in [0, 0.1], y and z in [0, 0.04]
    cylinder.obj  radius 0.03, length 0.1 along y, centred
    sphere.obj    radius 0.05, centred
    scalpel.stl   for display only: cutting edge on the z axis from 0 to 0.03, blade in the x-z plane, handle above
"""

import argparse
import os
import struct

import numpy as np


def geodesic_sphere(frequency):
    """Unit sphere of 20 * frequency^2 triangles: vertices (n, 3) and counter-clockwise triangles (m, 3)."""
    phi = (1 + 5**0.5) / 2
    corners = np.array([(s, t * phi, 0) for s in (-1, 1) for t in (-1, 1)], dtype=float)
    corners = np.vstack([corners, corners[:, [2, 0, 1]], corners[:, [1, 2, 0]]])
    distance = np.linalg.norm(corners[:, None] - corners[None], axis=2)
    faces = [(i, j, k) for i in range(12) for j in range(i + 1, 12) for k in range(j + 1, 12)
             if max(distance[i, j], distance[j, k], distance[k, i]) < 2.1]
    index, vertices, triangles = {}, [], []

    def vertex(face, weights):
        # Shared along sides of the icosahedron: the key lists the corners that matter.
        key = tuple(sorted((c, w) for c, w in zip(face, weights) if w > 0))
        if key not in index:
            index[key] = len(vertices)
            point = sum(w * corners[c] for c, w in key)
            vertices.append(point / np.linalg.norm(point))
        return index[key]

    for i, j, k in faces:
        if np.dot(np.cross(corners[j] - corners[i], corners[k] - corners[i]), corners[i]) < 0:
            j, k = k, j
        for a in range(frequency):
            for b in range(frequency - a):
                def at(p, q, face=(i, j, k)):
                    return vertex(face, (frequency - p - q, p, q))
                triangles.append((at(a, b), at(a + 1, b), at(a, b + 1)))
                if a + b < frequency - 1:
                    triangles.append((at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)))
    return np.array(vertices), np.array(triangles)


def smooth_step(x, low, high):
    """0 below `low`, 1 above `high`, with continuous second derivative."""
    t = np.clip((x - low) / (high - low), 0, 1)
    return t**3 * (t * (6 * t - 15) + 10)


def bump(x, centre, width):
    """Gaussian of height 1."""
    return np.exp(-((x - centre) / width)**2)


def liver_surface(sphere):
    """Maps the unit sphere (n, 3) onto the liver (n, 3), m.

    The sphere's u = x runs from the right to the left lobe, v = y from the inferior margin to the back, and w = z from
    the visceral to the diaphragmatic side.
    """
    u, v, w = sphere.T
    left = smooth_step(u, -0.35, 0.95)  # 0 in the right lobe, 1 at the tip of the left

    # Outline. The right lobe is deep; the left tapers. The inferior margin recedes from right to left and is notched at
    # the round ligament and, less, at the gallbladder; the inferior vena cava leaves a bay at the back.
    x = 0.1 * u
    depth = 0.071 * (1 - 0.45 * left) * (1 - 0.12 * bump(u, -0.95, 0.4))
    centre = 0.016 * left - 0.010 * bump(u, -0.55, 0.5)
    front = smooth_step(-v, 0.15, 1.0)
    back = smooth_step(v, 0.25, 1.0)
    y = centre + depth * v
    y = y + front * (0.0095 * bump(u, 0.30, 0.095) + 0.0055 * bump(u, -0.12, 0.13))
    y = y - back * 0.009 * bump(u, 0.12, 0.14)

    # Middle sheet: the dome of the diaphragm over the right lobe, a flatter one over the left, margins hanging down.
    mid = 0.015 * bump(u, -0.42, 0.62) * bump(v, 0.12, 0.85) + 0.009 * bump(u, 0.55, 0.45) * bump(v, 0.0, 0.9)

    # Half thickness: most at the back of the right lobe; thin towards the inferior margin and to the left.
    half = 0.0335 * (1 - 0.58 * left) * (1 - 0.36 * smooth_step(-v, -0.35, 1.0)) * (1 - 0.12 * bump(u, -1.0, 0.35))

    # An ellipse would end in a knife edge where the organ is thin: rounder towards the margin.
    z = mid + half * w * (1 + 0.35 * (1 - w**2))

    # Visceral side only: impressions push the underside up, the caudate lobe bulges down.
    under = smooth_step(-w, 0.05, 0.75)
    fossa = bump(u + 0.10 * v, -0.12, 0.105) * smooth_step(-v, -0.15, 0.35)          # gallbladder
    porta = bump(v, 0.13, 0.11) * bump(u, 0.08, 0.24)                                 # porta hepatis
    ligament = bump(u - 0.05 * v, 0.30, 0.065) * smooth_step(-v, -0.20, 0.20)        # fissure of the round ligament
    kidney = bump(u, -0.55, 0.26) * bump(v, 0.35, 0.36)
    colon = bump(u, -0.62, 0.26) * bump(v, -0.45, 0.28)
    stomach = bump(u, 0.62, 0.24) * bump(v, -0.05, 0.60)
    caudate = bump(u, 0.20, 0.12) * bump(v, 0.52, 0.20)
    cava = bump(u, 0.02, 0.085) * smooth_step(v, 0.35, 0.75)
    z = z + under * (0.0095 * fossa + 0.0080 * porta + 0.0050 * ligament + 0.0060 * kidney + 0.0030 * colon +
                     0.0040 * stomach - 0.0050 * caudate + 0.0070 * cava)
    # Diaphragmatic side: the line of the falciform ligament.
    z = z - smooth_step(w, 0.05, 0.6) * 0.0014 * bump(u, 0.30, 0.06)
    return np.column_stack([x, y, z])


def even_out(sphere, triangles, surface, rounds):
    """Moves the points over the sphere until the edges on `surface` are about equally long."""
    sides = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    i, j = np.unique(np.sort(sides, axis=1), axis=0).T
    for _ in range(rounds):
        p = surface(sphere)
        length = np.linalg.norm(p[i] - p[j], axis=1)  # a long edge pulls more
        total = np.zeros_like(sphere)
        weight = np.zeros(len(sphere))
        for a, b in ((i, j), (j, i)):
            for axis in range(3):
                total[:, axis] += np.bincount(a, length * sphere[b, axis], len(sphere))
            weight += np.bincount(a, length, len(sphere))
        sphere = 0.5 * sphere + 0.5 * total / weight[:, None]
        sphere /= np.linalg.norm(sphere, axis=1)[:, None]
    return sphere


def liver():
    sphere, triangles = geodesic_sphere(30)
    vertices = liver_surface(even_out(sphere, triangles, liver_surface, 300))
    return vertices - 0.5 * (vertices.min(axis=0) + vertices.max(axis=0)), triangles


def block():
    x, y, z = 0.1, 0.04, 0.04
    vertices = np.array([(i * x, j * y, k * z) for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def loft(rings):
    """Closed surface through rings (k, n, 3), counter-clockwise seen from the far end, with a fan at either end."""
    k, n, _ = rings.shape
    vertices = np.vstack([rings.reshape(-1, 3), rings[0].mean(axis=0), rings[-1].mean(axis=0)])
    triangles = []
    for i in range(n):
        j = (i + 1) % n
        triangles.append((k * n, j, i))
        triangles.append((k * n + 1, (k - 1) * n + i, (k - 1) * n + j))
        for r in range(k - 1):
            a, b = r * n, (r + 1) * n
            triangles += [(a + i, a + j, b + j), (a + i, b + j, b + i)]
    return vertices, np.array(triangles)


def cylinder():
    angle = 2 * np.pi * np.arange(96) / 96
    circle = 0.03 * np.column_stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)])
    return loft(np.array([circle + (0, y, 0) for y in np.linspace(-0.05, 0.05, 21)]))


def sphere_mesh():
    vertices, triangles = geodesic_sphere(16)
    return 0.05 * vertices, triangles


def scalpel():
    def section(z, x_low, x_high, y_edge, y_body):
        # Hexagon: the cutting edge at x_low of thickness y_edge, the body beyond the bevel.
        bevel = x_low + 0.35 * (x_high - x_low)
        return [(x_low, -y_edge, z), (bevel, -y_body, z), (x_high, -y_body, z),
                (x_high, y_body, z), (bevel, y_body, z), (x_low, y_edge, z)]

    blade = [section(0.0002, 0, 0.0004, 1e-5, 0.00005), section(0.006, 0, 0.0034, 1e-5, 0.0002),
             section(0.013, 0, 0.0057, 1e-5, 0.00025), section(0.021, 0, 0.0066, 1e-5, 0.00025),
             section(0.030, 0, 0.0066, 1e-5, 0.00025), section(0.034, 0.0012, 0.0062, 0.00025, 0.00025),
             section(0.040, 0.0014, 0.0060, 0.00025, 0.00025)]
    angle = 2 * np.pi * np.arange(32) / 32
    handle = []
    for z, width, thick in ((0.0345, 0.0014, 0.0008), (0.0355, 0.0021, 0.0012), (0.046, 0.0026, 0.0014),
                            (0.056, 0.0042, 0.0019), (0.075, 0.0049, 0.0021), (0.110, 0.0046, 0.0020),
                            (0.145, 0.0050, 0.0020), (0.1535, 0.0047, 0.0019), (0.157, 0.0036, 0.0016),
                            (0.1585, 0.0018, 0.0010)):
        # A rounded rectangle: |x / width|^4 + |y / thick|^4 = 1.
        c, s = np.cos(angle), np.sin(angle)
        radius = (c**4 + s**4)**-0.25
        handle.append(np.column_stack([0.0036 + width * radius * c, thick * radius * s, np.full_like(c, z)]))
    v0, t0 = loft(np.array(blade))
    v1, t1 = loft(np.array(handle))
    return np.vstack([v0, v1]), np.vstack([t0, t1 + len(v0)])


def write_obj(path, mesh, comment, digits=6):
    vertices, triangles = mesh
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write("# {}; metres; written by scripts/make_meshes.py\n".format(comment))
        for p in np.round(vertices, digits) + 0.0:  # + 0.0: no negative zero
            file.write("v " + " ".join("{:.{}f}".format(c, digits).rstrip("0").rstrip(".") for c in p) + "\n")
        for t in triangles + 1:
            file.write("f {} {} {}\n".format(*t))


def write_stl(path, mesh):
    vertices, triangles = mesh
    corners = np.round(vertices, 7)[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    with open(path, "wb") as file:
        file.write(b"metres; written by scripts/make_meshes.py".ljust(80))
        file.write(struct.pack("<I", len(triangles)))
        for normal, triangle in zip(normals, corners):
            file.write(struct.pack("<12fH", *normal, *triangle.ravel(), 0))


def volume(mesh):
    vertices, triangles = mesh
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", default=os.path.join(here, os.pardir, "meshes"))
    folder = parser.parse_args().folder
    os.makedirs(folder, exist_ok=True)
    for name, mesh, comment, digits in (("liver", liver(), "a liver on its visceral side, x left, y back, z up", 5),
                                        ("block", block(), "a block of 0.1 x 0.04 x 0.04", 6),
                                        ("cylinder", cylinder(), "a cylinder of radius 0.03 and length 0.1 along y", 6),
                                        ("sphere", sphere_mesh(), "a sphere of radius 0.05", 6)):
        write_obj(os.path.join(folder, name + ".obj"), mesh, comment, digits)
        print("{}.obj: {} vertices, {} triangles, size {} m, volume {:.4g} m3".format(
            name, len(mesh[0]), len(mesh[1]), np.ptp(mesh[0], axis=0).round(4), volume(mesh)))
    blade = scalpel()
    write_stl(os.path.join(folder, "scalpel.stl"), blade)
    print("scalpel.stl: {} triangles, size {} m".format(len(blade[1]), np.ptp(blade[0], axis=0).round(4)))


if __name__ == "__main__":
    main()
