#!/usr/bin/env python3
"""Writes a free block of body-centred cubic cells of equal spheres: bcc.py [CELLS] [RADIUS_UM] > bcc.csv

Neighbours touch along the diagonals of the cells, so that the edge of a cell is 4 r / sqrt(3); it is taken 1e-6
smaller, which makes every touching pair a contact.  One more layer of corners than of centres: the block is symmetric.
"""
import itertools
import math
import sys

cells = int(sys.argv[1]) if len(sys.argv) > 1 else 5
radius = float(sys.argv[2]) if len(sys.argv) > 2 else 22.5
edge = 4 * radius / math.sqrt(3) * (1 - 1e-6)

print(f"# {cells} x {cells} x {cells} BCC cells of copper spheres, lengths in um, written by bcc.py")
print("x,y,z,radius,material")
for shift, count in ((0.0, cells + 1), (0.5, cells)):
    for cell in itertools.product(range(count), repeat=3):
        x, y, z = ((k + shift - cells / 2) * edge for k in cell)
        print(f"{x:.9g},{y:.9g},{z:.9g},{radius:g},Cu")
