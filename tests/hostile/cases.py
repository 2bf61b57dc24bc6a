# SPDX-License-Identifier: Apache-2.0
"""Hostile files: for each a name, the kind of input, a function that writes it, and words that its refusal must
contain ("" for any, None if it may also be read)."""
import gzip
import json
import os
import struct
import zlib

import formats as f

MIB = 1 << 20
UNIT = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
CASES = []


def case(kind, name, why=""):
    """Adds a case: the decorated function returns the file's bytes, or makes a folder at the path that it gets."""
    def note(make):
        CASES.append((kind, name, why, make))
        return make
    return note


def given(kind, name, data, why=""):
    CASES.append((kind, name, why, lambda: data() if callable(data) else data))


# --- recordings ------------------------------------------------------------------------------------------------------


def filled(codec, mib, chunks=1, others=()):
    """Returns chunks of one image each, of that many MiB of zeros."""
    out = [f.channels()]
    for _ in range(chunks):
        head = f.image(10**9, 4096, 4096, data=b"", data_bytes=mib * MIB)
        start = f.message(1, 10**9, head, 22 + len(head) + mib * MIB)
        size = len(start) + mib * MIB
        packed = f.zstd([start, (0, mib * MIB)]) if codec == "zstd" else f.lz4(start, 0, mib * MIB)
        out.append(f.chunk(codec, packed, size))
    return f.mcap(*out, *others)


def attachment(mib):
    """Returns a record that no frame needs; its bytes allow chunks to unpack to more."""
    return f.record(9, struct.pack("<QQ", 0, 0) + f.text("a") + f.text("b") + struct.pack("<Q", mib * MIB) + bytes(mib * MIB) +
                    struct.pack("<I", 0))


def poses(count):
    """Returns a chunk of `count` poses, each of the same bytes."""
    unit = f.message(4, 10**9, f.pose(10**9))
    return f.mcap(f.channels(), attachment(6), f.chunk("lz4", f.lz4_repeated(unit, count), len(unit) * count))


given("recording", "zstd-bomb.mcap", lambda: filled("zstd", 128, 32), "may unpack to")
given("recording", "zstd-below-the-limit.mcap", lambda: filled("zstd", 60, 2), None)
given("recording", "lz4-bomb.mcap", lambda: filled("lz4", 64, 16), "may unpack to")
given("recording", "zstd-440-mb-of-14-mb.mcap", lambda: filled("zstd", 63, 7, [attachment(14)]), None)
given("recording", "zstd-bomb-of-14-mb.mcap", lambda: filled("zstd", 63, 10, [attachment(14)]), "may unpack to")
given("recording", "zstd-300-mb-of-14-mb.mcap", lambda: filled("zstd", 60, 5, [attachment(14)]), None)
given("recording", "lz4-two-million-poses.mcap", lambda: poses(2000000), "more messages than")
given("recording", "lz4-million-poses.mcap", lambda: poses(1000000), None)
given("recording", "chunk-lies-more.mcap", f.mcap(f.chunk("zstd", f.zstd([b"abc"]), 100 * MIB)), "more than its data can")
given("recording", "chunk-lies-less.mcap", f.mcap(f.chunk("zstd", f.zstd([(0, 9 * MIB)]), 99)), "longer than")
given("recording", "chunk-of-2^63.mcap", f.mcap(f.chunk("lz4", b"abcd", 1 << 63)), "may unpack to")
given("recording", "chunk-uncompressed-lies.mcap", f.mcap(f.chunk("", b"abcd", 1 << 40)), "uncompressed_size")
given("recording", "chunk-in-chunk.mcap",
      lambda: f.mcap(f.chunk("", *[(c := f.chunk("", b"", 0)), len(c)])), "may not be in a chunk")
given("recording", "chunk-crc.mcap", f.mcap(f.chunk("", f.channels(), len(f.channels()), 7)), "CRC")
given("recording", "zstd-size-of-2^62.mcap", f.mcap(f.chunk("zstd", f.zstd([b"abc"], 1 << 62), 3)))
given("recording", "record-of-2^63.mcap", f.mcap(f.record(5, b"", 1 << 63)), "past the file's end")
given("recording", "record-of-2^64-1.mcap", f.mcap(f.record(0x90, b"", (1 << 64) - 1)), "past the file's end")
given("recording", "text-of-4-gb.mcap", f.mcap(f.record(3, struct.pack("<HI", 1, 0xFFFFFFFF))), "past the record's end")
given("recording", "cut.mcap", f.mcap(f.channels(), f.frame(0), f.frame(1), end=False)[:-40], None)
given("recording", "zeros-behind-a-cut.mcap", lambda: f.mcap(f.channels(), f.frame(0), end=False) + bytes(MIB), None)
given("recording", "no-channel.mcap", f.mcap(f.frame(0)), "channel was not defined")
given("recording", "65535-channels.mcap",
      lambda: f.mcap(f.record(3, struct.pack("<H", 1) + f.text(f.TYPES["image"]) + f.text("") + f.text("")),
                     *[f.record(4, struct.pack("<HH", i, 1) + f.text("/x/image") + f.text("cdr") + f.text(""))
                       for i in range(65536)]), None)
