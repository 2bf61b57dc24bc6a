/* SPDX-License-Identifier: Apache-2.0 */
"use strict";
/* The runtime in a thread of its own. It answers the page's requests in order. */
let runtime, opened;

const ALIGN = 64, PAGE = 65536;
const STAGES = 9;

/* The module's memory: the page's bundle, then the arena, then the pictures. It only grows. */
let end;
function place(bytes) {
  const at = Math.ceil(end / ALIGN) * ALIGN;
  end = at + bytes;
  const missing = end - runtime.memory.buffer.byteLength;
  if (missing > 0) runtime.memory.grow(Math.ceil(missing / PAGE));
  return at;
}

let begun = 0, times = new Float64Array(STAGES), building = false, lastTold = 0;
const page = {
  progress(stage, done, total) {
    const now = performance.now();
    if (building && now - lastTold > 50) {
      lastTold = now;
      postMessage({ kind: "progress", stage, done, total });
    }
    return 0;
  },
  stage_ends(stage) {
    const now = performance.now();
    times[stage] += now - begun;
    begun = now;
  },
};

function need(status, what) {
  if (status !== 0) throw new Error(`${what}: status ${status}`);
}

async function open({ wasm, bundle, width, height, most }) {
  const { instance } = await WebAssembly.instantiate(wasm, { page });
  runtime = instance.exports;
  end = runtime.__heap_base.value;
  const at = place(bundle.byteLength);
  new Uint8Array(runtime.memory.buffer).set(new Uint8Array(bundle), at);
  const bytes = runtime.open(at, bundle.byteLength, most.width, most.height);
  if (bytes === 0) throw new Error("the runtime refuses the data of this page");
  const arena = place(bytes);
  need(runtime.start(arena, bytes), "start");
  const pixels = Math.max(most.width * most.height, width * height);
  opened = { width, height, arena: bytes, rgb: place(pixels * 3), depth: place(pixels * 4), alpha: place(pixels * 2) };
  return { arena: bytes, cpu: runtime.cpu() };
}

const hex = (hash) => BigInt.asUintN(64, hash).toString(16).padStart(16, "0");

function built() {
  const stages = [];
  for (let stage = 0; stage < STAGES; stage++) {
    const hash = BigInt.asUintN(64, runtime.hash(stage));
    if (hash !== 0n) stages.push({ stage, ms: times[stage], hash: hex(hash) });
  }
  return { gaussians: runtime.gaussians(), valid: runtime.valid_points(), exponent: runtime.exponent(), stages,
           hash: hex(runtime.hash(STAGES)) };
}

function build({ gaussians, frames }) {
  times = new Float64Array(STAGES);
  begun = performance.now();
  building = true;
  const status = runtime.build(gaussians);
  building = false;
  need(status, "build");
  const result = built();
  return { ...result, psnr: frames.map(psnr) };
}

function load({ frames }) {
  need(runtime.load(), "the scene");
  return { gaussians: runtime.gaussians(), valid: 0, exponent: runtime.exponent(), stages: [], hash: null,
           psnr: frames.map(psnr) };
}

const fixed = (value, bits) => Math.round(value * 2 ** bits);
const fixed64 = (value) => BigInt(Math.round(value * 4294967296));

function render(camera, width, height) {
  const start = performance.now();
  const { focal, centre, position, rotation } = camera;
  need(runtime.render(fixed(focal[0], 16), fixed(focal[1], 16), fixed(centre[0], 16), fixed(centre[1], 16),
                      ...position.map(fixed64), ...rotation.map((q) => fixed(q, 30)), width, height, opened.rgb,
                      opened.depth, opened.alpha), "the picture");
  return performance.now() - start;
}

const bytesAt = (at, count) => new Uint8Array(runtime.memory.buffer, at, count);
const shortsAt = (at, count) => new Uint16Array(runtime.memory.buffer, at, count);
const wordsAt = (at, count) => new Uint32Array(runtime.memory.buffer, at, count);

const recorded = (frame) => bytesAt(runtime.frame_rgb(frame), opened.width * opened.height * 3);

function psnr(camera, frame) {
  const { width, height } = opened;
  render(camera, width, height);
  const drawn = bytesAt(opened.rgb, width * height * 3), wanted = recorded(frame);
  let sum = 0;
  for (let i = 0; i < drawn.length; i++) sum += (drawn[i] - wanted[i]) ** 2;
  return sum === 0 ? Infinity : 10 * Math.log10(65025 * drawn.length / sum);
}

