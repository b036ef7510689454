#!/usr/bin/env python3
"""Loose lattices that settle into the beds of settled_bed, as LAMMPS and LIGGGHTS read them: lattices.py FOLDER

spheres.data: 20,000 spheres of radius 1 mm over a floor of 40 x 40 mm. cubes.data: 4,000 cubes of 8 touching spheres
(half-edge 1.2 mm) over 45 x 45 mm, turned at random; bodies.dat: their mass and inertia, those of a solid cube."""
import math
import os
import random
import sys

folder = sys.argv[1]
os.makedirs(folder, exist_ok=True)
random.seed(1)
DENSITY = 2650.0


def header(f, what, atoms, width, height):
    # Two types of atoms: LIGGGHTS gives the walls a type, so as to damp contacts with them by the grain's whole mass.
    f.write(f"{what}\n\n{atoms} atoms\n2 atom types\n0 {width} xlo xhi\n0 {width} ylo yhi\n0 {height} zlo zhi\n\nAtoms\n\n")


def speed():
    return " ".join("%.6g" % random.uniform(-0.2, 0.2) for _ in range(3))


def turn():
    """A random rotation, from a quaternion whose direction is uniform."""
    q = [random.gauss(0, 1) for _ in range(4)]
    w, x, y, z = (a / math.hypot(*q) for a in q)
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


count, width, radius, row = 20000, 0.040, 1e-3, 16
pitch = (width - 2.06 * radius) / (row - 1)
with open(f"{folder}/spheres.data", "w") as f:
    header(f, "loose lattice of spheres", count, width, 0.2)
    for i in range(count):
        place = [i % row * pitch + 1.03 * radius, i // row % row * pitch + 1.03 * radius, i // row**2 * 2.3e-3 + 1.5e-3]
        place = [p + random.uniform(-0.12e-3, 0.12e-3) for p in place]
        place[:2] = [min(max(p, 1.01 * radius), width - 1.01 * radius) for p in place[:2]]
        f.write("%d 1 %g %g %.9g %.9g %.9g\n" % (i + 1, 2 * radius, DENSITY, *place))
    f.write("\nVelocities\n\n")
    for i in range(count):
        f.write(f"{i + 1} {speed()} 0 0 0\n")

count, width, radius, row = 4000, 0.045, 0.6e-3, 10
edge = 4 * radius
mass = DENSITY * edge**3
sphere_density = mass / 8 / (4 / 3 * math.pi * radius**3)  # so that eight spheres weigh as much as the cube
pitch = width / row  # more than the diagonal of a cube
corners = [(x * radius, y * radius, z * radius) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
speeds = [speed() for _ in range(count)]
with open(f"{folder}/cubes.data", "w") as f, open(f"{folder}/bodies.dat", "w") as bodies:
    header(f, "loose lattice of cubes", 8 * count, width, pitch * (count / row**2 + 1))
    bodies.write(f"{count}\n")
    for i in range(count):
        centre = [(k + 0.5) * pitch for k in (i % row, i // row % row, i // row**2)]
        rotation = turn()
        for k, corner in enumerate(corners):
            place = [centre[a] + sum(rotation[a][b] * corner[b] for b in range(3)) for a in range(3)]
            f.write("%d 1 %g %.9g %.9g %.9g %.9g\n" % (8 * i + k + 1, 2 * radius, sphere_density, *place))
        inertia = mass * edge**2 / 6
        bodies.write("%d %.9g %.9g %.9g %.9g %.9g %.9g %.9g 0 0 0 %s 0 0 0 0 0 0\n"
                     % (i + 1, mass, *centre, inertia, inertia, inertia, speeds[i]))
    f.write("\nVelocities\n\n")
    for i in range(8 * count):
        f.write(f"{i + 1} {speeds[i // 8]} 0 0 0\n")
    f.write("\nMolecules\n\n")
    for i in range(8 * count):
        f.write(f"{i + 1} {i // 8 + 1}\n")