given("recording", "million-triplets.mcap",
      lambda: f.mcap(f.metadata("trim3r_triplets", {"triplets": ";".join(["1,2,0"] * 1500000)})), "more than 1048576")
given("recording", "image-of-65535.mcap",
      f.mcap(f.channels(), f.frame(0, image=lambda t: f.image(t, 65535, 65535, data=b"", data_bytes=0))), "4096")
given("recording", "image-step-of-0.mcap",
      f.mcap(f.channels(), f.frame(0, image=lambda t: f.image(t, step=0))), "step")
given("recording", "image-step-of-4-gb.mcap",
      f.mcap(f.channels(), f.frame(0, image=lambda t: f.image(t, step=0xFFFFFFFF))), "data hold fewer")
given("bag", "pose-nan.mcap",
      f.mcap(f.channels(), f.frame(0, pose=lambda t: f.pose(t, (float("nan"), 0, 0))), f.frame(1)), "position is not a number")
given("bag", "pose-infinite.mcap",
      f.mcap(f.channels(), f.frame(0, pose=lambda t: f.pose(t, (0, 0, float("-inf")))), f.frame(1)), "position is not a number")
given("bag", "pose-without-rotation.mcap",
      f.mcap(f.channels(), f.frame(0, pose=lambda t: f.pose(t, rotation=(0, 0, 0, 0))), f.frame(1)), "no direction")
given("recording", "focal-negative.mcap",
      f.mcap(f.channels(), f.frame(0, camera_info=lambda t: f.camera_info(t, k=(-9, 0, 8, 0, 40, 8, 0, 0, 1)))), "no camera matrix")
given("recording", "distortion-huge.mcap",
      f.mcap(f.channels(), f.frame(0, camera_info=lambda t: f.camera_info(t, d=(1e300, 0, 0, 0, 0)))), "D has a coefficient")
given("bag", "distortion-of-2^32.mcap",
      f.mcap(f.channels(), f.frame(0, camera_info=lambda t: f.camera_info(t)[:64] + b"\xff" * 8)))
given("recording", "escapes.mcap",
      lambda: f.mcap(f.channels(f"/{f.ESCAPE}/"), f.metadata("trim3r", {"clock": f.ESCAPE}), f.frame(0), f.frame(1)), None)
given("recording", "escapes-in-encoding.mcap",
      f.mcap(f.channels(f"/{f.ESCAPE}/"), f.frame(0, image=lambda t: f.image(t, encoding=f.ESCAPE))), None)
given("recording", "escapes-in-lens.mcap",
      f.mcap(f.channels(), f.frame(0, camera_info=lambda t: f.camera_info(t, d=(1,), model=f.ESCAPE))), "distortion_model")
given("recording", "escapes-in-schema.mcap",
      f.mcap(f.record(3, struct.pack("<H", 1) + f.text(f.ESCAPE) + f.text(f.ESCAPE) + f.text(f.ESCAPE)),
             f.record(4, struct.pack("<HH", 1, 1) + f.text(f.ESCAPE) + f.text(f.ESCAPE) + f.text("")), f.frame(0)[:0]), None)


def bag(*messages, kind="tf2_msgs/msg/TFMessage", topic="/tf"):
    """Returns two frames without poses, and messages of another topic."""
    return f.mcap(f.channels(names=("image", "camera_info")), f.channel(9, topic, kind), *[f.message(9, 10**9, m) for m in messages],
                  *[f.message(1, 10**9 + i, f.image(10**9 + i)) + f.message(2, 10**9 + i, f.camera_info(10**9 + i)) for i in (0, 1)])


def picture_bag(form, data, **lies):
    kind, stamp = "sensor_msgs/msg/CompressedImage", 10**9
    return f.mcap(f.channel(1, "/camera/image/compressed", kind), f.message(1, stamp, f.compressed(stamp, form, data, **lies)))


given("bag", "tf-loop.mcap", bag(f.transforms(10**9, [("a", "b"), ("b", "c"), ("c", "a")])), "above itself")
given("bag", "tf-1000-deep.mcap", bag(f.transforms(10**9, [(f"f{i}", f"f{i + 1}") for i in range(1000)])), "more than 64 above it")
given("bag", "tf-5000-frames.mcap", bag(f.transforms(10**9, [("map", f"f{i}") for i in range(5000)])), "more than 1024 frames")
given("bag", "tf-200000-transforms.mcap",
      lambda: bag(*[f.transforms(10**9 + i, [("map", f"frame{i % 900}")] * 100) for i in range(2000)]), None)