/* Maps 0..1 to dark blue, red and bright yellow, with rising lightness. */
const STOPS = [[4, 4, 22], [64, 16, 104], [140, 41, 105], [214, 72, 68], [249, 142, 34], [252, 236, 164]];
function heat(share, out, at) {
  const x = Math.min(Math.max(share, 0), 1) * (STOPS.length - 1), i = Math.min(Math.floor(x), STOPS.length - 2);
  for (let c = 0; c < 3; c++) out[at + c] = STOPS[i][c] + (STOPS[i + 1][c] - STOPS[i][c]) * (x - i);
}

function paint(count, pixel) {
  const out = new Uint8ClampedArray(count * 4);
  for (let i = 0; i < count; i++) {
    out[4 * i + 3] = 255;
    pixel(out, i, 4 * i);
  }
  return out;
}

const copied = (rgb) => (out, i, at) => {
  out[at] = rgb[3 * i];
  out[at + 1] = rgb[3 * i + 1];
  out[at + 2] = rgb[3 * i + 2];
};

const painters = {
  picture: (count) => copied(bytesAt(opened.rgb, count * 3)),
  depth(count) {
    const depth = wordsAt(opened.depth, count);
    let least = Infinity, most = 0;
    for (const z of depth) {
      if (z > 0 && z < least) least = z;
      if (z > most) most = z;
    }
    const range = Math.log(most / least) || 1;
    return (out, i, at) => { if (depth[i] > 0) heat(1 - Math.log(depth[i] / least) / range, out, at); };
  },
  alpha(count) {
    const alpha = shortsAt(opened.alpha, count);
    return (out, i, at) => { out[at] = out[at + 1] = out[at + 2] = alpha[i] >> 7; };
  },
  frame: (count, frame) => copied(recorded(frame)),
  error(count, frame) {
    const drawn = bytesAt(opened.rgb, count * 3), wanted = recorded(frame);
    return (out, i, at) => {
      let sum = 0;
      for (let c = 0; c < 3; c++) sum += Math.abs(drawn[3 * i + c] - wanted[3 * i + c]);
      heat(Math.sqrt(sum / 384), out, at);
    };
  },
  mask(count, frame) {
    const rgb = recorded(frame), words = wordsAt(runtime.plane(frame, 0), Math.ceil(count / 32));
    return (out, i, at) => {
      const retained = words[i >> 5] >>> (i & 31) & 1;
      for (let c = 0; c < 3; c++) out[at + c] = retained ? 96 + rgb[3 * i + c] * .62 : rgb[3 * i + c] * .28;
    };
  },
  clusters(count, frame) {
    const rgb = recorded(frame), label = shortsAt(opened.alpha, count); // alpha's memory is free: no picture is drawn now
    runtime.labels(frame, opened.alpha);
    return (out, i, at) => {
      if (label[i] === 65535) return;
      const light = .35 + .65 * (rgb[3 * i] + 2 * rgb[3 * i + 1] + rgb[3 * i + 2]) / 1020;
      const hue = Math.imul(label[i] + 1, 0x9e3779b1) >>> 0;
      for (let c = 0; c < 3; c++) out[at + c] = light * (70 + (hue >>> (8 * c + 4) & 127) * 1.45);
    };
  },
  texture(count, frame) {
    const texture = shortsAt(runtime.plane(frame, 1), count);
    let least = 65535, most = 0;
    for (const energy of texture) {
      least = Math.min(least, energy);
      most = Math.max(most, energy);
    }
    const bits = (energy) => Math.log2(1 + energy), low = bits(least), range = bits(most) - low || 1;
    return (out, i, at) => heat((bits(texture[i]) - low) / range, out, at);
  },
};
const OF_FRAME = ["frame", "error", "mask", "clusters", "texture"];

function draw({ camera, width, height, show, frame }) {
  const flat = OF_FRAME.includes(show);
  const w = flat ? opened.width : width, h = flat ? opened.height : height;
  const ms = flat && show !== "error" ? 0 : render(camera, w, h);
  const pixels = paint(w * h, painters[show](w * h, frame));
  return { pixels, width: w, height: h, ms, show, frame };
}

const answers = { open, build, load, draw };
onmessage = async ({ data }) => {
  try {
    const result = await answers[data.kind](data);
    postMessage({ ...result, kind: data.kind, id: data.id }, result.pixels ? [result.pixels.buffer] : []);
  } catch (error) {
    postMessage({ kind: "failed", id: data.id, text: error.message });
  }
};
