/* SPDX-License-Identifier: Apache-2.0 */
// The values of the sample recording, told again independently of sample.c (sample.h says them in words).
export const FRAMES = 3, WIDTH = 6, HEIGHT = 4, DEPTH_WIDTH = 3, DEPTH_HEIGHT = 2;

// Bytes a row of plane 0, and rows of all planes together.
const LAYOUTS = {
  rgb8: [3, HEIGHT], bgr8: [3, HEIGHT], mono8: [1, HEIGHT], yuv422_yuy2: [2, HEIGHT], yuv422: [2, HEIGHT],
  nv12: [1, HEIGHT + HEIGHT / 2],
};
export const ENCODINGS = Object.keys(LAYOUTS);

export const step = (encoding) => WIDTH * LAYOUTS[encoding][0];

export function image(encoding, f) {
  const bytes = new Uint8Array(step(encoding) * LAYOUTS[encoding][1]);
  const first = step(encoding) * HEIGHT;
  for (let i = 0; i < bytes.length; i++) {
    const plane = i < first ? 0 : 1;
    bytes[i] = 7 * f + 31 * plane + 13 * (i - plane * first);
  }
  return bytes;
}

export function depth(f) {
  if (f === 1) return undefined;
  return Array.from({ length: DEPTH_WIDTH * DEPTH_HEIGHT }, (_, i) => (i === 1 ? 0 : 1000 + 257 * i + 16 * f));
}

export const stampNs = (f) => 5000000000n + 33333333n * BigInt(f);
export const stamp = (f) => ({ sec: Number(stampNs(f) / 1000000000n), nanosec: Number(stampNs(f) % 1000000000n) });
export const k = (f) => [100.25 + f, 0, 2.5, 0, 101.5, 1.5 - f, 0, 0, 1];
export const model = (f) => (f === 2 ? "equidistant" : "plumb_bob");
export const d = (f) => [[0, 0, 0, 0, 0], [0.1, -0.2, 0.001, 0.002, 0.05], [0.01, 0.02, -0.03, 0.04]][f];
export const position = (f) => ({ x: f / 3, y: -2.5, z: 1e-3 * f });
export const orientation = (f) => (f === 1 ? { x: 0, y: 0, z: 0, w: 1 } : { x: 0.5, y: -0.5, z: 0.5, w: 0.5 });
export const TRIPLETS = "0,2,1;1,0,2";
export const DEPTH_UNIT = "0.0002";