given("bag", "tf-count-of-2^32.mcap", bag(f.transforms(10**9, [("map", "camera")], 0xFFFFFFFF)), "cut short")
given("bag", "tf-nan.mcap", bag(f.transforms(10**9, [("map", "camera")], place=(float("nan"), 0, 0, 0, 0, 0, 1))), "not a number")
given("bag", "tf-without-rotation.mcap", bag(f.transforms(10**9, [("map", "camera")], place=(0,) * 7)), "no direction")
given("bag", "tf-far-away.mcap", bag(f.transforms(10**9, [("map", "camera")], place=(1e300, 0, 0, 0, 0, 0, 1))), "within -2^31")
given("bag", "tf-two-parents.mcap", bag(f.transforms(10**9, [("map", "camera"), ("other", "camera")])), None)
given("bag", "tf-escapes.mcap", bag(f.transforms(10**9, [(f.ESCAPE, "camera")]), topic=f.ESCAPE), None)
given("bag", "tf-nameless.mcap", bag(f.transforms(10**9, [("", "camera")])), "no name")
given("bag", "compressed-65535.mcap", picture_bag("png", f.png(65535, 65535, rows=b"")), "PNG")
given("bag", "compressed-1000-scans.mcap", lambda: picture_bag("jpeg", f.jpeg(512, 1000)), "more than 32 scans")
given("bag", "compressed-cut.mcap", picture_bag("jpeg", f.jpeg(64, 2)[:150]), "JPEG")
given("bag", "compressed-empty.mcap", picture_bag("jpeg", b""), None)
given("bag", "compressed-lies.mcap", picture_bag("jpeg", b"\xff\xd8\xff", data_bytes=1 << 31), "cut short")
given("bag", "compressed-escapes.mcap", picture_bag(f.ESCAPE, b"neither of them"), None)

given("recording", "escapes-in-compression.mcap", f.mcap(f.chunk(f.ESCAPE, b"", 0)), "not supported")



# --- other files -----------------------------------------------------------------------------------------------------


@case("path", "pipe.mcap", "not a regular file")
def lone_pipe(path):
    os.mkfifo(path)


@case("path", "folder.mcap", "no pictures")
def lone_folder(path):
    os.mkdir(path)


@case("path", "zeros-of-a-terabyte.mcap", "not an MCAP file")
def sparse(path):
    with open(path, "wb") as file:
        file.truncate(1 << 40)


@case("path", "link-to-itself.mcap", "symbolic links")
def link(path):
    os.symlink(path, path)


given("path", "odd.splat", bytes(1000 * 32 + 7), "32 each")


# --- scenes ----------------------------------------------------------------------------------------------------------

given("scene", "2^31-vertices.ply", f.ply(1 << 31, rows=1), "over the limit")
given("scene", "2^24-vertices.ply", f.ply(1 << 24, rows=1), "cut off")
given("scene", "2^64-vertices.ply", f.ply("18446744073709551616", rows=1))
given("scene", "negative-vertices.ply", f.ply(-1, rows=1), "is no element")
given("scene", "list-property.ply", f.ply(behind="property list uchar int vertex_indices\n"), "has lists")
given("scene", "header-without-end.ply", b"ply\nformat binary_little_endian 1.0\n" + b"comment x\n" * 100000, "no end")
given("scene", "huge-header-line.ply", lambda: b"ply\ncomment " + b"x" * (8 * MIB) + b"\n", "")
given("scene", "skips-2^37-bytes.ply",
      f.ply(before="element face 16777216\n" + "".join(f"property double p{i}\n" for i in range(1000))), "cut off")
given("scene", "nan.ply", f.ply(3, values=[float("nan")] + [0] * 13), "not a finite number")
given("scene", "far-apart.ply", lambda: f.ply(2, rows=1) + struct.pack("<14f", 3e38, *([0] * 10), 1, 0, 0))
given("scene", "no-rotation.ply", f.ply(values=[0] * 14), "rotation without length")
given("scene", "escapes.ply", f.ply(before=f"{f.ESCAPE}\n"), "unknown header line")
given("scene", "4096-vertices-of-2^13-bytes.ply",
      f.ply(before="element face 16777216\n" + "".join(f"property double p{i}\n" for i in range(400))), "cut off")
given("scene", "16-million-of-zeros.spz", f.spz(1 << 24), "are read from")
given("large scene", "half-a-million-of-zeros.spz", f.spz(1 << 19), None)
given("large scene", "half-a-million-of-degree-3.spz", f.spz(1 << 19, degree=3), None)
given("scene", "streams-of-4-gb.spz", f.spz(1000, stream=f.zstd([(0, 1 << 32)])), "does not unpack")
given("scene", "table-at-4-gb.spz", f.spz(1000)[:16] + b"\xff" * 4 + f.spz(1000)[20:], "their table")
given("scene", "stream-of-2^63.spz", f.spz(1000)[:32] + b"\xff" * 8 + f.spz(1000)[40:], "cut off")
given("scene", "gzip-of-zeros.spz", lambda: gzip.compress(bytes(64 * MIB)), "not an .spz")
given("scene", "gzip-of-16-million.spz", lambda: gzip.compress(b"NGSP" + struct.pack("<IIBBBB", 3, 1 << 24, 0, 12, 0, 0)), "are read from")
given("scene", "gzip-cut-off.spz",
      lambda: gzip.compress(b"NGSP" + struct.pack("<IIBBBB", 2, 1 << 19, 3, 12, 0, 0) + bytes(30 << 20)), "what is packed")
