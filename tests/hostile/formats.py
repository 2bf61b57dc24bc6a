# SPDX-License-Identifier: Apache-2.0
"""Bytes of every format that trim3r reads, right or wrong as requested; uses only the standard library."""
import io
import json
import struct
import zipfile
import zlib

ESCAPE = "\x1b]0;owned\x07\x9b31m"  # control sequences of a terminal: a title, and a colour by C1


# --- pictures --------------------------------------------------------------------------------------------------------


def png_chunk(name, data, crc=None):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data) if crc is None else crc)


def exr(width, height, tile=0, chunks=None):
    """Returns zeros as float, packed by ZIP: lines of a picture, or its tiles. chunks: how many of them are present."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(data)) + data

    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = (b"\x76\x2f\x31\x01" + struct.pack("<I", 2 | (0x200 if tile else 0))
            + attribute(b"channels", b"chlist", b"Z\0" + struct.pack("<iIii", 2, 0, 1, 1) + b"\0")
            + attribute(b"compression", b"compression", b"\3") + attribute(b"dataWindow", b"box2i", window)
            + attribute(b"displayWindow", b"box2i", window) + attribute(b"lineOrder", b"lineOrder", b"\0")
            + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
            + attribute(b"screenWindowCenter", b"v2f", bytes(8)) + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))
            + (attribute(b"tiles", b"tiledesc", struct.pack("<IIB", tile, tile, 0)) if tile else b"") + b"\0")
    places = ([(x, y, 0, 0) for y in range(height // tile) for x in range(width // tile)] if tile else
              [(y,) for y in range(0, min(height, 4096), 16)])[:chunks]
    size = min(4 * (tile * tile if tile else 16 * width), 1 << 20)
    packed = zlib.compress(b"\0" + b"\x80" * (size - 1), 9)  # differences of bytes
    bodies = [struct.pack(f"<{len(place)}i", *place) + struct.pack("<I", len(packed)) + packed for place in places]
    first = len(head) + 8 * len(bodies)
    size = len(bodies[0]) if bodies else 0
    return head + struct.pack(f"<{len(bodies)}Q", *(first + i * size for i in range(len(bodies)))) + b"".join(bodies)


def png(width, height, depth=8, colour=2, interlaced=0, rows=None, before=b"", crc=None):
    """Returns zeros, unless rows (the raw bytes) are given; rows of a huge picture that must not be read are
    omitted."""
    if rows is None:
        row = bytes(1 + (width * {0: 1, 2: 3, 3: 1, 6: 4}[colour] * depth + 7) // 8)
        rows = row * height if not interlaced else bytes(adam7(width, height, {0: 1, 2: 3, 6: 4}[colour] * depth))
    head = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlaced)
    return (b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", head, crc) + before + png_chunk(b"IDAT", zlib.compress(rows, 9)) +
            png_chunk(b"IEND", b""))


def adam7(width, height, bits):
    total = 0
    for x, y, dx, dy in ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)):
        columns, lines = max(0, (width - x + dx - 1) // dx), max(0, (height - y + dy - 1) // dy)
        total += lines * (1 + (columns * bits + 7) // 8) if columns else 0
    return total


def jpeg_segment(marker, data):
    return b"\xff" + bytes([marker]) + struct.pack(">H", len(data) + 2) + data


def jpeg_bits(pairs):
    """Returns codes (value, bits) one after the other, stuffed like entropy-coded data."""
    gathered, bits, out = 0, 0, bytearray()
    for value, length in pairs:
        gathered, bits = gathered << length | value, bits + length
        while bits >= 8:
            byte = gathered >> bits - 8 & 255
            out += bytes([byte, 0]) if byte == 255 else bytes([byte])
            bits -= 8
            gathered &= (1 << bits) - 1
    if bits:
        byte = (gathered << 8 - bits | (1 << 8 - bits) - 1) & 255
        out += bytes([byte, 0]) if byte == 255 else bytes([byte])
    return bytes(out)


def jpeg(side, scans=1, width=None):
    """Returns a progressive grey JPEG: one scan of the means, then empty scans of one coefficient each."""
    width = side if width is None else width
    components = b"\1\x11\0\2\x11\0\3\x11\0"
    out = b"\xff\xd8" + jpeg_segment(0xdb, b"\0" + b"\1" * 64)
    out += jpeg_segment(0xc2, struct.pack(">BHHB", 8, side, width, 3) + components)
    out += jpeg_segment(0xc4, b"\0" + b"\1" + bytes(15) + b"\0")
    out += jpeg_segment(0xc4, b"\x10" + b"\1\1" + bytes(14) + b"\xe0\0")
    blocks = (side + 7) // 8 * ((width + 7) // 8)
    out += jpeg_segment(0xda, b"\3\1\0\2\0\3\0\0\0\0") + bytes((blocks * 3 + 7) // 8)
    runs, left = [], blocks
    while left >= 16384:
        run = min(left, 32767)
        runs += [(0, 1), (run - 16384, 14)]
        left -= run
    nothing = jpeg_bits(runs + [(2, 2)] * left)
    order = ((low, k, c) for low in range(13, -1, -1) for k in range(1, 64) for c in (1, 2, 3))
    for _, (low, k, c) in zip(range(scans - 1), order):
        high = 0 if low == 13 else low + 1
        out += jpeg_segment(0xda, bytes([1, c, 0, k, k, high << 4 | low])) + nothing
    return out + b"\xff\xd9"


# --- compression -----------------------------------------------------------------------------------------------------


def zstd(parts, size=None):
    """Returns a Zstandard frame of parts: raw bytes, or (byte, count), which takes 4 bytes for each 128 KiB."""
    total = sum(len(p) if isinstance(p, bytes) else p[1] for p in parts)
    blocks = []
    for part in parts:
        if isinstance(part, bytes):
            blocks += [(0, len(part), part)]
        else:
            left = part[1]
            while left:
                some = min(left, 128 << 10)
                blocks += [(1, some, bytes([part[0]]))]
                left -= some
    out = struct.pack("<IBQ", 0xFD2FB528, 0xE0, total if size is None else size)
    for i, (kind, length, data) in enumerate(blocks):
        out += (length << 3 | kind << 1 | (i + 1 == len(blocks))).to_bytes(3, "little") + data
    return out


def lz4(head, byte, count):
    """Returns an LZ4 frame of head, then count times a byte: blocks of 4 MiB, each one long match."""
    out = struct.pack("<I", 0x184D2204) + b"\x40\x70"  # blocks depend on each other; 4 MiB; no sums
    out += bytes([xxh32(b"\x40\x70") >> 8 & 255])
    out += struct.pack("<I", 0x80000000 | len(head)) + head
    while count:
        some = min(count, 4 << 20)
        if some < 64:
            data, flag = bytes([byte]) * some, 0x80000000
        else:
            match = some - 1 - 5  # a literal, the match, five literals
            rest = match - 4 - 15
            data = b"\x1f" + bytes([byte]) + b"\1\0" + b"\xff" * (rest // 255) + bytes([rest % 255])
            data, flag = data + b"\x50" + bytes([byte]) * 5, 0
        out += struct.pack("<I", flag | len(data)) + data
        count -= some
    return out + struct.pack("<I", 0)


def lz4_repeated(unit, times):
    """Returns an LZ4 frame of the same bytes repeated `count` times, at least 19 of them."""
    out = struct.pack("<I", 0x184D2204) + b"\x40\x70"
    out += bytes([xxh32(b"\x40\x70") >> 8 & 255])
    while times:
        some = min(times, (4 << 20) // len(unit))
        data = unit * some
        if some > 2:
            literals, match = len(unit) - 15, len(unit) * (some - 1) - 5 - 19
            data = b"\xff" + b"\xff" * (literals // 255) + bytes([literals % 255]) + unit + struct.pack("<H", len(unit))
            data += b"\xff" * (match // 255) + bytes([match % 255]) + b"\x50" + unit[-5:]
        out += struct.pack("<I", len(data) | (0 if some > 2 else 0x80000000)) + data
        times -= some
    return out + struct.pack("<I", 0)


def xxh32(data):
    """Computes xxHash of fewer than 16 bytes."""
    mask, p1, p2, p3, p5 = 0xFFFFFFFF, 2654435761, 2246822519, 3266489917, 374761393
    h = (p5 + len(data)) & mask
    for byte in data:
        h = (h + byte * p5) & mask
        h = ((h << 11 | h >> 21) & mask) * p1 & mask
    h = (h ^ h >> 15) * p2 & mask
    h = (h ^ h >> 13) * p3 & mask
    return h ^ h >> 16


# --- scenes ----------------------------------------------------------------------------------------------------------


def spz(count, degree=0, stream=None):
    """Returns version 4 with streams of zeros, except ones for scales; or with the given stream for each."""
    sizes = [9, 1, 3, 3, 4, 3 * ((degree + 1)**2 - 1)][:6 if degree else 5]
    streams = [zstd([(160 if i == 3 else 0, count * size)]) if stream is None else stream for i, size in enumerate(sizes)]
    table = b"".join(struct.pack("<QQ", len(data), count * size) for data, size in zip(streams, sizes))
    head = b"NGSP" + struct.pack("<IIBBBBI", 4, count, degree, 12, 0, len(sizes), 32) + bytes(12)
    return head + table + b"".join(streams)


def glb(text, numbers=b""):
    text = text if isinstance(text, bytes) else json.dumps(text).encode()
    text += b" " * (-len(text) % 4)
    return (b"glTF" + struct.pack("<II", 2, 28 + len(text) + len(numbers)) + struct.pack("<II", len(text), 0x4E4F534A) + text +
            struct.pack("<II", len(numbers), 0x004E4942) + numbers)


def gaussians(count, stride=None, **more):
    """Returns the JSON of a .glb whose attributes are all the same numbers."""
    names = ("ROTATION", "SCALE", "OPACITY", "SH_DEGREE_0_COEF_0")
    types = {"POSITION": "VEC3", "ROTATION": "VEC4", "SCALE": "VEC3", "OPACITY": "SCALAR", "SH_DEGREE_0_COEF_0": "VEC3"}
    view = {"buffer": 0, "byteLength": 64} | ({} if stride is None else {"byteStride": stride})
    attributes = {"POSITION": 0} | {f"KHR_gaussian_splatting:{name}": i + 1 for i, name in enumerate(names)}
    extension = {"KHR_gaussian_splatting": {"kernel": "ellipse", "colorSpace": "srgb_rec709_display"}}
    return {"asset": {"version": "2.0"}, "bufferViews": [view],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": types[name]} for name in types],
            "meshes": [{"primitives": [{"mode": 0, "attributes": attributes, "extensions": extension}]}]} | more


def webp(width, height):
    """Returns the head of a lossless picture without its texels."""
    data = b"\x2f" + struct.pack("<I", width - 1 | height - 1 << 14) + bytes(27)
    return b"RIFF" + struct.pack("<I", 12 + len(data)) + b"WEBPVP8L" + struct.pack("<I", len(data)) + data


def sog_meta(count, name="x.webp"):
    book, files = [0] * 256, [name, name]
    return json.dumps({"version": 2, "count": count, "means": {"mins": [0] * 3, "maxs": [1] * 3, "files": files},
                       "scales": {"codebook": book, "files": files}, "quats": {"files": files},
                       "sh0": {"codebook": book, "files": files}}).encode()


def sog(members):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as file:
        for name, data in members.items():
            file.writestr(name, data)
    return out.getvalue()


# --- recordings ------------------------------------------------------------------------------------------------------


def text(value):
    value = value if isinstance(value, bytes) else value.encode()
    return struct.pack("<I", len(value)) + value


def record(opcode, data, length=None):
    return struct.pack("<BQ", opcode, len(data) if length is None else length) + data


class Cdr:
    def __init__(self, stamp, frame="camera"):
        self.data = b""
        self.put("iI", stamp // 10**9, stamp % 10**9)
        self.string(frame)

    def put(self, form, *values):
        for kind, value in zip(form, values):
            size = struct.calcsize("<" + kind)
            self.data += bytes(-len(self.data) % size) + struct.pack("<" + kind, value)
        return self

    def string(self, value):
        value = value.encode() + b"\0"
        self.put("I", len(value))
        self.data += value
        return self

    def bytes(self):
        return b"\0\1\0\0" + self.data


def image(stamp, width=16, height=16, encoding="rgb8", data=None, step=None, data_bytes=None):
    """Returns a sensor_msgs/Image; data_bytes: the size stated for its data, whatever is present."""
    size = {"rgb8": 3, "16UC1": 2, "32FC1": 4}.get(encoding, 3)
    data = bytes(range(256)) * (width * height * size // 256 + 1) if data is None else data
    if data_bytes is None:
        data = data[:width * height * size]
        data_bytes = len(data)
    head = Cdr(stamp).put("II", height, width).string(encoding).put("B", 0).put("I", width * size if step is None else step)
    return head.put("I", data_bytes).bytes() + data


def camera_info(stamp, width=16, height=16, k=(40, 0, 8, 0, 40, 8, 0, 0, 1), d=(0,) * 5, model="plumb_bob"):
    out = Cdr(stamp).put("II", height, width).string(model).put("I", len(d)).put("d" * len(d), *d)
    out.put("d" * 9, *k).put("d" * 9, 1, 0, 0, 0, 1, 0, 0, 0, 1).put("d" * 12, *([0] * 12))
    return out.put("IIIIIIB", 0, 0, 0, 0, 0, 0, 0).bytes()


def pose(stamp, position=(0, 0, 0), rotation=(0, 0, 0, 1)):
    return Cdr(stamp, "world").put("d" * 7, *position, *rotation).bytes()


def transforms(stamp, edges, count=None, place=(0, 0, 0, 0, 0, 0, 1)):
    """Returns a tf2_msgs/TFMessage of (parent, child); count: the number stated."""
    out = Cdr(stamp)
    out.data = b""
    out.put("I", len(edges) if count is None else count)
    for parent, child in edges:
        out.put("iI", stamp // 10**9, stamp % 10**9).string(parent).string(child).put("d" * 7, *place)
    return out.bytes()


def compressed(stamp, form, data, data_bytes=None):
    """Returns a sensor_msgs/CompressedImage."""
    return Cdr(stamp).string(form).put("I", len(data) if data_bytes is None else data_bytes).bytes() + data


TYPES = {"image": "sensor_msgs/msg/Image", "depth": "sensor_msgs/msg/Image", "camera_info": "sensor_msgs/msg/CameraInfo",
         "pose": "geometry_msgs/msg/PoseStamped"}


def message(channel, stamp, data, length=None):
    return record(5, struct.pack("<HIQQ", channel, 0, stamp, stamp) + data, length)


def channels(prefix="/camera/", names=TYPES):
    out = b""
    for i, name in enumerate(names):
        out += record(3, struct.pack("<H", i + 1) + text(TYPES[name]) + text("ros2msg") + text(""))
        out += record(4, struct.pack("<HH", i + 1, i + 1) + text(prefix + name) + text("cdr") + text(""))
    return out


def channel(number, topic, kind):
    return (record(3, struct.pack("<H", number) + text(kind) + text("ros2msg") + text("")) +
            record(4, struct.pack("<HH", number, number) + text(topic) + text("cdr") + text("")))


def frame(i, **wrong):
    """Returns the four messages of frame i; one from `wrong` replaces the right one."""
    stamp = i * 33 * 10**6 + 10**9
    right = {"camera_info": camera_info(stamp), "pose": pose(stamp, (0.01 * i, 0, 0)),
             "depth": image(stamp, encoding="16UC1", data=struct.pack("<H", 1500) * 256), "image": image(stamp)}
    right.update({name: made(stamp) for name, made in wrong.items()})
    return b"".join(message(list(TYPES).index(name) + 1, stamp, data) for name, data in right.items())


MAGIC = b"\x89MCAP0\r\n"


def mcap(*records, end=True):
    tail = record(0x0f, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + MAGIC if end else b""
    return MAGIC + record(1, text("ros2") + text("hostile")) + b"".join(records) + tail


def chunk(compression, data, unpacked, crc=0):
    return record(6, struct.pack("<QQQI", 0, 0, unpacked, crc) + text(compression) + struct.pack("<Q", len(data)) + data)


def metadata(name, pairs):
    return record(0x0c, text(name) + text(b"".join(text(k) + text(v) for k, v in pairs.items())))


# --- arrays ----------------------------------------------------------------------------------------------------------


def npy_head(shape, kind="<f4", order="False"):
    head = f"{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}"
    head += " " * (63 - (10 + len(head)) % 64) + "\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head.encode()


def deflated(head, byte, count):
    """Returns raw deflate of head and `count` bytes, its CRC and length."""
    packer, crc, out, block = zlib.compressobj(9, zlib.DEFLATED, -15), zlib.crc32(head), [], bytes([byte]) * (1 << 20)
    out.append(packer.compress(head))
    for start in range(0, count, 1 << 20):
        part = block[:min(1 << 20, count - start)]
        crc = zlib.crc32(part, crc)
        out.append(packer.compress(part))
    return b"".join(out) + packer.flush(), crc, len(head) + count


def archive(members, shared=False):
    """Returns a zip of (name, deflated bytes, crc, size); shared: all entries of the directory point to the first one's
    data."""
    out, directory = b"", b""
    for i, (name, data, crc, size) in enumerate(members):
        name = name.encode()
        offset = 0 if shared else len(out)
        fields = struct.pack("<HHHHHIII", 20, 0, 8, 0, 0x21, crc, len(data), size)
        if not shared or i == 0:
            out += b"PK\3\4" + fields + struct.pack("<HH", len(name), 0) + name + data
        directory += (b"PK\1\2" + struct.pack("<H", 20) + fields + struct.pack("<HHHHHII", len(name), 0, 0, 0, 0, 0, offset) +
                      name)
    return (out + directory + b"PK\5\6" +
            struct.pack("<HHHHIIH", 0, 0, len(members), len(members), len(directory), len(out), 0))


# --- scenes, heads ---------------------------------------------------------------------------------------------------

PLY_FIELDS = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1",
              "rot_2", "rot_3"]


def ply(count=1, before="", values=None, rows=None, fields=None, behind=""):
    head = "ply\nformat binary_little_endian 1.0\n" + before + f"element vertex {count}\n"
    head += "".join(f"property float {name}\n" for name in fields or PLY_FIELDS) + behind + "end_header\n"
    row = struct.pack("<14f", *(values or [0, 0, 1, 0, 0, 0, 0, -4, -4, -4, 1, 0, 0, 0]))
    return head.encode("latin-1") + row * (count if rows is None else rows)


def safetensors(header, data=b"", length=None):
    header = header if isinstance(header, bytes) else json.dumps(header).encode()
    return struct.pack("<Q", len(header) if length is None else length) + header + data


# --- models of COLMAP ------------------------------------------------------------------------------------------------


def colmap_cameras(width=16):
    """Returns cameras.bin with one pinhole camera."""
    return struct.pack("<QIiQQ4d", 1, 7, 1, width, 16, 20, 20, 8, 8)


def colmap_images(count=1, name="a.png", points=0, rotation=(1, 0, 0, 0)):
    """Returns images.bin with `count` images, all of the same bytes."""
    one = struct.pack("<I7dI", 1, *rotation, 0, 0, 0, 7) + name.encode() + b"\0" + struct.pack("<Q", points)
    return struct.pack("<Q", count) + one * count
