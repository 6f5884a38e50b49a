#!/usr/bin/env python3
"""Lists the frames of a recording (.xvr) and checks every CRC, by docs/recordings.md alone.

    python3 examples/list_recording.py F.xvr
"""
import struct
import sys


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def require(condition, offset, what):
    if not condition:
        sys.exit(f"byte {offset}: {what}")


def blocks(data):
    """Kind, offset, time and payload of each block."""
    offset = 16
    while offset < len(data):
        header = data[offset:offset + 20]
        require(len(header) == 20, offset, "cut off")
        mark, kind, _, length, time_ns, crc = struct.unpack("<2sccIQI", header)
        require(mark == b"\xb7R" and crc == crc32c(header[:16]), offset, "no block")
        payload = data[offset + 20:offset + 20 + length]
        end = offset + 24 + length
        require(end <= len(data), offset, "cut off")
        require(data[end - 4:end] == struct.pack("<I", crc32c(payload)), offset, "damaged")
        yield kind.decode(), offset, time_ns, payload
        offset = end


def main(path):
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        sys.exit(f"{path}: {error.strerror}")
    require(len(data) >= 16, len(data), "cut off")
    mark, major, minor, crc = struct.unpack("<8sHHI", data[:16])
    require(mark == b"\x89XVR\r\n\x1a\n" and crc == crc32c(data[:12]), 0, "no recording")
    require(major == 1, 8, f"version {major}")
    everything = list(blocks(data))
    require([everything[0][0], everything[-2][0], everything[-1][0]] == ["D", "I", "E"], 16, "not whole")
    require(struct.unpack("<Q", everything[-1][3])[0] == everything[-2][1], everything[-1][1], "no index there")
    entries = b"".join(payload for kind, _, _, payload in everything if kind == "F")
    require(entries == everything[-2][3], everything[-2][1], "not the index of these frames")
    packets = {"<": 0, ">": 0}
    for kind, *_ in everything:
        if kind in packets:
            packets[kind] += 1
    print(f"{packets['>']} packets of the host, {packets['<']} of the device")
    kinds = {offset: kind for kind, offset, _, _ in everything}
    for number, entry in enumerate(struct.iter_unpack("<QQQQII", entries)):
        hello, begin, time_ns, digest, frame, flags = entry
        require(kinds.get(hello) == kinds.get(begin) == ">", hello, "no packet there")
        kind = "keyframe" if flags & 1 else "delta"
        print(f"frame {number}: {kind} {frame}, {time_ns / 1e9:.6f} s, {digest:016x}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    main(sys.argv[1])