given("scene", "not-a-row.splat", bytes(33), "are not those of")
given("scene", "million-of-zeros.splat", lambda: bytes(32 << 20), "half of the positions")
given("scene", "chunks-without-bounds.compressed.ply", f.ply(1, before="element chunk 1\n"), "no property min_x")
given("scene", "rows-beyond.glb", f.glb(f.gaussians(1 << 24), bytes(64)), "reach beyond")
given("scene", "rows-of-2^32.glb", f.glb(f.gaussians((1 << 32) - 1, stride=4294967295), bytes(64)), "reach beyond")
given("scene", "one-row-16-million-times.glb", f.glb(f.gaussians(1 << 24, stride=0), bytes(64)), "a type that is not read")
given("scene", "deep.glb", f.glb(b"[" * (1 << 20)), "not JSON")
given("scene", "8-million-values.glb", lambda: f.glb(b"[" + b"0," * 8000000 + b"0]"), "3000000 values")
given("scene", "3-million-nodes.glb",
      lambda: f.glb(json.dumps(f.gaussians(1)).encode()[:-1] + b', "nodes": [' + b"0," * 2900000 + b"0]}", bytes(64)), None)
given("scene", "moved.glb", f.glb(f.gaussians(1, nodes=[{"mesh": 0, "matrix": [0] * 16}]), bytes(64)), "last row")
given("scene", "flat.glb", f.glb(f.gaussians(1, nodes=[{"mesh": 0, "scale": [1, 0, 1]}]), bytes(64)), "make them flat")
given("scene", "far.glb", f.glb(f.gaussians(1, nodes=[{"mesh": 0, "translation": [1e300] * 3}]), struct.pack("<16f", *[1] * 16)), "half of the positions")
given("scene", "circle.glb", f.glb(f.gaussians(1, nodes=[{"mesh": 0, "children": [1]}, {"children": [0]}]), bytes(64)), "own children")
given("scene", "700000-nodes-deep.glb",
      lambda: f.glb(json.dumps(f.gaussians(1)).encode()[:-1] + b', "nodes": [' +
                    b",".join(b'{"children": [%d]}' % (i + 1) for i in range(700000)) + b', {"mesh": 0}]}', bytes(64)), None)
for member in ("nodes", "meshes", "extensionsRequired"):
    given("scene", f"object-of-{member}.glb", f.glb(f.gaussians(1, **{member: {"a": {}, "b": {}}}), bytes(64)), f"{member}: not an array")
given("scene", "object-of-children.glb", f.glb(f.gaussians(1, nodes=[{"mesh": 0, "children": {"a": 1}}]), bytes(64)), "children: not an array")
given("scene", "packed-otherwise.glb", f.glb(f.gaussians(1, extensionsRequired=[f.ESCAPE]), bytes(64)), "needs the extension")
given("scene", "no-members.sog", lambda: f.sog({}), "")
given("scene", "meta-of-64-mb.sog", lambda: f.sog({"meta.json": b" " * (64 * MIB)}), "")
given("scene", "16-million.sog", lambda: f.sog({"meta.json": f.sog_meta(1 << 24)}), "")
given("scene", "picture-of-16383x16383.sog", lambda: f.sog({"meta.json": f.sog_meta(1000), "x.webp": f.webp(16383, 16383)}), "")
given("scene", "escapes.sog", lambda: f.sog({"meta.json": f.sog_meta(9, f.ESCAPE)}), "")
given("scene", "escapes-in-format.ply", b"ply\nformat " + f.ESCAPE.encode() + b"\n", "binary_big_endian and ascii")


# --- pictures --------------------------------------------------------------------------------------------------------

given("picture", "1000-scans.jpg", lambda: f.jpeg(1024, 1000), "more than 32 scans")
given("picture", "32-scans-of-4096.jpg", lambda: f.jpeg(4096, 32), None)
given("picture", "65535x65535.jpg", lambda: f.jpeg(8)[:166] .replace(struct.pack(">HH", 8, 8), b"\xff\xff\xff\xff"), "")
given("picture", "cut.jpg", lambda: f.jpeg(512, 4)[:3000], "")
given("picture", "no-data.jpg", b"\xff\xd8\xff\xd9", "")
given("picture", "65535x65535.png", f.png(65535, 65535, rows=b"\0"), "")
given("picture", "2^31.png", f.png(0x7FFFFFFF, 0x7FFFFFFF, rows=b"\0"), "")
given("picture", "interlaced-bomb.png", lambda: f.png(4096, 4096, 16, 6, 1), None)
given("picture", "interlaced-cut.png", lambda: f.png(4096, 4096, 8, 2, 1, rows=bytes(1000)), "")
given("picture", "more-data-than-rows.png", lambda: f.png(16, 16, rows=bytes(64 * MIB)), None)
given("picture", "texts-of-8-mb.png",
      lambda: f.png(16, 16, before=f.png_chunk(b"zTXt", b"k\0\0" + zlib.compress(bytes(7 * MIB), 9)) * 900), None)
