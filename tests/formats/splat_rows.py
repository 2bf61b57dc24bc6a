# SPDX-License-Identifier: Apache-2.0
"""Gaussians as numbers, and the scene files that the standard library can write or read."""
import dataclasses
import functools
import gzip
import json
import math
import re
import struct

SETS = 16
ZERO = 0.28209479177387814  # the harmonic of degree 0: colour = 0.5 + ZERO x coefficient
TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d"}


@dataclasses.dataclass
class Gaussian:
    position: list
    log_scale: list
    rotation: list  # w x y z
    logit: float
    zero: list  # red, green, blue of degree 0
    rest: list  # of each coefficient above: red, green, blue

    def opacity(self):
        return 1 / (1 + math.exp(-self.logit))

    def colour(self):
        return [0.5 + ZERO * each for each in self.zero]

    def covariance(self):
        length = math.sqrt(sum(each * each for each in self.rotation))
        w, x, y, z = (each / length for each in self.rotation)
        turn = ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
        squares = [math.exp(2 * each) for each in self.log_scale]
        return [sum(turn[i][k] * turn[j][k] * squares[k] for k in range(3)) for i in range(3) for j in range(3)]


def helix(degree, count=60, coefficients=1.0, colours=(0.0, 1.0)):
    """A helix along x, so that x identifies a Gaussian; harmonics up to +-coefficients, colours in a range. Gaussians share
    sets of harmonics, as .sog needs."""
    made, low, high = [], *colours
    for i in range(count):
        def wave(k, i=i):
            return math.sin(1.7 * i + 2.3 * k + 0.1 * i * k)

        harmonics = functools.partial(wave, i=i % SETS)

        made.append(Gaussian(
            [i * 0.05 - 1.5, math.cos(i * 0.3), 2 + math.sin(i * 0.3)], [-4 + wave(k) for k in range(3)],
            [0.3 + wave(3), wave(4), wave(5), wave(6)], 3 * wave(7),
            [(low + (high - low) * (0.5 + wave(8 + k) / 2) - 0.5) / ZERO for k in range(3)],
            [[coefficients * harmonics(11 + 3 * k + channel) for channel in range(3)] for k in range((degree + 1) ** 2 - 1)]))
    return made


def far_away(degree):
    """A few faint Gaussians, up to a million times as far away as the helix."""
    return [dataclasses.replace(each, position=[10.0 ** (4 + i), 5.0, -3.0], logit=-4.0)
            for i, each in enumerate(helix(degree, 3))]


def moved(rows, by):
    return [dataclasses.replace(row, position=[a + b for a, b in zip(row.position, by)]) for row in rows]


# --- .ply --------------------------------------------------------------------------------------------------------------


def columns_of(row, without=()):
    count = len(row.rest)
    values = dict(zip("xyz", row.position)) | {f"f_dc_{k}": row.zero[k] for k in range(3)}
    values |= {f"f_rest_{channel * count + k}": row.rest[k][channel] for channel in range(3) for k in range(count)}
    values |= {"opacity": row.logit} | {f"scale_{k}": row.log_scale[k] for k in range(3)}
    values |= {f"rot_{k}": row.rotation[k] for k in range(4)}
    return {name: value for name, value in values.items() if name not in without}


def write_ply(path, rows, encoding="binary_little_endian", kind="float", comments=(), without=()):
    tables = [columns_of(row, without) for row in rows]
    lines = ["ply", f"format {encoding} 1.0", *(f"comment {text}" for text in comments), f"element vertex {len(rows)}",
             *(f"property {kind} {name}" for name in tables[0]), "end_header", ""]
    if encoding == "ascii":
        body = "".join(" ".join(map(repr, table.values())) + "\n" for table in tables).encode()
    else:
        order = ">" if encoding == "binary_big_endian" else "<"
        body = b"".join(struct.pack(f"{order}{len(table)}{TYPES[kind]}", *table.values()) for table in tables)
    with open(path, "wb") as file:
        file.write("\n".join(lines).encode() + body)


