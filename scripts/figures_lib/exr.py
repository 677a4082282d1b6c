"""Reads the OpenEXR pictures that stokes writes, and writes such: single-part scan lines, 32-bit floats, ZIP or no
compression."""

import pathlib
import struct
import zlib

import numpy as np

MAGIC = 20000630
LINES_PER_BLOCK = {0: 1, 2: 1, 3: 16}  # by compression: none, ZIPS, ZIP
FLOAT = 2
NUMBERS = {"int": "<i", "float": "<f", "double": "<d"}


class Picture:
    """layers: {"": total, "fluorescence": .., ..}, arrays [height, width, 3] of linear Rec. 709 in cd/m^2;
    attributes: the header's numbers and strings."""

    def __init__(self, layers, attributes):
        self.layers = layers
        self.attributes = attributes
        self.height, self.width = layers[""].shape[:2]

    @property
    def rgb(self):
        return self.layers[""]

    def luminance(self, layer=""):
        """[height, width], cd/m^2."""
        return self.layers[layer] @ np.array([0.2126, 0.7152, 0.0722])


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _channels(value):
    """Names of a chlist, in file order."""
    names, at = [], 0
    while value[at]:
        name, at = _text(value, at)
        (kind,) = struct.unpack_from("<i", value, at)
        if kind != FLOAT:
            raise ValueError(f"channel {name} is not of 32-bit floats")
        names.append(name)
        at += 16
    return names


def _header(data):
    attributes, at = {}, 8
    while data[at]:
        name, at = _text(data, at)
        kind, at = _text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        value = data[at + 4 : at + 4 + size]
        at += 4 + size
        if kind in NUMBERS:
            attributes[name] = struct.unpack(NUMBERS[kind], value)[0]
        elif kind == "string":
            attributes[name] = value.decode()
        elif kind == "chlist":
            attributes[name] = _channels(value)
        elif kind == "box2i":
            attributes[name] = struct.unpack("<4i", value)
        elif kind == "compression":
            attributes[name] = value[0]
    return attributes, at + 1


def _unzip(block, size):
    """Undoes ZIP compression: inflate, sum the differences, interleave the two halves."""
    if len(block) == size:
        return block
    raw = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    raw[1:] -= 128
    raw = (np.cumsum(raw) & 255).astype(np.uint8)
    result = np.empty(size, np.uint8)
    half = (size + 1) // 2
    result[0::2] = raw[:half]
    result[1::2] = raw[half:]
    return result.tobytes()


def read(path):
    """A Picture; ValueError for what stokes does not write."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version = struct.unpack_from("<ii", data)
    if magic != MAGIC or version & 0x1A00:
        raise ValueError(f"{path}: not a single-part OpenEXR file of scan lines")
    attributes, at = _header(data)
    if attributes["compression"] not in LINES_PER_BLOCK:
        raise ValueError(f"{path}: a compression other than ZIP")
    left, top, right, bottom = attributes["dataWindow"]
    width, height, names = right - left + 1, bottom - top + 1, attributes["channels"]
    lines = LINES_PER_BLOCK[attributes["compression"]]
    planes = np.empty((height, len(names), width), np.float32)
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, at):
        first, size = struct.unpack_from("<ii", data, offset)
        first -= top
        count = min(lines, height - first)
        block = _unzip(data[offset + 8 : offset + 8 + size], count * len(names) * width * 4)
        planes[first : first + count] = np.frombuffer(block, "<f4").reshape(count, len(names), width)
    layers = {}
    for name in {channel.rpartition(".")[0] for channel in names}:
        prefix = name + "." if name else ""
        layers[name] = np.stack([planes[:, names.index(prefix + c)] for c in "RGB"], axis=-1).astype(float)
    return Picture(layers, attributes)


def write(path, layers):
    """layers as of a Picture, all of one size, to an uncompressed file, which is replaced as a whole."""
    planes = {
        f"{name}.{c}" if name else c: layer[..., "RGB".index(c)] for name, layer in layers.items() for c in "RGB"
    }
    names = sorted(planes, key=str.encode)  # the order that the format asks for
    height, width = planes[names[0]].shape

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    channels = b"".join(name.encode() + b"\0" + struct.pack("<i4B2i", FLOAT, 0, 0, 0, 0, 1, 1) for name in names)
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", MAGIC, 2) + b"".join(
        (
            attribute("channels", "chlist", channels + b"\0"),
            attribute("compression", "compression", b"\0"),
            attribute("dataWindow", "box2i", window),
            attribute("displayWindow", "box2i", window),
            attribute("lineOrder", "lineOrder", b"\0"),
            attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
            attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
            attribute("screenWindowWidth", "float", struct.pack("<f", 1)),
            b"\0",
        )
    )
    line = 8 + 4 * width * len(names)
    first = len(header) + 8 * height
    offsets = struct.pack(f"<{height}Q", *range(first, first + line * height, line))
    rows = np.stack([planes[name] for name in names], axis=1).astype("<f4")  # [height, channels, width]
    lines = b"".join(struct.pack("<ii", y, line - 8) + row.tobytes() for y, row in enumerate(rows))
    unfinished = pathlib.Path(f"{path}.tmp")
    unfinished.write_bytes(header + offsets + lines)
    unfinished.replace(path)