given("picture", "profile-of-500-mb.png",
      lambda: f.png(16, 16, before=f.png_chunk(b"iCCP", b"k\0\0" + zlib.compress(bytes(200 * MIB), 9))), None)
given("picture", "crc.png", f.png(16, 16, crc=1), "")
given("picture", "palette-missing.png", f.png(16, 16, colour=3), "")


# --- folders ---------------------------------------------------------------------------------------------------------


def transforms(path, text):
    os.makedirs(path)
    with open(f"{path}/transforms.json", "wb") as file:
        file.write(text if isinstance(text, bytes) else json.dumps(text).encode())
    with open(f"{path}/c.png", "wb") as file:
        file.write(f.png(16, 16))
    return path


def one_frame(**fields):
    return {"fl_x": 40, "frames": [{"file_path": "c.png", "transform_matrix": UNIT, **fields}]}


@case("folder", "20000-keys-4000-frames", "f0.png")
def many_keys(path):
    frames = [{"file_path": f"f{i}.png", "transform_matrix": UNIT} for i in range(4000)]
    return transforms(path, {**{f"x{i}": i for i in range(20000)}, "fl_x": 40, "frames": frames})


@case("folder", "frames-with-2900000-keys", "missing")
def keys_in_frames(path):
    keys = ",".join(f'"k{i}":"{i}"' for i in range(4000))
    return transforms(path, ('{"fl_x":40,"frames":[' + ",".join([f'{{"file_path":"no.png",{keys}}}'] * 725) + "]}").encode())


@case("folder", "33-million-values", "more than 3000000 values")
def many_values(path):
    return transforms(path, b'{"frames":[' + b"0," * (32 * MIB - 50) + b"0]}")


@case("folder", "65-mb-of-json", "too large")
def long_text(path):
    return transforms(path, b'{"a":"' + b"x" * (65 * MIB) + b'"}')


@case("folder", "deep-nesting", "not JSON")
def deep(path):
    return transforms(path, b'{"frames":' + b"[" * 1000000)


@case("folder", "nan-pose", "not a finite number")
def nan_pose(path):
    return transforms(path, json.dumps(one_frame(transform_matrix=[[float("nan")] * 4] * 4)).encode())


@case("folder", "infinite-pose", "not a finite number")
def infinite_pose(path):
    return transforms(path, json.dumps(one_frame()).replace("[1, 0, 0, 0]", "[1, 0, 0, 1e999]").encode())


@case("folder", "escapes", "c.png")
def escaped_names(path):
    return transforms(path, one_frame(file_path=f"{f.ESCAPE}/c.png"))


@case("folder", "escapes-in-model", "camera_model")
def escaped_model(path):
    return transforms(path, one_frame(camera_model=f.ESCAPE))


@case("folder", "pipe-as-picture", "not a regular file")
def pipe(path):
    transforms(path, one_frame(file_path="pipe.png"))
    os.mkfifo(f"{path}/pipe.png")


@case("folder", "pipe-as-list", "")
def pipe_of_poses(path):
    os.makedirs(path)
    os.mkfifo(f"{path}/transforms.json")


@case("folder", "device-as-picture", "not a regular file")
def device(path):
    return transforms(path, one_frame(file_path="/dev/zero"))


@case("folder", "folder-as-picture", "Is a directory")
def folder_as_picture(path):
    return transforms(path, one_frame(file_path="."))


@case("folder", "links-in-a-circle", "")
def circle(path):
    transforms(path, one_frame(file_path="a/a/a/a/a/b/c.png"))
    os.symlink(".", f"{path}/a")
    os.symlink("b", f"{path}/b")


def colmap(path, cameras=f.colmap_cameras(), images=f.colmap_images()):
    """Writes a model of COLMAP in text or binary."""
    os.makedirs(f"{path}/sparse/0")
    for name, content in (("cameras", cameras), ("images", images)):
        binary = isinstance(content, bytes)
        with open(f"{path}/sparse/0/{name}.{'bin' if binary else 'txt'}", "wb" if binary else "w") as file:
            file.write(content)


@case("folder", "colmap-2^64-cameras", "camera 2 of 18446744073709551615: the file ends in it")
def colmap_many_cameras(path):
    return colmap(path, struct.pack("<Q", (1 << 64) - 1) + f.colmap_cameras()[8:])


@case("folder", "colmap-2^64-images", "image 2 of 18446744073709551615: the file ends in it")
def colmap_many_images(path):
    return colmap(path, images=struct.pack("<Q", (1 << 64) - 1) + f.colmap_images()[8:])


@case("folder", "colmap-million-images", "more than 100000 images")
def colmap_million_images(path):
    return colmap(path, images=f.colmap_images(1000000))


@case("folder", "colmap-2^60-points", "reach past the file's end")
def colmap_many_points(path):
    return colmap(path, images=f.colmap_images(points=1 << 60))


@case("folder", "colmap-name-without-end", "a name of more than 4096 bytes")
def colmap_long_name(path):
    return colmap(path, images=f.colmap_images(name="x" * (8 * MIB)))


@case("folder", "colmap-escapes", "No such file")
def colmap_escapes(path):
    return colmap(path, images=f.colmap_images(name=f"{f.ESCAPE}.png"))


