"""Files of models, images in PNG and scenes in GLB; and calls of the program whose path is the first argument."""
import json
import pathlib
import struct
import subprocess
import sys
import zlib


def png(width, height, texel, gamma=None):
    """An image of 8 bits; with a gamma, the chunk gAMA states it."""
    rows = b"".join(b"\0" + b"".join(bytes(texel(x, y)) for x in range(width)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    stated = b"" if gamma is None else chunk(b"gAMA", struct.pack(">I", round(gamma * 1e5)))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) + stated + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Glb:
    """Views and accessors of one buffer."""

    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def view(self, data):
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data + bytes(-len(data) % 4)
        return len(self.views) - 1

    def array(self, rows, kind, code, component):
        flat = [x for row in rows for x in (row if isinstance(row, (list, tuple)) else [row])]
        self.accessors.append({"bufferView": self.view(struct.pack(f"<{len(flat)}{code}", *flat)), "componentType": component, "count": len(rows), "type": kind})
        return len(self.accessors) - 1

    def write(self, name, root):
        root = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(self.bytes)}], "bufferViews": self.views, "accessors": self.accessors, **root}
        text = json.dumps(root).encode()
        text += b" " * (-len(text) % 4)
        body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(self.bytes), 0x004E4942) + self.bytes
        pathlib.Path(name).write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body)


def command(*words, code=0):
    done = subprocess.run([sys.argv[1], *words], capture_output=True, text=True, timeout=300)
    assert done.returncode == code, f"{' '.join(words)}: exit {done.returncode}, expected {code}:\n{done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def has(text, *words):
    for word in words:
        assert word in text, f"no '{word}' in:\n{text}"
