#!/usr/bin/env python3
"""Makes the small volumes and the picture of docs/color.md, in this folder. Usage: examples/make_textures.py"""
import colorsys
import gzip
import math
import os
import struct
import zlib

FOLDER = os.path.dirname(os.path.abspath(__file__))


def write_nrrd(name, side, channels, data):
    header = ["NRRD0004", "type: uint8", f"dimension: {4 if channels > 1 else 3}",
              "sizes: " + " ".join(map(str, ([channels] if channels > 1 else []) + [side] * 3)),
              "encoding: gzip"]
    if channels > 1:
        header.insert(4, "kinds: RGB-color domain domain domain")
    with open(os.path.join(FOLDER, name), "wb") as file:
        file.write("\n".join(header).encode() + b"\n\n" + gzip.compress(bytes(data), 9, mtime=0))


def write_png(name, width, height, rows):
    def chunk(kind, content):
        return (struct.pack(">I", len(content)) + kind + content +
                struct.pack(">I", zlib.crc32(kind + content)))
    with open(os.path.join(FOLDER, name), "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(b"".join(b"\0" + bytes(row) for row in rows), 9)) + chunk(b"IEND", b""))


def voxels(side):
    for k in range(side):
        for j in range(side):
            for i in range(side):
                yield tuple((n + 0.5) / side - 0.5 for n in (i, j, k))


def swirl(x, y, z):
    return round(127.5 + 127.5 * math.sin(3 * math.atan2(y, x) + 14 * z))


def hues(x, y, z):
    turn = math.atan2(y, x) / (2 * math.pi) % 1
    return [round(255 * c) for c in colorsys.hsv_to_rgb(turn, min(1, 3 * math.hypot(x, y)), 1)]


CENTERS = [(math.cos(2.4 * n) * 0.35, math.sin(2.4 * n) * 0.35, (n + 0.5) / 12 - 0.5) for n in range(12)]


def cell(*place):
    return 1 + min(range(len(CENTERS)), key=lambda n: math.dist(place, CENTERS[n]))


def globe(u, v):
    """Seas and lands of no world, and ice at its poles."""
    east, north = 2 * math.pi * u, math.pi * (0.5 - v)
    x, y, z = math.cos(north) * math.cos(east), math.cos(north) * math.sin(east), math.sin(north)
    height = math.sin(3 * x + 1) + math.sin(4 * y + 2 * z) + math.sin(5 * z - 2 * x)
    if abs(z) > 0.88:
        return (240, 245, 255)
    return (60, 170, 50) if height > 0.5 else (220, 180, 80) if height > 0.2 else (20, 70, 200)


write_nrrd("swirl.nrrd", 24, 1, [swirl(*p) for p in voxels(24)])
write_nrrd("hues.nrrd", 12, 3, [code for p in voxels(12) for code in hues(*p)])
write_nrrd("cells.nrrd", 24, 1, [cell(*p) for p in voxels(24)])
write_png("globe.png", 128, 64, [[c for i in range(128) for c in globe((i + 0.5) / 128, (j + 0.5) / 64)] for j in range(64)])