@case("folder", "colmap-nan", "norm is not 1")
def colmap_nan(path):
    return colmap(path, images=f.colmap_images(rotation=(float("nan"), 0, 0, 0)))


@case("folder", "colmap-wide-as-2^64", "a side is not")
def colmap_wide(path):
    return colmap(path, f.colmap_cameras(width=(1 << 64) - 1))


@case("folder", "colmap-images-of-a-terabyte", "more than 268435456 bytes")
def colmap_sparse(path):
    colmap(path, "7 PINHOLE 16 16 20 20 8 8\n", "")
    with open(f"{path}/sparse/0/images.txt", "wb") as file:
        file.write(b"1 1 0 0 0 0 0 0 7 a.png\n")
        file.truncate(1 << 40)


@case("folder", "colmap-pipe", "not a regular file")
def colmap_pipe(path):
    colmap(path)
    os.remove(f"{path}/sparse/0/images.bin")
    os.mkfifo(f"{path}/sparse/0/images.bin")


def dense(path, data):
    """Writes a model with one dense map."""
    colmap(path)
    for name, content in (("images/a.png", f.png(16, 16)), ("stereo/depth_maps/a.png.geometric.bin", data)):
        os.makedirs(os.path.dirname(f"{path}/{name}"))
        with open(f"{path}/{name}", "wb") as file:
            file.write(content)


@case("folder", "colmap-map-of-4096x4096", "fewer bytes than its sides need")
def short_map(path):
    dense(path, b"4096&4096&1&" + bytes(64))


@case("folder", "colmap-map-of-2^64x2^64", "does not begin with")
def wide_map(path):
    dense(path, b"18446744073709551616&18446744073709551616&1&" + bytes(64))


@case("folder", "colmap-map-of-100-mb", "too large")
def long_map(path):
    dense(path, b"16&16&1&" + bytes(100 * MIB))


def pose_files(path, pose="1 0 0 0 0 1 0 0 0 0 1 0", lens="20 0 8 0 20 8 0 0 1", name="0"):
    """Writes a folder of one pose, in ScanNet's form."""
    for folder, file, content in (("pose", f"{name}.txt", pose), ("intrinsic", "intrinsic_color.txt", lens)):
        os.makedirs(f"{path}/{folder}")
        with open(f"{path}/{folder}/{file}", "w", encoding="utf-8") as text:
            text.write(content)
    os.makedirs(f"{path}/color")
    with open(f"{path}/color/{name}.png", "wb") as picture:
        picture.write(f.png(16, 16))


@case("folder", "pose-file-of-100-mb", "too large")
def long_pose(path):
    return pose_files(path, pose="0 " * (50 * MIB))


@case("folder", "pose-file-of-escapes", "a word that is no number")
def escaped_pose(path):
    return pose_files(path, pose=f.ESCAPE, name=f.ESCAPE)


@case("folder", "pose-files-far-away", "2^30 or more")
def far_pose(path):
    return pose_files(path, pose="1 0 0 1e300 0 1 0 0 0 0 1 0")


@case("folder", "pose-files-lens-of-1e300", "8 to 16384 pixels")
def long_lens(path):
    return pose_files(path, lens="1e300 0 8 0 1e300 8 0 0 1")


@case("folder", "pose-files-depth-far-beside", "2^30 or more")
def far_depth(path):
    pose_files(path)
    with open(f"{path}/intrinsic/extrinsic_depth.txt", "w", encoding="utf-8") as text:
        text.write("1 0 0 1e300 0 1 0 0 0 0 1 0")


def seven_scenes(path, pose, name="frame-0"):
    """Writes a sequence of one frame, in 7-Scenes' form."""
    os.makedirs(path)
    for file, content in (("camera-intrinsics.txt", b"20 0 8 0 20 8 0 0 1"), (f"{name}.pose.txt", pose), (f"{name}.color.png", f.png(16, 16))):
        with open(f"{path}/{file}", "wb") as out:
            out.write(content)


@case("folder", "sequence-of-escapes", "a word that is no number")
def escaped_sequence(path):
    seven_scenes(path, f.ESCAPE.encode(), f.ESCAPE)


@case("folder", "sequence-of-100-mb", "too large")
def long_sequence(path):
    seven_scenes(path, b"0 " * (50 * MIB))


@case("folder", "101000-pose-files", "more than 100000 poses")
def many_poses(path):
    pose_files(path)
    for i in range(101000):
        os.symlink("0.txt", f"{path}/pose/a{i}.txt")


def record3d(path, depth=b"", **changes):
    """Writes a folder of one frame, in Record3D's form."""
    os.makedirs(f"{path}/rgbd")
    for name, content in (("0.png", f.png(16, 16)), ("0.depth", depth)):
        with open(f"{path}/rgbd/{name}", "wb") as file:
            file.write(content)
    content = {"w": 16, "h": 16, "dw": 16, "dh": 16, "K": [20, 0, 0, 0, 20, 0, 8, 8, 1], "poses": [[0, 0, 0, 1, 0, 0, 0]]}
    with open(f"{path}/metadata", "w", encoding="utf-8") as file:
        json.dump({**content, **changes}, file)