def read_ply(path):
    """Returns the rows of a little-endian .ply, at their place in the world, and its comments."""
    with open(path, "rb") as file:
        header, body = file.read().split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    comments = [line[8:] for line in lines if line.startswith("comment ")]
    properties = [line.split()[1:] for line in lines if line.startswith("property ")]
    count = int(next(line.split()[2] for line in lines if line.startswith("element vertex ")))
    form = struct.Struct("<" + "".join(TYPES[kind] for kind, _ in properties))
    names = [name for _, name in properties]
    rest = sum(name.startswith("f_rest_") for name in names) // 3
    origin = [0.0] * 3
    if "trim3r local 1" in comments:
        origin = next([int(each) / 2**32 for each in found.groups()] for found in (
            re.fullmatch(r"trim3r origin_q32 (\S+) (\S+) (\S+)", text) for text in comments) if found)
    rows = []
    for i in range(count):
        v = dict(zip(names, form.unpack_from(body, i * form.size)))
        rows.append(Gaussian([v[name] for name in "xyz"], [v[f"scale_{k}"] for k in range(3)], [v[f"rot_{k}"] for k in range(4)],
                             v["opacity"], [v[f"f_dc_{k}"] for k in range(3)],
                             [[v[f"f_rest_{channel * rest + k}"] for channel in range(3)] for k in range(rest)]))
    return moved(rows, origin), comments


# --- .splat, .glb, .spz of the first versions --------------------------------------------------------------------------


def logit(share):
    return math.log(share / (1 - share))


def read_splat(path):
    with open(path, "rb") as file:
        data = file.read()
    return [Gaussian(list(v[:3]), [math.log(each) for each in v[3:6]], [(each - 128) / 128 for each in v[10:]],
                     logit(min(max(v[9], 0.5), 254.5) / 255), [(each / 255 - 0.5) / ZERO for each in v[6:9]], [])
            for v in struct.iter_unpack("<6f8B", data)]


def half_turn_about_z(row):
    """Turns a Gaussian between the axes of a .ply and those of a .glb: x left, y up, z forward."""
    w, x, y, z = row.rotation
    orders = [m for degree in (1, 2, 3) for m in range(-degree, degree + 1)]
    return dataclasses.replace(row, position=[-row.position[0], -row.position[1], row.position[2]], rotation=[-z, -y, x, w],
                               rest=[[(-1) ** abs(m) * each for each in rgb] for m, rgb in zip(orders, row.rest)])


