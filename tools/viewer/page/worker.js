/* SPDX-License-Identifier: Apache-2.0 */
"use strict";
/* A runtime in a thread of its own, which builds scenes or only draws them. It answers the page's requests in order. */
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

/* Threads that share the module's memory, where the page may have them. Each claims tasks by their number; `control`
 * holds what they do. A number from DONE on belongs to no work. */
const GENERATION = 0, TASK = 1, CONTEXT = 2, COUNT = 3, NEXT = 4, ACTIVE = 5, WORDS = 6;
const DONE = 1 << 30, MOST_THREADS = 8, STACK_BYTES = 65536;
const SHARED_PAGES = { initial: 256, maximum: 32768 }; /* as the module is linked */
let control, helpers = [];

function work(worker) {
  for (;;) {
    const index = Atomics.add(control, NEXT, 1);
    if (index >= Atomics.load(control, COUNT)) return;
    runtime.run(control[TASK], control[CONTEXT], index, worker);
  }
}

function parallelFor(count, task, context) {
  control.set([task, context], TASK);
  Atomics.store(control, COUNT, count);
  Atomics.store(control, NEXT, 0);
  Atomics.add(control, GENERATION, 1);
  Atomics.notify(control, GENERATION);
  work(0);
  for (let active; (active = Atomics.load(control, ACTIVE)) > 0;) Atomics.wait(control, ACTIVE, active);
  Atomics.store(control, NEXT, DONE);
}

/* Runs tasks for ever. */
async function help({ module, memory, shared, stack, worker }) {
  control = shared;
  runtime = (await WebAssembly.instantiate(module, { page, env: { memory } })).exports;
  runtime.__stack_pointer.value = stack;
  for (let seen = Atomics.load(control, GENERATION);; seen = Atomics.load(control, GENERATION)) {
    Atomics.wait(control, GENERATION, seen);
    Atomics.add(control, ACTIVE, 1);
    work(worker);
    if (Atomics.sub(control, ACTIVE, 1) === 1) Atomics.notify(control, ACTIVE);
  }
}

function startHelpers(module, memory, threads) {
  helpers.forEach((helper) => helper.terminate());
  control = new Int32Array(new SharedArrayBuffer(4 * WORDS));
  control[NEXT] = DONE;
  helpers = Array.from({ length: threads - 1 }, (_, i) => {
    const helper = new Worker(self.location.href);
    helper.postMessage({ kind: "help", module, memory, shared: control, stack: place(STACK_BYTES) + STACK_BYTES, worker: i + 1 });
    return helper;
  });
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
  parallel_for: parallelFor,
};

function need(status, what) {
  if (status === 0) return;
  const at = runtime.error_text(status), text = bytesAt(at, 256);
  throw new Error(`${what}: ${String.fromCharCode(...text.subarray(0, text.indexOf(0)))}`);
}

async function open({ wasm, bundle, width, height, most, builds, isShared }) {
  const memory = isShared ? new WebAssembly.Memory({ ...SHARED_PAGES, shared: true }) : null;
  const threads = isShared && self.crossOriginIsolated ? Math.min(navigator.hardwareConcurrency, MOST_THREADS) : 1;
  const { instance, module } = await WebAssembly.instantiate(wasm, { page, env: { memory } });
  runtime = { memory, ...instance.exports };
  end = runtime.__heap_base.value;
  const at = place(bundle.byteLength);
  new Uint8Array(runtime.memory.buffer).set(new Uint8Array(bundle), at);
  const w = Math.max(most.width, width), h = Math.max(most.height, height); /* scores are of recorded frames */
  const bytes = runtime.open(at, bundle.byteLength, w, h, builds ? 1 : 0, threads);
  if (bytes === 0) throw new Error("the runtime refuses the data of this page");
  const arena = place(bytes);
  need(runtime.start(arena), "start");
  opened = { width, height, rgb: place(w * h * 3), depth: place(w * h * 4), alpha: place(w * h * 2) };
  carried.in = carried.out = null;
  if (threads > 1) startHelpers(module, memory, threads);
  return { cpu: runtime.cpu(), threads };
}

const hex = (hash) => BigInt.asUintN(64, hash).toString(16).padStart(16, "0");

/* Memory for a scene that is carried in or out. */
const carried = { in: null, out: null };
function roomFor(way, bytes) {
  if (!carried[way] || carried[way].bytes < bytes) carried[way] = { at: place(bytes), bytes };
  return carried[way].at;
}

const described = () => ({ gaussians: runtime.gaussians(), valid: runtime.valid_points(), exponent: runtime.exponent(),
                           origin: [0, 1, 2].map((axis) => Number(runtime.origin(axis)) / 4294967296) });

/* Returns the scene that was built, or the kept part of another one. */
function give() {
  const bytes = runtime.carried_bytes(), at = roomFor("out", bytes);
  runtime.give(at);
  return { scene: bytesAt(at, bytes).slice() };
}

