# SPDX-License-Identifier: Apache-2.0
"""JPEGs whose decoded samples are known exactly, because every block has one colour. Baseline, 4:2:2 (ITU-T T.81)."""
import struct

STEP = 8  # quantization step with which a block's coefficient is its sample minus 128 (T.81, A.3.3: DC = 8 x the mean)
DC_LENGTHS = (0, 1, 5, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0)  # T.81, table K.3
DC_CODES = {0: "00", 1: "010", 2: "011", 3: "100", 4: "101", 5: "110", 6: "1110", 7: "11110", 8: "111110"}
END_OF_BLOCK = "0"  # the only code of the AC table


def segment(marker, content):
    return struct.pack(">BBH", 0xff, marker, len(content) + 2) + content


def headers(width, height):
    frame = struct.pack(">BHHB", 8, height, width, 3) + bytes((1, 0x21, 0, 2, 0x11, 0, 3, 0x11, 0))
    return (b"\xff\xd8" + segment(0xdb, bytes([0] + [STEP] * 64)) + segment(0xc0, frame) +
            segment(0xc4, bytes([0x00, *DC_LENGTHS, *range(12)])) + segment(0xc4, bytes([0x10, 1] + [0] * 15 + [0])) +
            segment(0xda, bytes((3, 1, 0, 2, 0, 3, 0, 0, 63, 0))))


def coded(difference):
    """Encodes a difference (T.81, F.1.2.1): the number of bits, then the bits; for a negative difference, the bits
    of the difference minus one."""
    size = abs(difference).bit_length()
    bits = difference if difference >= 0 else difference + (1 << size) - 1
    return DC_CODES[size] + (f"{bits:0{size}b}" if size else "") + END_OF_BLOCK


def jpeg(width, height, blocks):
    """Makes a JPEG of `blocks`: rows of 16x8 pixels, each (luma left, luma right, Cb, Cr); neighbours in coding
    order differ by less than 256."""
    last, bits = [128, 128, 128], []
    for left, right, cb, cr in (block for row in blocks for block in row):
        for component, sample in ((0, left), (0, right), (1, cb), (2, cr)):
            bits.append(coded(sample - last[component]))
            last[component] = sample
    text = "".join(bits)
    text += "1" * (-len(text) % 8)
    packed = int(text, 2).to_bytes(len(text) // 8, "big").replace(b"\xff", b"\xff\x00")
    return headers(width, height) + packed + b"\xff\xd9"


def rgb(luma, cb, cr):
    """Decodes a pixel like libjpeg: JFIF's matrix with 16 fraction bits (jdcolor.c)."""
    def fix(x):
        return int(x * 65536 + 0.5)
    cb, cr, half = cb - 128, cr - 128, 1 << 15
    red = luma + (fix(1.40200) * cr + half >> 16)
    green = luma + (-fix(0.34414) * cb - fix(0.71414) * cr + half >> 16)
    blue = luma + (fix(1.77200) * cb + half >> 16)
    return bytes(min(max(x, 0), 255) for x in (red, green, blue))


def decoded(blocks):
    """Returns the samples of jpeg(), rows of R, G, B; chroma is repeated, not interpolated."""
    out = []
    for row in blocks:
        line = b"".join(rgb(left, cb, cr) * 8 + rgb(right, cb, cr) * 8 for left, right, cb, cr in row)
        out.append(line * 8)
    return b"".join(out)
