/* SPDX-License-Identifier: Apache-2.0 */
"use strict";
/* The chunks of a recording, which the reader in C passes in. What they unpack to has the room that the reader allows. */
const WINDOW_LOG_MOST = 26; /* 64 MiB, as in the program; checked of a chunk's first frame */
const TOO_LONG = "its data are longer than its uncompressed_size", CUT_SHORT = "its compressed data are cut short";

/* Unpacks Zstandard into `out`; returns how many bytes it filled. */
function unpackZstandard(bytes, out) {
  if (bytes.length < 6) throw new Error(CUT_SHORT);
  if ((bytes[4] & 32) === 0 && 10 + (bytes[5] >> 3) > WINDOW_LOG_MOST) throw new Error("it needs too large a window");
  let count = 0;
  new fzstd.Decompress((part) => {
    if (part.length > out.length - count) throw new Error(TOO_LONG);
    out.set(part, count);
    count += part.length;
  }).push(bytes, true);
  return count;
}

/* LZ4: places in a frame's header, and the bits of its flags. */
const LZ4 = { magic: 0x184d2204, header: 7, blockSums: 16, contentSize: 8, contentSum: 4, dictionary: 1, stored: 2 ** 31 };

/* Unpacks a block of LZ4 into `out` from `count` on; returns where it ends. */
function unpackBlock(block, out, count) {
  let at = 0;
  const more = (length) => {
    for (let byte = 255; length >= 15 && byte === 255; length += byte) if ((byte = block[at++]) === undefined) throw new Error(CUT_SHORT);
    return length;
  };
  const fit = (length) => { if (length > out.length - count) throw new Error(TOO_LONG); };
  while (at < block.length) {
    const token = block[at++], literals = more(token >> 4);
    if (literals > block.length - at) throw new Error(CUT_SHORT);
    fit(literals);
    out.set(block.subarray(at, at + literals), count);
    at += literals;
    count += literals;
    if (at === block.length) break; /* the last sequence has no match */
    const back = block[at++] | block[at++] << 8, length = more(token & 15) + 4;
    if (back === 0 || back > count) throw new Error("a match lies before its data");
    fit(length);
    for (const end = count + length; count < end; count++) out[count] = out[count - back];
  }
  return count;
}

/* Unpacks a frame of LZ4 into `out`; returns how many bytes it filled. */
function unpackLz4(bytes, out) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length), flags = bytes[4];
  if (bytes.length < LZ4.header || view.getUint32(0, true) !== LZ4.magic || flags >> 6 !== 1 || flags & LZ4.dictionary) throw new Error("it is no frame of LZ4");
  let at = LZ4.header + (flags & LZ4.contentSize ? 8 : 0), count = 0;
  for (;;) {
    if (at + 4 > bytes.length) throw new Error(CUT_SHORT);
    const word = view.getUint32(at, true), size = word % LZ4.stored;
    at += 4;
    if (word === 0) return count;
    if (size > bytes.length - at) throw new Error(CUT_SHORT);
    const block = bytes.subarray(at, at + size);
    if (word < LZ4.stored) {
      count = unpackBlock(block, out, count);
    } else {
      if (size > out.length - count) throw new Error(TOO_LONG);
      out.set(block, count);
      count += size;
    }
    at += size + (flags & LZ4.blockSums ? 4 : 0);
  }
}

/* Unpacks a chunk in the module's memory, and stores the number of bytes; returns the address of what is wrong, or 0. */
function unpackChunk(isLz4, from, count, to, room, producedAt) {
  let produced = 0, wrong = 0;
  try {
    produced = (isLz4 ? unpackLz4 : unpackZstandard)(bytesAt(from >>> 0, count >>> 0), bytesAt(to >>> 0, room >>> 0));
  } catch (error) {
    wrong = placeText(error.message);
  }
  new DataView(files.memory.buffer).setUint32(producedAt >>> 0, produced, true);
  return wrong;
}