def read_glb(path):
    """Returns the rows of a .glb with one node, turned to the axes of a .ply."""
    with open(path, "rb") as file:
        data = file.read()
    size = struct.unpack_from("<I", data, 12)[0]
    tree, body = json.loads(data[20:20 + size]), data[28 + size:]
    primitive, node = tree["meshes"][0]["primitives"][0], tree["nodes"][0]

    def values(name):
        accessor = tree["accessors"][primitive["attributes"][name]]
        view, width = tree["bufferViews"][accessor["bufferView"]], {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        code, most = {5126: ("f", 1), 5122: ("h", 32767), 5123: ("H", 65535)}[accessor["componentType"]]  # integers: of 1
        form = struct.Struct(f"<{width}{code}")
        at, step = view.get("byteOffset", 0) + accessor.get("byteOffset", 0), view.get("byteStride", form.size)
        return [[each / most for each in form.unpack_from(body, at + i * step)] for i in range(accessor["count"])]

    splat = "KHR_gaussian_splatting:"
    rest = []
    for degree in (1, 2, 3):
        for k in range(2 * degree + 1):
            name = f"{splat}SH_DEGREE_{degree}_COEF_{k}"
            rest += [values(name)] if name in primitive["attributes"] else []
    move = node.get("translation", [0, 0, 0])
    rows = [Gaussian([a + b for a, b in zip(position, move)], [math.log(each) for each in scale], [w, x, y, z], logit(opacity), zero,
                     [list(each[i]) for each in rest])
            for i, (position, scale, (x, y, z, w), (opacity,), zero) in enumerate(zip(
                values("POSITION"), values(f"{splat}SCALE"), values(f"{splat}ROTATION"), values(f"{splat}OPACITY"),
                values(f"{splat}SH_DEGREE_0_COEF_0")))]
    return [half_turn_about_z(row) for row in rows]


def as_byte(value):
    return min(max(round(value), 0), 255)


def half_float(value):
    return struct.pack("<e", value)


def write_spz(path, rows, version, packed=True, mip=False):
    """Writes .spz of version 1 (positions of 16 bits), 2 or 3 (rotations by their smallest three), in its axes: x right, y up,
    z backward. Harmonics are of degree 0, as these have no axes."""
    places = b"".join(half_float(sign * each) if version == 1 else
                      struct.pack("<i", round(sign * each * 4096))[:3] for row in rows
                      for sign, each in zip((1, -1, -1), row.position))
    turned = []
    for row in rows:
        length = math.copysign(math.sqrt(sum(each * each for each in row.rotation)), row.rotation[0])
        w, x, y, z = (each / length for each in row.rotation)
        turned.append((x, -y, -z, w))
    if version < 3:
        rotations = bytes(as_byte(127.5 + 127.5 * each) for turn in turned for each in turn[:3])
    else:
        rotations = b"".join(map(smallest_three, turned))
    body = (places + bytes(as_byte(255 * row.opacity()) for row in rows) +
            bytes(as_byte(255 * (0.5 + 0.15 * each)) for row in rows for each in row.zero) +
            bytes(as_byte(16 * (each + 10)) for row in rows for each in row.log_scale) + rotations)
    data = struct.pack("<4sIIBBBB", b"NGSP", version, len(rows), 0, 12, int(mip), 0) + body
    with open(path, "wb") as file:
        file.write(gzip.compress(data, mtime=0) if packed else data)


def declare_axes(path, axes):
    """Writes a copy of a .spz of version 4 with an extension that declares its axes, 0..16; returns the copy's path."""
    with open(path, "rb") as file:
        data = bytearray(file.read())
    table = struct.unpack_from("<I", data, 16)[0]
    data[14] |= 2
    struct.pack_into("<I", data, 16, table + 12)
    copy = f"axes_{axes}.spz"
    with open(copy, "wb") as file:
        file.write(data[:table] + struct.pack("<III", 0xADBE0003, 4, axes) + data[table:])
    return copy


def smallest_three(turn):
    """Packs a quaternion x y z w into 32 bits: the index of the largest, then three signs with 9 bits of magnitude."""
    largest = max(range(4), key=lambda i: abs(turn[i]))
    word = largest
    for i in range(4):
        if i != largest:
            sign = (turn[i] < 0) != (turn[largest] < 0)
            word = word << 10 | int(sign) << 9 | round(511 * min(abs(turn[i]) * math.sqrt(2), 1))
    return struct.pack("<I", word)


# --- comparison --------------------------------------------------------------------------------------------------------


@dataclasses.dataclass
class Steps:
    """The most that a format may change, and its range."""
    position: float = 1e-6
    shape: float = 1e-5  # of an entry of the covariance, relative to the largest
    opacity: float = 1e-6
    colour: float = 1e-6
    harmonics: float = 1e-6
    colours: tuple = (-math.inf, math.inf)
    coefficients: float = math.inf
    degree: int = 3


def largest_differences(wanted, found, steps):
    """Returns the largest differences between two lists in the order of x, each in units of what is allowed."""
    assert len(wanted) == len(found), f"{len(found)} Gaussians, not {len(wanted)}"
    most = dict.fromkeys(("position", "shape", "opacity", "colour", "harmonics"), 0.0)

    def add(what, values, allowed):
        most[what] = max(most[what], *(abs(a - b) / allowed for a, b in values), 0.0)

    low, high = steps.colours
    for a, b in zip(*(sorted(rows, key=lambda row: row.position[0]) for rows in (wanted, found))):
        add("position", zip(a.position, b.position), steps.position * max(1.0, *map(abs, a.position)))
        p, q = a.covariance(), b.covariance()
        add("shape", zip(p, q), steps.shape * max(map(abs, p)))
        add("opacity", [(a.opacity(), b.opacity())], steps.opacity)
        add("colour", [(min(max(x, low), high), y) for x, y in zip(a.colour(), b.colour())], steps.colour)
        count = min(len(a.rest), (steps.degree + 1) ** 2 - 1)
        assert len(b.rest) == count, f"{len(b.rest)} coefficients, not {count}"
        limit = steps.coefficients
        add("harmonics", [(min(max(x, -limit), limit), y) for s, t in zip(a.rest, b.rest) for x, y in zip(s, t)] or [(0, 0)],
            steps.harmonics)
    return most
