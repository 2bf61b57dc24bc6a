/* SPDX-License-Identifier: Apache-2.0 */
// What our reader makes of a file (JSON of `recording_tool dump` on stdin), against the sample's values.
//   recording_tool dump FILE | node check_dump.mjs ENCODING
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import * as sample from "./sample.mjs";

const [encoding] = process.argv.slice(2);
const dump = JSON.parse(readFileSync(0, "utf8"));

// x * 2^bits, round-half-even, exactly: a double times a power of two is exact in range.
function fixed(x, bits) {
  const scaled = x * 2 ** bits;
  const floor = Math.floor(scaled), rest = scaled - floor;
  const up = rest > 0.5 || (rest === 0.5 && floor % 2 !== 0);
  return up ? floor + 1 : floor;
}
const hex = (bytes) => Buffer.from(bytes).toString("hex");

assert.equal(dump.note, "");
assert.equal(dump.clock, "synthetic");
assert.equal(dump.bits_epoch, 1);
assert.deepEqual(dump.triplets, sample.TRIPLETS.split(";").map((t) => t.split(",").map(Number)));
assert.equal(dump.frames.length, sample.FRAMES);
for (const [f, frame] of dump.frames.entries()) {
  const first = sample.step(encoding) * sample.HEIGHT, data = sample.image(encoding, f);
  const [fx, , cx, , fy, cy] = sample.k(f);
  const { x, y, z } = sample.position(f), q = sample.orientation(f), z16 = sample.depth(f);
  const d = [...sample.d(f), 0].slice(0, 5);
  assert.deepEqual(frame, {
    index: f, stamp_ns: `${sample.stampNs(f)}`, encoding, width: sample.WIDTH, height: sample.HEIGHT,
    plane0: hex(data.subarray(0, first)), plane1: hex(data.subarray(first)),
    ...(z16 && {
      depth_width: sample.DEPTH_WIDTH, depth_height: sample.DEPTH_HEIGHT,
      depth_unit_q40: `${fixed(Number(sample.DEPTH_UNIT), 40)}`,
      depth: hex(Uint8Array.from(z16.flatMap((v) => [v & 255, v >> 8]))),
    }),
    fx_fy_cx_cy_q16: [fx, fy, cx, cy].map((v) => fixed(v, 16)),
    distortion: f, distortion_q24: d.map((v) => fixed(v, 24)),
    position_q32: [x, y, z].map((v) => `${fixed(v, 32)}`),
    rotation_q30: [q.w, q.x, q.y, q.z].map((v) => fixed(v, 30)),
  }, `frame ${f}`);
}
console.log(`${encoding}: ${dump.frames.length} frames as written`);
