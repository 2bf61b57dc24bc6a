/* SPDX-License-Identifier: Apache-2.0 */
"use strict";
/* A zip archive for the readers in C. The browser unpacks its members, and decodes those that are WebP. */
const ZIP = { end: 0x06054b50, endBytes: 22, entry: 0x02014b50, entryBytes: 46, local: 0x04034b50, localBytes: 30, comment: 65535 };
const STORED = 0, DEFLATED = 8;
const CRC = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let bit = 0; bit < 8; bit++) n = n & 1 ? 0xedb88320 ^ n >>> 1 : n >>> 1;
  return n;
});
const crc32 = (bytes) => ~bytes.reduce((crc, byte) => CRC[(crc ^ byte) & 255] ^ crc >>> 8, -1) >>> 0;
const isZip = (bytes) => String.fromCharCode(...bytes.subarray(0, 4)) === "PK\x03\x04";

/* Returns the entries of the directory at the archive's end. Throws a RangeError where one lies beyond the bytes. */
function entriesOf(view, bytes) {
  const last = bytes.length - ZIP.endBytes;
  let end = last;
  while (view.getUint32(end, true) !== ZIP.end) if (--end < last - ZIP.comment) throw new RangeError();
  const entries = [];
  let at = view.getUint32(end + 16, true);
  for (let left = view.getUint16(end + 10, true); left > 0; left--) {
    const short = (place) => view.getUint16(at + place, true), long = (place) => view.getUint32(at + place, true);
    if (long(0) !== ZIP.entry) throw new RangeError();
    const local = long(42), name = at + ZIP.entryBytes;
    if (view.getUint32(local, true) !== ZIP.local) throw new RangeError();
    const first = local + ZIP.localBytes + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
    if (first + long(20) > bytes.length) throw new RangeError();
    entries.push({ name: new TextDecoder().decode(bytes.subarray(name, name + short(28))), method: short(10), crc: long(16),
                   size: long(24), packed: bytes.subarray(first, first + long(20)) });
    at = name + short(28) + short(30) + short(32);
  }
  return entries;
}

/* Returns the size that a lossless WebP states; null: it is none. */
function webpSize(bytes) {
  if (bytes.length < 25 || String.fromCharCode(...bytes.subarray(8, 16)) !== "WEBPVP8L") return null;
  const bits = new DataView(bytes.buffer, bytes.byteOffset).getUint32(21, true);
  return { width: (bits & 16383) + 1, height: (bits >>> 14 & 16383) + 1 };
}

/* Returns the texels of a lossless WebP, 4 bytes each: red, green, blue, alpha. The decoder's own format is taken,
 * because its conversion into another one scales colours by alpha and back. */
async function decoded(bytes) {
  const decoder = new ImageDecoder({ data: bytes, type: "image/webp", premultiplyAlpha: "none", colorSpaceConversion: "none" });
  const { image } = await decoder.decode(), texels = new Uint8Array(4 * image.codedWidth * image.codedHeight);
  await image.copyTo(texels);
  decoder.close();
  for (let at = 0; at < texels.length && image.format.startsWith("B"); at += 4) [texels[at], texels[at + 2]] = [texels[at + 2], texels[at]];
  return texels;
}

/* A WebP of one texel, which is nearly transparent. A browser that scales colours by alpha reads other ones. */
const PROBE = { file: "UklGRiIAAABXRUJQVlA4TBUAAAAvAAAAEAdQsiJXRiGAAChoYkRE/wMA", texel: "200,100,50,3" };
let isExact = null;
async function needExactPictures() {
  const bytes = Uint8Array.from(atob(PROBE.file), (character) => character.charCodeAt(0));
  isExact ??= await decoded(bytes).then((texels) => texels.join() === PROBE.texel, () => false);
  if (!isExact) throw new Error("this browser does not read WebP without loss (no ImageDecoder)");
}

/* Returns width, height, and 4 bytes a texel. */
async function texelsOf(bytes, { width, height }) {
  await needExactPictures();
  const texels = await decoded(bytes), out = new Uint8Array(8 + texels.length), view = new DataView(out.buffer);
  view.setUint32(0, width, true);
  view.setUint32(4, height, true);
  out.set(texels, 8);
  return out;
}

/* Unpacks all members, unless they grow beyond what the archive's size justifies. */
let members = new Map();
async function openArchive(bytes) {
  const most = files.unpacked_most(bytes.length);
  let entries, whole = 0;
  try {
    entries = entriesOf(new DataView(bytes.buffer, bytes.byteOffset, bytes.length), bytes);
  } catch {
    throw new Error("no zip archive that can be read");
  }
  const take = (count) => { if ((whole += count) > most) throw new Error(`it unpacks to more than ${most} bytes`); };
  for (const { name, method, crc, size, packed } of entries) {
    take(size);
    const member = method === STORED ? packed : method === DEFLATED ? await unpacked(packed, "deflate-raw", size) : null;
    if (member === null || member.length !== size || crc32(member) !== crc) throw new Error(`${name}: it cannot be read`);
    const picture = webpSize(member);
    if (picture) take(4 * picture.width * picture.height);
    members.set(name, picture ? await texelsOf(member, picture).catch((error) => { throw new Error(`${name}: ${error.message}`); }) : member);
  }
}

/* Returns the address of a copy of a member, with a 0 after it, and stores its size; 0: there is none of that name. */
function placeMember(name, countAt) {
  const member = members.get(textAt(name));
  if (!member) return 0;
  const at = files.room(member.length + 1) >>> 0;
  if (at === 0) throw new Error("out of memory");
  bytesAt(at, member.length).set(member);
  bytesAt(at + member.length, 1)[0] = 0;
  new DataView(files.memory.buffer).setUint32(countAt, member.length, true);
  return at;
}
