#!/usr/bin/env python3
"""Makes the small volumes, the picture and the model of docs/color.md and docs/play.md, in this folder.
Usage: examples/make_textures.py"""
import colorsys
import gzip
import json
import math
import os
import struct
import zlib

FOLDER = os.path.dirname(os.path.abspath(__file__))


def write_nrrd(name, side, channels, data, content=None):
    header = ["NRRD0004", *([f"content: {content}"] if content else []), "type: uint8", f"dimension: {4 if channels > 1 else 3}",
              "sizes: " + " ".join(map(str, ([channels] if channels > 1 else []) + [side] * 3)),
              "encoding: gzip"]
    if channels > 1:
        header.insert(-1, "kinds: RGB-color domain domain domain")
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


def ball(radius, columns, rows):
    """A sphere, y up: positions, texture coordinates, corners of triangles."""
    places, texcoords, corners = [], [], []
    for j in range(rows + 1):
        north = math.pi * (0.5 - j / rows)
        for i in range(columns + 1):
            east = 2 * math.pi * (i % columns) / columns
            flat = radius * math.cos(north) if 0 < j < rows else 0.0
            places.append((flat * math.cos(east), radius * math.sin(north), -flat * math.sin(east)))
            texcoords.append((i / columns, j / rows))
    for j in range(rows):
        for i in range(columns):
            a, b = j * (columns + 1) + i, (j + 1) * (columns + 1) + i
            corners += ([a, b, b + 1] if j < rows - 1 else []) + ([a, b + 1, a + 1] if j > 0 else [])
    return places, texcoords, corners


def write_planet(name):
    """A ball with the globe's picture, and a moon that goes round it in 8 s."""
    binary, views, accessors = b"", [], []

    def add(data, **accessor):
        nonlocal binary
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data + bytes(-len(data) % 4)
        if accessor:
            accessors.append({"bufferView": len(views) - 1, **accessor})
        return len(accessors) - 1

    def add_floats(kind, values):
        flat = [f for value in values for f in value]
        bounds = {"min": [min(c) for c in zip(*values)], "max": [max(c) for c in zip(*values)]}
        return add(struct.pack(f"<{len(flat)}f", *flat), componentType=5126, count=len(values), type=kind, **bounds)

    def primitive(radius, columns, rows, material):
        places, texcoords, corners = ball(radius, columns, rows)
        indices = add(struct.pack(f"<{len(corners)}H", *corners), componentType=5123, count=len(corners), type="SCALAR")
        return {"attributes": {"POSITION": add_floats("VEC3", places), "TEXCOORD_0": add_floats("VEC2", texcoords)},
                "indices": indices, "material": material}

    meshes = [{"primitives": [primitive(1.0, 32, 16, 0)]}, {"primitives": [primitive(0.28, 16, 8, 1)]}]
    times = add_floats("SCALAR", [(0.0,), (2.0,), (4.0,), (6.0,), (8.0,)])
    turn = add_floats("VEC4", [(0.0, math.sin(n * math.pi / 4), 0.0, math.cos(n * math.pi / 4)) for n in range(5)])
    with open(os.path.join(FOLDER, "globe.png"), "rb") as file:
        add(file.read())
    gltf = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"children": [2]}, {"mesh": 1, "translation": [1.6, 0.0, 0.0]}],
        "meshes": meshes,
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
                      {"pbrMetallicRoughness": {"baseColorFactor": [1.0, 0.75, 0.3, 1.0]}}],
        "textures": [{"source": 0}], "images": [{"bufferView": len(views) - 1, "mimeType": "image/png"}],
        "animations": [{"name": "orbit", "samplers": [{"input": times, "output": turn}],
                        "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}],
        "buffers": [{"byteLength": len(binary)}], "bufferViews": views, "accessors": accessors}
    text = json.dumps(gltf, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(os.path.join(FOLDER, name), "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) +
                   struct.pack("<I4s", len(text), b"JSON") + text +
                   struct.pack("<I4s", len(binary), b"BIN\0") + binary)


write_nrrd("swirl.nrrd", 24, 1, [swirl(*p) for p in voxels(24)])
write_nrrd("hues.nrrd", 12, 3, [code for p in voxels(12) for code in hues(*p)])
write_nrrd("cells.nrrd", 24, 1, [cell(*p) for p in voxels(24)], "labels")
write_png("globe.png", 128, 64, [[c for i in range(128) for c in globe((i + 0.5) / 128, (j + 0.5) / 64)] for j in range(64)])
write_planet("planet.glb")
