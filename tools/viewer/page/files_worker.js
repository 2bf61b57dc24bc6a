/* SPDX-License-Identifier: Apache-2.0 */
"use strict";
/* Reads or writes one scene file, or reads a recording, by the program's own C code. */
const ENOSYS = 52;
/* The C library asks for files that do not exist here: all that is read or written is in memory. */
const system = new Proxy({}, { get: () => () => ENOSYS, has: () => true });

let files;
const bytesAt = (at, count) => new Uint8Array(files.memory.buffer, at, count);

function place(bytes) {
  const at = files.room(Math.max(1, bytes.length)) >>> 0;
  if (at === 0) throw new Error("out of memory");
  bytesAt(at, bytes.length).set(bytes);
  return at;
}

const placeText = (text) => place(new TextEncoder().encode(`${text}\0`));

function textAt(at) {
  const rest = new Uint8Array(files.memory.buffer, at >>> 0);
  return new TextDecoder().decode(rest.subarray(0, rest.indexOf(0)));
}

const text = () => textAt(files.text());

function need(status) {
  if (status !== 0) throw new Error(text());
}

const result = () => bytesAt(files.bytes() >>> 0, files.count() >>> 0).slice();

/* Unpacks a stream of gzip or deflate, unless it grows beyond so many bytes. */
async function unpacked(packed, format, most) {
  const parts = [];
  let count = 0;
  const reader = new Blob([packed]).stream().pipeThrough(new DecompressionStream(format)).getReader();
  for (let part; !(part = await reader.read()).done;) {
    parts.push(part.value);
    count += part.value.length;
    if (count > most) throw new Error(`it unpacks to more than ${most} bytes`);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

const isGzip = (bytes) => bytes[0] === 0x1f && bytes[1] === 0x8b;

/* An .spz of version 4: places in its header (tools/scene/formats/spz/spz.h), and the bytes of an entry of its table. */
const SPZ = { version: 4, streams: 15, table: 16, header: 32, entry: 16 };
const isSpz4 = (bytes) => bytes.length >= SPZ.header && String.fromCharCode(...bytes.subarray(0, 4)) === "NGSP" && bytes[SPZ.version] === 4;

/* Unpacks the streams of such a file, and says in its table that they are as long as unpacked. A file whose table is
 * wrong stays as it is, so that the reader names the fault. */
function withoutZstandard(bytes) {
  const view = new DataView(bytes.buffer), first = view.getUint32(SPZ.table, true), count = bytes[SPZ.streams];
  const most = files.unpacked_most(bytes.length), end = first + count * SPZ.entry;
  if (end > bytes.length) return bytes;
  const parts = [bytes.slice(0, end)], table = new DataView(parts[0].buffer);
  let at = end, whole = 0;
  for (let entry = first; entry < end; entry += SPZ.entry) {
    const packed = Number(view.getBigUint64(entry, true)), size = Number(view.getBigUint64(entry + 8, true));
    whole += size;
    if (whole > most) throw new Error(`it unpacks to more than ${most} bytes`);
    if (packed > bytes.length - at) return bytes;
    parts.push(fzstd.decompress(bytes.subarray(at, at + packed), new Uint8Array(size)));
    table.setBigUint64(entry, BigInt(size), true);
    at += packed;
  }
  const bare = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  parts.reduce((place, part) => { bare.set(part, place); return place + part.length; }, 0);
  return bare;
}

async function read({ name, bytes: buffer }) {
  const given = new Uint8Array(buffer), most = files.unpacked_most(given.length);
  const bytes = isGzip(given) ? await unpacked(given, "gzip", most) : isSpz4(given) ? withoutZstandard(given) : given;
  if (isZip(given)) await openArchive(given);
  need(files.read(placeText(name), place(bytes), bytes.length));
  return { bundle: result().buffer, start: cameraFrom(files.start), text: text(), gaussians: files.gaussians() };
}

/* Returns a camera whose numbers the module gives one by one. */
function cameraFrom(number) {
  const numbers = Array.from({ length: 13 }, (_, i) => number(i));
  return { focal: numbers.slice(0, 2), centre: numbers.slice(2, 4), position: numbers.slice(4, 7), rotation: numbers.slice(7, 11),
           width: numbers[11], height: numbers[12] };
}

/* Reads a recording, to build scenes from the frames of `context`, and to compare them with those of `compared`; of
 * empty lists the module chooses the frames. */
function record({ name, bytes, context, compared }) {
  const list = (frames) => [place(new Uint8Array(Uint32Array.from(frames).buffer)), frames.length];
  need(files.record(placeText(name), place(new Uint8Array(bytes)), bytes.byteLength, ...list(context), ...list(compared)));
  const frames = Array.from({ length: files.viewpoints() }, (_, i) => ({ name: textAt(files.viewpoint_name(i)), recorded: true,
                                                                         ...cameraFrom((number) => files.viewpoint(i, number)) }));
  const path = Array.from({ length: files.places() }, (_, i) => Array.from({ length: 7 }, (__, number) => files.place(i, number + 4)));
  return { bundle: result().buffer, frames, path, views: files.views(), valid: files.valid(), gaussians: files.gaussians(), text: text() };
}

function write({ name, scene }) {
  need(files.write(placeText(name), place(scene)));
  return { bytes: result(), text: text() };
}

const answers = { read, record, write };
onmessage = async ({ data }) => {
  try {
    files = (await WebAssembly.instantiate(data.wasm, { wasi_snapshot_preview1: system, page: { json: placeJson, member: placeMember, unpack: unpackChunk } })).instance.exports;
    files._initialize();
    postMessage(await answers[data.kind](data));
  } catch (error) {
    postMessage({ failed: error.message });
  }
};
