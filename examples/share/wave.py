#!/usr/bin/env python3
"""wave: rings that run outwards, drawn on whatever display `xorvox share` drives. An example of shared frames in Python.

    xorvox share --display cube16-ws2812 --socket /tmp/cube --to tcp:127.0.0.1:7777 &
    python3 examples/share/wave.py /tmp/cube

Usage: wave.py SOCKET [FRAMES]: how many frames, 0 (as without it) for no end. It says how many pixels are lit in the last
frame. docs/share.md has the layouts of the messages and of the segment. Python 3.9 or later.
"""
import math
import mmap
import socket
import struct
import sys
import time

MAGIC, VERSION, PUBLISH = b"XVFRAMES", 1, 1
HELLO = struct.Struct("=8sIIQQQII")  # magic, version, status, segment and frame bytes, digest, pages, format
REQUEST = struct.Struct("=8sIIQQIIQ")  # magic, version, what, frame bytes, digest, page, format, tag
REPLY = struct.Struct("=8sIIII")  # magic, version, status, page, sequence
# magic, version, header, segment, frame and page bytes, digest, pages, format, bits, kind, slices, panels, slice bytes,
# cycle in ns, name
SEGMENT = struct.Struct("=8sIIQQQQIIIIIIQQ32s")
PANEL = struct.Struct("=IIII")  # columns, rows, row bytes, offset in a slice; from 128 on
REFUSED = {1: "another program is drawing on this display", 2: "the server has no memory"}
ROTATING_PANEL = 2
ONE_COLOUR = (1, 7, 8)


class Display:
    """A display that `xorvox share` drives, and a frame for it."""

    def __init__(self, path):
        self.server = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        try:
            self.server.connect(path)
        except OSError as error:
            raise OSError(f"{error.strerror}; start xorvox share first")
        message, passed, _, _ = socket.recv_fds(self.server, HELLO.size, 1)
        if len(message) != HELLO.size:
            raise OSError("no server of shared frames")
        magic, version, status, size, self.frame_bytes, self.digest, _, self.format = HELLO.unpack(message)
        if (magic, version) != (MAGIC, VERSION):
            raise OSError("no server of shared frames, or of another version")
        if status != 0:
            raise OSError(REFUSED.get(status, f"refused: {status}"))
        self.memory = mmap.mmap(passed[0], size)
        socket.close(passed[0])  # The mapping stays.
        fields = SEGMENT.unpack_from(self.memory)
        self.page_begin, self.bits, self.kind, self.slices = fields[2], *fields[9:12]
        self.slice_bytes, self.cycle_s = fields[13], fields[14] * 1e-9
        self.name = fields[15].rstrip(b"\0").decode()
        self.panels = [PANEL.unpack_from(self.memory, 128 + 16 * i) for i in range(fields[12])]
        self.frame = bytearray(self.frame_bytes)

    def put(self, slice_, panel, row, column, code):
        """Sets a pixel that was dark."""
        _, _, row_bytes, offset = self.panels[panel]
        at = slice_ * self.slice_bytes + offset + row * row_bytes + column * self.bits // 8
        bits = code << column * self.bits % 8
        while bits:
            self.frame[at] |= bits & 255
            at, bits = at + 1, bits >> 8

    def publish(self, tag):
        """Puts the frame into page 0 and waits until the server has it."""
        self.memory[self.page_begin : self.page_begin + self.frame_bytes] = bytes(self.frame)
        self.server.send(REQUEST.pack(MAGIC, VERSION, PUBLISH, self.frame_bytes, self.digest, 0, self.format, tag))
        reply = self.server.recv(REPLY.size)
        if len(reply) != REPLY.size:
            raise OSError("the server has ended, or another program draws now")
        if (status := REPLY.unpack(reply)[2]) != 0:
            raise OSError(f"the frame was refused: {status}")


def height_at(radius, seconds):
    """Of the wave, 0 to 1, at a radius of 0 to 1."""
    return 0.5 + 0.3 * math.sin(2 * math.pi * (radius - 0.5 * seconds))


def draw(display, seconds):
    """Draws the wave into the frame; how many pixels are lit."""
    display.frame = bytearray(display.frame_bytes)
    cyan = {2: 0b110, 3: 0b000_111_11, 4: 0b00000_111111_11111, 5: 0xFFFF00, 6: 0b00000_11111_11111}
    code = (1 << display.bits) - 1 if display.format in ONE_COLOUR else cyan[display.format]
    lit = 0
    for panel, (columns, rows, _, _) in enumerate(display.panels):
        half = [max(columns - 1, 1) / 2, max(rows - 1, 1) / 2]
        for column in range(columns):
            x = column / half[0] - 1
            if display.kind == ROTATING_PANEL:  # A slice is an angle, a row a height, from the top.
                row = rows - 1 - int(height_at(abs(x), seconds) * rows)
                for slice_ in range(display.slices):
                    display.put(slice_, panel, row, column, code)
                lit += display.slices
            else:  # Slices lie one above the other.
                for row in range(rows):
                    height = height_at(math.hypot(x, row / half[1] - 1), seconds)
                    display.put(int(height * display.slices), panel, row, column, code)
                lit += rows
    return lit


def main():
    if len(sys.argv) < 2:
        sys.exit("usage: wave.py SOCKET [FRAMES]")
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    lit = number = 0
    try:
        display = Display(sys.argv[1])
        print("drawing on", display.name)
        begun = time.monotonic()
        while count == 0 or number < count:
            lit = draw(display, time.monotonic() - begun)
            display.publish(number)
            number += 1
            # The next frame when the display shows the next one, if drawing is fast enough.
            time.sleep(max(0, begun + number * display.cycle_s - time.monotonic()))
    except OSError as error:
        sys.exit(f"wave.py: {sys.argv[1]}: {error}")
    print(lit, "pixels are lit in the last frame")


if __name__ == "__main__":
    main()