@case("folder", "record3d-short-depth", "fewer bytes than its sides need")
def short_depth(path):
    return record3d(path, bytes(16 * 16 * 4 - 1))


@case("folder", "record3d-long-depth", "too large")
def long_depth(path):
    return record3d(path, bytes(16 * 16 * 4 + 1))


@case("folder", "record3d-depth-of-a-terabyte", "too large")
def sparse_depth(path):
    record3d(path, dw=4096, dh=4096)
    with open(f"{path}/rgbd/0.depth", "wb") as file:
        file.truncate(1 << 40)


@case("folder", "record3d-wide-depth", "dw, dh: not whole numbers")
def wide_depth(path):
    return record3d(path, dw=1e300)


@case("folder", "record3d-pipe-as-depth", "not a regular file")
def depth_pipe(path):
    record3d(path)
    os.remove(f"{path}/rgbd/0.depth")
    os.mkfifo(f"{path}/rgbd/0.depth")


@case("folder", "record3d-million-poses", "more than 100000")
def many_record3d_poses(path):
    return record3d(path, poses=[[]] * 1000000)


def exr_depth(path, depth):
    """Writes a folder of one frame, in nerfstudio's form, whose depth is OpenEXR. Builds without the library refuse
    it."""
    os.makedirs(path)
    for name, content in (("0.png", f.png(16, 16)), ("0.exr", depth)):
        with open(f"{path}/{name}", "wb") as file:
            file.write(content)
    frame = {"file_path": "0.png", "depth_file_path": "0.exr", "transform_matrix": UNIT}
    with open(f"{path}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"fl_x": 16, "frames": [frame]}, file)


@case("folder", "exr-64-mb-of-70-kb", None)
def exr_zeros(path):
    return exr_depth(path, f.exr(4096, 4096))


@case("folder", "exr-262144-tiles", None)
def exr_tiles(path):
    return exr_depth(path, f.exr(4096, 4096, 8))


@case("folder", "exr-tiles-of-4", "OpenEXR")
def exr_small_tiles(path):
    return exr_depth(path, f.exr(256, 256, 4))


@case("folder", "exr-cut", "OpenEXR")
def exr_cut(path):
    return exr_depth(path, f.exr(4096, 4096, 0, 3))


@case("folder", "exr-of-2^31", "OpenEXR")
def exr_wide(path):
    return exr_depth(path, f.exr(1 << 31, 1 << 31, 0, 1))


@case("folder", "tum-escapes", "")
def tum(path):
    os.makedirs(path)
    for name, line in (("rgb.txt", f"1.0 {f.ESCAPE}.png"), ("groundtruth.txt", "1.0 0 0 0 0 0 0 1")):
        with open(f"{path}/{name}", "w", encoding="utf-8") as file:
            file.write(line + "\n")


@case("folder", "freiburg1-8-million-lines", "more than 1000000 entries")
def tum_lines(path):
    os.makedirs(path)
    with open(f"{path}/rgb.txt", "w", encoding="utf-8") as file:
        file.write("1 a\n" * 8000000)
    with open(f"{path}/groundtruth.txt", "w", encoding="utf-8") as file:
        file.write("1 0 0 0 0 0 0 1\n")


# --- arrays ----------------------------------------------------------------------------------------------------------


def pointmaps(shape, count=None, byte=0, name="pts3d.npy"):
    total = count if count is not None else 4
    for side in shape if count is None else ():
        total *= side
    return name, *f.deflated(f.npy_head(shape), byte, total)


given("points", "4-gb-of-1000-views.npz", lambda: f.archive([pointmaps((1000, 580, 570, 3), 4 * 10**8)]), "")
given("points", "400-mb-of-2-views.npz", lambda: f.archive([pointmaps((2, 4096, 4096, 3))]), "may unpack to")
given("points", "below-the-limit.npz", lambda: f.archive([pointmaps((2, 2300, 2300, 3), byte=63)]), None)
given("points", "overlapping-entries.npz",
      lambda: f.archive([pointmaps((2, 900, 900, 3)), pointmaps((2, 900, 900, 3), name="conf.npy")], shared=True), "")
given("points", "header-of-2^30-squared.npz", lambda: f.archive([pointmaps((1 << 29, 1 << 29, 3), 64)]), "2^30 numbers")
given("points", "header-lies-more.npz", lambda: f.archive([pointmaps((2, 64, 64, 3), 64)]), "cut off")
given("points", "header-lies-less.npz", lambda: f.archive([pointmaps((2, 4, 4, 3), 1 << 20)]), "bytes of numbers")
given("points", "size-lies.npz",
      lambda: f.archive([(n, d, c, 2 * 64 * 64 * 12 + 128) for n, d, c, _ in [pointmaps((2, 64, 64, 3), 64)]]), "")
given("points", "crc.npz", lambda: f.archive([(n, d, c ^ 1, s) for n, d, c, s in [pointmaps((2, 64, 64, 3))]]), "CRC")
given("points", "nan.npz", lambda: f.archive([pointmaps((2, 64, 64, 3), byte=255)]), "not a number")
given("points", "cut.npz", lambda: f.archive([pointmaps((2, 64, 64, 3))])[:-30], "zip archive")
given("points", "4-billion-entries.npz", b"PK\5\6" + struct.pack("<HHHHIIH", 0, 0, 65535, 65535, 1 << 31, 0, 0), "zip archive")
given("points", "escapes.npz", lambda: f.archive([pointmaps((2, 4, 4, 3), name=f.ESCAPE)]), "no array")
given("points", "cut.npy", f.npy_head((2, 64, 64, 3)) + bytes(99), "cut off")
given("points", "header-of-4-gb.npy", b"\x93NUMPY\2\0" + struct.pack("<I", 0xFFFFFFF0) + b"{", "cut off in its header")
given("points", "deep-shape.npy", f.npy_head("(" * 4000 + "1"), "")


def colliding(count):
    """Finds texts that share the low bits of their FNV-1a hashes."""
    found = {}
    for i in range(1 << 20):
        text, value = b"%x" % i, 2166136261
        for byte in text:
            value = (value ^ byte) * 16777619 & 0xFFFFFFFF
        found.setdefault(value & 0x3FF, []).append(text)
        if len(found[value & 0x3FF]) == count:
            break
    return max(found.values(), key=len)


# --- tables, poses, heads --------------------------------------------------------------------------------------------

given("table", "escapes.csv", lambda: f"scene,psnr,build_ms\n{f.ESCAPE},30,1\n".encode(), "control character")
given("table", "row-of-9-mb.csv", lambda: b"psnr,build_ms\n" + b"9" * (9 * MIB) + b",1\n", "16384 bytes")
given("table", "900-columns.csv", b",".join([b"psnr"] * 900) + b"\n", "256 cells")
given("table", "million-rows.csv", lambda: b"psnr,build_ms\n" + b"30,1\n" * 1000000, "")
given("table", "2-million-texts.csv",
      lambda: b"method,head,bits,refine,allocate,depth,wavelet,levels,clusters,settings,psnr,build_ms\n" +
      b"".join(b"%x,%x,%x,%x,%x,%x,%x,%x,%x,%x,30,1\n" % tuple(range(10 * i, 10 * i + 10)) for i in range(180000)), None)
given("table", "colliding-texts.csv",
      lambda: b"scene,psnr,build_ms\n" + b"".join(b"%s,30,1\n" % text for text in colliding(400)), "collide")
given("table", "quote-without-end.csv", b'psnr,build_ms\n"' + b"x\n" * 100000, "")
given("table", "nan.csv", b"psnr,build_ms\ninf,1\n", "")

given("json", "deep.json", lambda: b"[" * 1000000, "not JSON")
given("json", "8-million-values.json", lambda: b"[" + b"0," * 8000000 + b"0]", "")
given("json", "escapes.json", lambda: json.dumps({"hash": f.ESCAPE, "fl_x": f.ESCAPE}).encode(), "")
given("json", "pose-of-1e308.json",
      json.dumps({"fl_x": 40, "w": 16, "h": 16, "transform_matrix": [[1, 0, 0, 1e308]] + UNIT[1:]}).encode(), "")

given("trajectory", "nan.txt", b"1 nan 0 0 0 0 0 1\n", "")
given("trajectory", "huge-number.txt", lambda: b"9" * (9 * MIB) + b" 0 0 0 0 0 0 1\n", "")
given("trajectory", "3-million-poses.txt", lambda: b"1 0 0 0 0 0 0 1\n" * 3000000, "more than 2097152 poses")
given("trajectory", "escapes.txt", f.ESCAPE.encode(), "")
given("trajectory", "zeros.txt", lambda: bytes(MIB), "")

given("head", "header-of-2^63.safetensors", f.safetensors(b"{}", length=1 << 63), "a header of")
given("head", "million-values.safetensors", lambda: f.safetensors(b'{"a":[' + b"0," * 1000000 + b"0]}"), "a header of")
given("head", "deep.safetensors", lambda: f.safetensors(b"[" * 1000000), "JSON")
given("head", "tensor-of-2^62.safetensors",
      f.safetensors({"a": {"dtype": "F32", "shape": [2**31, 2**31], "data_offsets": [0, 2**62]}}), "2^32 elements")
given("head", "overlapping.safetensors",
      f.safetensors({n: {"dtype": "F32", "shape": [1], "data_offsets": [0, 4]} for n in "ab"}, bytes(4)), "overlaps")
given("head", "escapes.safetensors",
      f.safetensors({f.ESCAPE: {"dtype": "F64", "shape": [1], "data_offsets": [0, 4]}}, bytes(4)), "dtype")
given("weights", "zeros.t3w", bytes(4096), "")
given("weights", "says-4-gb.t3w", b"T3RW" + struct.pack("<HHI", 1, 6, 0xFFFFFFFF) + bytes(500), "")
given("weights", "escapes.t3w", b"T3RW" + f.ESCAPE.encode() * 20, "")