function build({ gaussians }) {
  times = new Float64Array(STAGES);
  begun = performance.now();
  building = true;
  const status = runtime.build(gaussians);
  building = false;
  need(status, "build");
  const stages = [];
  for (let stage = 0; stage < STAGES; stage++) {
    const hash = BigInt.asUintN(64, runtime.hash(stage));
    if (hash !== 0n) stages.push({ stage, ms: times[stage], hash: hex(hash) });
  }
  return { ...described(), stages, hash: hex(runtime.hash(STAGES)), ...give() };
}

function load() {
  need(runtime.load(), "the scene");
  return described();
}

function take({ scene }) {
  const at = roomFor("in", scene.length);
  bytesAt(at, scene.length).set(scene);
  need(runtime.take(at), "the scene");
  return described();
}

/* Returns the places that part the Gaussians along each axis into equal shares, from a sample of them, between the
 * outermost ones. */
function measure({ shares }) {
  const whole = runtime.whole(), step = Math.max(1, Math.ceil(whole / 65536)), sample = new Int32Array(Math.ceil(whole / step));
  const table = [0, 1, 2].map((axis) => {
    let low = Infinity, high = -Infinity;
    for (let i = 0; i < whole; i++) {
      const place = runtime.position(i, axis);
      low = Math.min(low, place);
      high = Math.max(high, place);
      if (i % step === 0) sample[i / step] = place;
    }
    sample.sort();
    const between = Int32Array.from({ length: shares + 1 }, (_, i) => sample[Math.round(i / shares * (sample.length - 1))]);
    between[0] = low;
    between[shares] = high;
    return between;
  });
  return { table };
}

function keep({ opacity, low, high }) {
  need(runtime.keep(Math.round(opacity * 32768), ...low, ...high), "the crop");
  return { gaussians: runtime.gaussians(), whole: runtime.whole() };
}

const score = ({ frames }) => ({ psnr: frames.map(psnr) });

const fixed = (value, bits) => Math.round(value * 2 ** bits);
const fixed64 = (value) => BigInt(Math.round(value * 4294967296));

/* Draws the colours, and the plane of depth or alpha if that is shown. most: about so many Gaussians; 0: all. */
function render(camera, width, height, show = "picture", most = 0) {
  const start = performance.now();
  const { focal, centre, position, rotation } = camera;
  need(runtime.render(fixed(focal[0], 16), fixed(focal[1], 16), fixed(centre[0], 16), fixed(centre[1], 16),
                      ...position.map(fixed64), ...rotation.map((q) => fixed(q, 30)), width, height, opened.rgb,
                      show === "depth" ? opened.depth : 0, show === "alpha" ? opened.alpha : 0, most), "the picture");
  return performance.now() - start;
}

const bytesAt = (at, count) => new Uint8Array(runtime.memory.buffer, at, count);
const shortsAt = (at, count) => new Uint16Array(runtime.memory.buffer, at, count);
const wordsAt = (at, count) => new Uint32Array(runtime.memory.buffer, at, count);

const recorded = (frame) => bytesAt(runtime.frame_rgb(frame), opened.width * opened.height * 3);

/* Returns a byte for each pixel of a frame, 0 = its recorded picture does not reach it. */
function reached(frame) {
  const count = opened.width * opened.height, at = runtime.frame_shown(frame);
  return at === 0 ? new Uint8Array(count).fill(255) : bytesAt(at, count);
}

function psnr(camera, frame) {
  const { width, height } = opened, counts = reached(frame);
  render(camera, width, height);
  const drawn = bytesAt(opened.rgb, width * height * 3), wanted = recorded(frame);
  let sum = 0, samples = 0;
  for (let i = 0; i < drawn.length; i++) {
    if (counts[Math.trunc(i / 3)] === 0) continue;
    sum += (drawn[i] - wanted[i]) ** 2;
    samples++;
  }
  return sum === 0 ? Infinity : 10 * Math.log10(65025 * samples / sum);
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
    const drawn = bytesAt(opened.rgb, count * 3), wanted = recorded(frame), counts = reached(frame);
    return (out, i, at) => {
      if (counts[i] === 0) return;
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

function draw({ camera, width, height, show, frame, coarse, most }) {
  const flat = OF_FRAME.includes(show);
  const w = flat ? opened.width : width, h = flat ? opened.height : height;
  const ms = flat && show !== "error" ? 0 : render(camera, w, h, show, most);
  const pixels = paint(w * h, painters[show](w * h, frame));
  const hash = ms > 0 && !coarse ? hex(runtime.picture_hash(opened.rgb, w, h)) : null;
  return { pixels, width: w, height: h, ms, show, coarse, hash, gaussians: runtime.pictured() };
}

const answers = { open, build, load, take, measure, keep, give, score, draw, help };
onmessage = async ({ data }) => {
  try {
    const result = await answers[data.kind](data);
    const moved = [result.pixels, result.scene].filter(Boolean).map((array) => array.buffer);
    postMessage({ ...result, kind: data.kind }, moved);
    if (data.kind === "draw") runtime.arrange(); /* for the next move; nothing is left to do after the first time */
  } catch (error) {
    postMessage({ kind: "failed", of: data.kind, text: error.message });
  }
};
