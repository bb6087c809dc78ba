#!/usr/bin/env python3
"""Cuts tests/data/furnace_excerpt out of a dataset folder with truth: a few seconds, every second frame, every second
pixel. Nothing is filtered or interpolated, so the truth of the original holds for the excerpt.

    tests/data/make_excerpt.py FROM_DIR TO_DIR

Needs nothing but Python. The output is the same byte for byte for the same input and the same zlib.
"""
import os
import re
import struct
import sys
import zlib

BEGIN_S, END_S = 1002.4, 1005.6  # Around the shutter event.
EVERY_FRAME = 2
EVERY_PIXEL = 2
EVERY_SURFACE_POINT = 3
VISIBLE_WITHIN_M = 0.006


def read_png16(path):
    """Rows of a 16-bit grey image without interlace."""
    data = open(path, "rb").read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
            assert (depth, colour, interlace) == (16, 0, 0), path
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    raw, stride = zlib.decompress(packed), 2 * width
    rows, above = [], bytearray(stride)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        line = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left = line[i - 2] if i >= 2 else 0
            up = above[i]
            corner = above[i - 2] if i >= 2 else 0
            if kind == 1:
                line[i] = (line[i] + left) & 255
            elif kind == 2:
                line[i] = (line[i] + up) & 255
            elif kind == 3:
                line[i] = (line[i] + (left + up) // 2) & 255
            elif kind == 4:
                line[i] = (line[i] + paeth(left, up, corner)) & 255
        rows.append(struct.unpack(">%dH" % width, line))
        above = line
    return rows


def paeth(left, up, corner):
    estimate = left + up - corner
    to_left, to_up, to_corner = abs(estimate - left), abs(estimate - up), abs(estimate - corner)
    if to_left <= to_up and to_left <= to_corner:
        return left
    return up if to_up <= to_corner else corner


def write_png16(path, rows):
    width, packed, above = len(rows[0]), b"", bytes(2 * len(rows[0]))
    for row in rows:
        line = struct.pack(">%dH" % width, *row)
        filtered = bytes((line[i] - paeth(line[i - 2] if i >= 2 else 0, above[i],
                                          above[i - 2] if i >= 2 else 0)) & 255 for i in range(len(line)))
        packed += b"\x04" + filtered
        above = line
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n")
        for kind, body in ((b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 16, 0, 0, 0, 0)),
                           (b"IDAT", zlib.compress(packed, 9)), (b"IEND", b"")):
            out.write(struct.pack(">I", len(body)) + kind + body +
                      struct.pack(">I", zlib.crc32(kind + body)))


def lines_of(path):
    return [line.split() for line in open(path) if line.strip() and not line.startswith("#")]


def cut_images(source, target, name):
    """Returns (time, rows) of the images that were kept."""
    os.makedirs(os.path.join(target, name), exist_ok=True)
    kept, listed = [], ["# timestamp filename"]
    inside = [line for line in lines_of(os.path.join(source, name + ".txt"))
              if BEGIN_S <= float(line[0]) <= END_S]
    for time, file in [(line[0], line[1]) for line in inside][::EVERY_FRAME]:
        rows = [row[::EVERY_PIXEL] for row in read_png16(os.path.join(source, file))[::EVERY_PIXEL]]
        write_png16(os.path.join(target, file), rows)
        listed.append("%s %s" % (time, file))
        kept.append((time, rows))
    open(os.path.join(target, name + ".txt"), "w").write("\n".join(listed) + "\n")
    return kept


def cut_times(source, target, name, is_wanted):
    lines = list(open(os.path.join(source, name)))
    body = [line for line in lines if not line.startswith("#") and is_wanted(line.split()[0])]
    open(os.path.join(target, name), "w").writelines([line for line in lines if line.startswith("#")] + body)
    return body


def smaller_rig(text):
    """Pixel i of the excerpt is pixel EVERY_PIXEL * i of the original."""
    size = lambda match: "%s: %d" % (match[1], (int(match[2]) + EVERY_PIXEL - 1) // EVERY_PIXEL)
    scale = lambda match: "%s: %.10g" % (match[1], float(match[2]) / EVERY_PIXEL)
    text = re.sub(r"\b(width|height): (\d+)", size, text)
    return re.sub(r"\b(fx|fy|cx|cy): ([\d.]+)", scale, text)


def in_camera(pose, point):
    """The point in the camera whose pose in the world is `pose` (tx ty tz qx qy qz qw)."""
    tx, ty, tz, qx, qy, qz, qw = pose
    v = (point[0] - tx, point[1] - ty, point[2] - tz)
    x, y, z, w = -qx, -qy, -qz, qw
    ux, uy, uz = y * v[2] - z * v[1] + w * v[0], z * v[0] - x * v[2] + w * v[1], x * v[1] - y * v[0] + w * v[2]
    return (v[0] + 2 * (y * uz - z * uy), v[1] + 2 * (z * ux - x * uz), v[2] + 2 * (x * uy - y * ux))


def cut_surface(source, target, rig, depth, truth):
    """Keeps points that some depth image shows, with the number of images, of every sixth, that do ("seen")."""
    field = lambda name: float(re.search(r"depth\s*{[^}]*\b%s: ([\d.]+)" % name, rig)[1])
    fx, fy, cx, cy = (field(name) for name in ("fx", "fy", "cx", "cy"))
    unit = float(re.search(r"depth_scale: ([\d.]+)", rig)[1])
    poses = {line.split()[0]: [float(v) for v in line.split()[1:]] for line in truth}
    data = open(os.path.join(source, "surface.ply"), "rb").read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    count = int(re.search(rb"element vertex (\d+)", data)[1])
    record = struct.Struct("<7fBHH")
    kept = []
    for i in range(0, count, EVERY_SURFACE_POINT):
        values = record.unpack_from(data, end + i * record.size)
        seen = 0
        for time, rows in depth[::6]:
            x, y, z = in_camera(poses[time], values[:3])
            if z <= 0:
                continue
            u, v = round(fx * x / z + cx), round(fy * y / z + cy)
            if 0 <= v < len(rows) and 0 <= u < len(rows[0]) and abs(rows[v][u] / unit - z) < VISIBLE_WITHIN_M:
                seen += 1
        if seen:
            kept.append(struct.pack("<7fH", *values[:7], seen))
    header = "ply\nformat binary_little_endian 1.0\ncomment true surface, metres; scalar_temperature in degC\n"
    header += "element vertex %d\n" % len(kept)
    header += "".join("property float %s\n" % name for name in "x y z nx ny nz scalar_temperature".split())
    header += "property ushort seen\n"
    open(os.path.join(target, "surface.ply"), "wb").write(header.encode() + b"end_header\n" + b"".join(kept))


def main():
    source, target = sys.argv[1:]
    os.makedirs(target, exist_ok=True)
    rig = smaller_rig(open(os.path.join(source, "rig.textproto")).read())
    open(os.path.join(target, "rig.textproto"), "w").write(rig)
    depth = cut_images(source, target, "depth")
    cut_images(source, target, "thermal")
    cut_times(source, target, "nuc.txt", lambda time: BEGIN_S <= float(time) <= END_S)
    shown = {time for time, _ in depth}
    truth = cut_times(source, target, "groundtruth.txt", lambda time: time in shown)
    cut_surface(source, target, rig, depth, truth)


if __name__ == "__main__":
    main()
