"""Reads MATLAB level 5 files, written from the format's description ("MAT-File Format", R2020a, chapter 1) and strict: what a
reader need not forgive is a fault here. Structs become dicts, cells lists, doubles lists (of columns where there are rows)."""
from __future__ import annotations

import struct
from typing import Any

SIZES = {1: 1, 2: 1, 4: 2, 5: 4, 6: 4, 9: 8, 14: 1}


def elements(data: bytes) -> list[tuple[int, bytes]]:
    found = []
    position = 0
    while position < len(data):
        first, second = struct.unpack_from("<II", data, position)
        if first >> 16:  # a small element: type and length share the first word
            kind, length, begin = first & 0xFFFF, first >> 16, position + 4
            assert length <= 4, "a small element holds four bytes"
            position += 8
        else:
            kind, length, begin = first, second, position + 8
            position = begin + (length + 7) // 8 * 8
        assert kind in SIZES and length % SIZES[kind] == 0, (kind, length)
        assert position <= len(data), "an element ends behind the file"
        found.append((kind, data[begin:begin + length]))
    return found


def value_of(body: bytes) -> tuple[str, Any]:
    parts = elements(body)
    assert parts[0][0] == 6 and len(parts[0][1]) == 8, "array flags"
    [flags, _] = struct.unpack("<II", parts[0][1])
    assert parts[1][0] == 5 and len(parts[1][1]) == 8, "two dimensions"
    rows, columns = struct.unpack("<ii", parts[1][1])
    assert parts[2][0] == 1, "the name"
    name = parts[2][1].decode("ascii")
    rest, cls, logical = parts[3:], flags & 0xFF, bool(flags & 0x200)
    if cls == 2:
        assert rest[0][0] == 5 and rest[1][0] == 1
        [length] = struct.unpack("<i", rest[0][1])
        assert length <= 64
        names = [rest[1][1][at:at + length].split(b"\0")[0].decode("ascii") for at in range(0, len(rest[1][1]), length)]
        assert len(set(names)) == len(names) == len(rest) - 2 and (rows, columns) == (1, 1)
        assert all(one.isidentifier() and one[0] != "_" and len(one) <= 63 for one in names), names
        return name, {field: value_of(content)[1] for field, (_, content) in zip(names, rest[2:])}
    if cls == 1:
        assert rows * columns == len(rest) and all(kind == 14 for kind, _ in rest)
        return name, [value_of(content)[1] for _, content in rest]
    [(kind, data)] = rest
    assert len(data) == rows * columns * SIZES[kind]
    if cls == 4:
        assert kind == 4
        return name, data.decode("utf-16-le")
    if cls == 9:
        assert kind == 2 and logical and rows * columns == 1
        return name, bool(data[0])
    assert cls == 6 and kind == 9, cls
    numbers = list(struct.unpack(f"<{rows * columns}d", data))
    if rows * columns == 0:
        return name, None
    if rows == columns == 1:
        return name, numbers[0]
    return name, numbers if rows == 1 else [numbers[row::rows] for row in range(rows)]


def read(data: bytes) -> dict[str, Any]:
    assert data[:10] == b"MATLAB 5.0" and data[124:128] == b"\x00\x01IM", data[:128]
    found = [value_of(body) for kind, body in elements(data[128:]) if kind == 14]
    return dict(found)
