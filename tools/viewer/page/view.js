/* SPDX-License-Identifier: Apache-2.0 */
"use strict";
/* The page: camera, controls and texts. Workers do all computation. */
const $ = (id) => document.getElementById(id);
const data = JSON.parse($("data").textContent);
function bytesOf(id) {
  const text = atob($(id).textContent), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}
const STAGES = data.stages;

/* ---- vectors: a matrix has the world's axes as rows, and right, down and forward of the camera as columns ---------- */

const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const n = Math.hypot(...a); return a.map((x) => x / n); };

function axesOf([w, x, y, z]) {
  return [[1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
          [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
          [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]];
}

function quaternionOf([right, down, forward]) {
  const [a, b, c] = [right, down, forward], trace = a[0] + b[1] + c[2];
  if (trace > 0) {
    const s = Math.sqrt(trace + 1) * 2;
    return [s / 4, (b[2] - c[1]) / s, (c[0] - a[2]) / s, (a[1] - b[0]) / s];
  }
  if (a[0] > b[1] && a[0] > c[2]) {
    const s = Math.sqrt(1 + a[0] - b[1] - c[2]) * 2;
    return [(b[2] - c[1]) / s, s / 4, (b[0] + a[1]) / s, (c[0] + a[2]) / s];
  }
  if (b[1] > c[2]) {
    const s = Math.sqrt(1 + b[1] - a[0] - c[2]) * 2;
    return [(c[0] - a[2]) / s, (b[0] + a[1]) / s, s / 4, (c[1] + b[2]) / s];
  }
  const s = Math.sqrt(1 + c[2] - a[0] - b[1]) * 2;
  return [(a[1] - b[0]) / s, (c[0] + a[2]) / s, (c[1] + b[2]) / s, s / 4];
}

function turned(vector, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(vector.map((x) => x * c), cross(axis, vector), s), axis, dot(axis, vector) * (1 - c));
}

/* ---- the camera ---------------------------------------------------------------------------------------------------- */

const lens = data.frames[0]; /* a page has at least one frame: the one that it starts from */
const up = axesOf(lens.rotation)[1].map((x) => -x);
const camera = { position: [0, 0, 0], axes: [], distance: 1, frame: 0 };
let sceneUnit = 1;

function lookFrom(index) {
  const frame = data.frames[index];
  camera.position = [...frame.position];
  camera.axes = axesOf(frame.rotation);
  camera.distance = 1.5 * sceneUnit;
  camera.frame = index;
}

function turn(yaw, pitch) {
  const pivot = add(camera.position, camera.axes[2], camera.distance);
  const slope = Math.asin(Math.max(-1, Math.min(1, dot(camera.axes[2], up))));
  const most = 1.45; /* radians: keeps up pointing up */
  pitch = Math.max(-most - slope, Math.min(most - slope, pitch));
  camera.axes = camera.axes.map((axis) => turned(axis, up, yaw));
  const right = camera.axes[0];
  camera.axes = camera.axes.map((axis) => unit(turned(axis, right, pitch)));
  if (motion() === "orbit") camera.position = add(pivot, camera.axes[2], -camera.distance);
  camera.frame = null;
}

function move(right, down, forward) {
  [right, down, forward].forEach((step, i) => { camera.position = add(camera.position, camera.axes[i], step * camera.distance); });
  camera.frame = null;
}

function approach(factor) {
  const nearest = sceneUnit / 64, farthest = sceneUnit * 256;
  const distance = Math.max(nearest, Math.min(farthest, camera.distance * factor));
  camera.position = add(camera.position, camera.axes[2], camera.distance - distance);
  camera.distance = distance;
  camera.frame = null;
}

const cameraOf = (frame, width) => {
  const scale = width / data.width;
  return { focal: frame.focal.map((f) => f * scale), centre: frame.centre.map((c) => (c + .5) * scale - .5),
           position: frame.position, rotation: frame.rotation };
};

/* ---- the workers: one draws, another one builds. Each handles one request at a time; a newer request replaces a waiting
 * one of its kind --------------------------------------------------------------------------------------------------- */

const ORDER = ["open", "load", "take", "build", "draw", "score"];
const source = URL.createObjectURL(new Blob([$("worker").textContent], { type: "text/javascript" }));
const done = {};

class Runtime {
  constructor(builds) {
    this.waiting = {};
    this.busy = false;
    this.worker = new Worker(source);
    this.worker.onmessage = ({ data: answer }) => this.#answer(answer);
    this.worker.onerror = (event) => say(event.message || "the runtime does not start", true);
    this.builds = builds;
    this.open(files.bundle);
  }

  open(bundle) {
    this.ask("open", { wasm: files.wasm, bundle, width: data.width, height: data.height, most, builds: this.builds, isShared: data.served });
  }

  get still() {
    return !this.busy && Object.keys(this.waiting).length === 0;
  }

  ask(kind, more) {
    this.waiting[kind] = more;
    this.#next();
  }

  #next() {
    const kind = ORDER.find((k) => this.waiting[k]);
    if (this.busy || !kind) return;
    const request = { kind, ...(kind === "draw" ? drawing(this.waiting[kind]) : this.waiting[kind]) };
    delete this.waiting[kind];
    this.busy = true;
    this.asked = performance.now();
    this.worker.postMessage(request);
  }

  #answer(answer) {
    if (answer.kind === "progress") return showProgress(answer);
    this.busy = false;
    if (answer.kind === "failed") say(answer.text, true);
    else done[answer.kind]({ ...answer, took: performance.now() - this.asked });
    this.#next();
  }
}

/* ---- the picture ------------------------------------------------------------------------------------------------------ */

const canvas = $("picture"), context = canvas.getContext("2d", { willReadFrequently: true });
const chosen = (name) => document.querySelector(`input[name=${name}]:checked`).value;
const motion = () => chosen("motion");
const ratio = data.width / data.height;

const MOST_PIXELS = 2e6, LEAST_WIDTH = 64;
const density = () => Math.min(devicePixelRatio, 2);
const sized = (width) => ({ width: Math.max(LEAST_WIDTH, Math.round(width)), height: Math.max(1, Math.round(Math.max(LEAST_WIDTH, width) / ratio)) });
const most = sized(Math.min(Math.max(screen.width, innerWidth) * density(), Math.sqrt(MOST_PIXELS * ratio)));
({ width: canvas.width, height: canvas.height } = most);

/* While the camera moves, pictures are as coarse as their pace demands. Once it rests, one is drawn whole. */
const PACE_MS = 28, REST_MS = 150, COARSEST = .3;
let coarseness = .5, resting = 0;

function keepPace(took) {
  const step = Math.max(.75, Math.min(1.15, Math.sqrt(PACE_MS / took)));
  coarseness = Math.max(COARSEST, Math.min(1, coarseness * step));
}

const OF_VIEW = ["mask", "clusters", "texture"]; /* planes that only the worker which builds has */
const isStill = () => resting === 0 && drawer.still && (!builder || builder.still); /* for tests */

function drawing({ coarse }) {
  const show = chosen("show"), frame = camera.frame ?? 0;
  const flat = document.querySelector(`#overlay input[value=${show}]`);
  const { width, height } = sized(Math.min(most.width, canvas.clientWidth * density()) * (coarse ? coarseness : 1));
  const from = flat ? cameraOf(data.frames[frame], data.width)
                    : { ...cameraOf(lens, width), position: camera.position, rotation: quaternionOf(camera.axes) };
  return { camera: from, width, height, show, frame, coarse };
}

function draw(coarse = false) {
  (OF_VIEW.includes(chosen("show")) ? builder : drawer).ask("draw", { coarse });
}

function onFrame() {
  return document.querySelector("#overlay input:checked") !== null;
}

/* Handles a move: away from a frame, overlays that only frames have are switched off. */
function moved() {
  if (onFrame() && camera.frame === null) document.querySelector("input[name=show][value=picture]").checked = true;
  markFrames();
  draw(true);
  clearTimeout(resting);
  resting = setTimeout(() => { resting = 0; draw(); }, REST_MS);
}

let pictures = 0;
done.draw = ({ pixels, width, height, ms, show, coarse, hash, took }) => {
  if (coarse) keepPace(took);
  if (show !== chosen("show")) return; /* it was asked for before another choice */
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  context.putImageData(new ImageData(pixels, width, height), 0, 0);
  if (coarse) $("drawn").textContent = `${width} x ${height} while it moves, ${Math.round(1000 / took)} pictures a second.`;
  else $("drawn").textContent = hash ? `${width} x ${height} in ${ms.toFixed(0)} ms, hash ${hash}.` : "";
  if (!coarse) document.body.dataset.drawn = ++pictures; /* for tests: pictures that are whole */
  const of = camera.frame === null ? "from a free viewpoint" : `from ${data.frames[camera.frame].name}`;
  canvas.setAttribute("aria-label", `${document.querySelector(`input[name=show][value=${show}]`).nextSibling.textContent}, ${of}`);
};

/* ---- texts -------------------------------------------------------------------------------------------------------------- */

const count = (n) => n.toLocaleString("en");
function say(text, bad = false) {
  $("status").textContent = text;
  $("status").classList.toggle("bad", bad);
  if (bad) $("progress").hidden = true;
}

function showProgress({ stage, done: part, total }) {
  $("progress").hidden = false;
  $("progress").value = total > 0 ? part / total : 0;
  say(`Building: ${STAGES[stage]}`);
}

function showBits(hash) {
  if (data.hash === null) return;
  const same = hash === data.hash;
  $("bits").hidden = false;
  $("bits").classList.toggle("other", !same);
  $("bits").textContent = same ? `Same bits as the native program: ${hash}` : `Other bits than the native program: ${hash}, not ${data.hash}`;
  $("bits").dataset.same = same;
}

function showResult({ gaussians, valid, stages, hash }) {
  const share = valid > 0 ? ` of ${count(valid)} points (${(100 * gaussians / valid).toFixed(1)} %)` : "";
  say(`${count(gaussians)} Gaussians${share}.`);
  $("progress").hidden = true;
  $("stages").hidden = stages.length === 0;
  const rows = stages.map(({ stage, ms, hash: of }) => {
    const row = document.createElement("tr");
    for (const text of [STAGES[stage], ms.toFixed(1), of]) row.appendChild(document.createElement("td")).textContent = text;
    return row;
  });
  document.querySelector("#stages tbody").replaceChildren(...rows);
  document.body.dataset.hash = hash ?? "";
  document.body.dataset.gaussians = gaussians;
}

done.score = ({ psnr }) => {
  const scores = psnr.map((dB, i) => `${data.frames[i].name} ${dB.toFixed(2)} dB`).join(", ");
  if (builder?.busy) return; /* its progress is shown */
  say(`${$("status").textContent} PSNR: ${scores}.`);
};

/* ---- the budget ----------------------------------------------------------------------------------------------------------- */

const LEAST = .5, MOST = 100; /* percent, at the ends of the logarithmic slider */
const slider = $("slider");
const percentAt = (value) => LEAST * (MOST / LEAST) ** (value / 1000);
const sliderAt = (percent) => Math.round(1000 * Math.log(percent / LEAST) / Math.log(MOST / LEAST));
const budgetOf = (percent) => Math.max(1, Math.min(data.valid, Math.round(data.valid * percent / 100)));
let wanted = data.gaussians;

function showBudget() {
  const text = `${count(wanted)} Gaussians, ${(100 * wanted / data.valid).toPrecision(3)} %`;
  $("budget-text").textContent = text;
  slider.setAttribute("aria-valuetext", text);
}

function build() {
  document.querySelector("input[name=source][value=built]").checked = true;
  builder ??= new Runtime(true);
  builder.ask("build", { gaussians: wanted });
}

let built = null;
done.build = (answer) => {
  if (!built) showBits(answer.hash);
  built = answer;
  if (chosen("source") === "built") drawer.ask("take", { scene: answer.scene });
  $("progress").hidden = true;
};
done.take = () => settle(built);
done.load = (answer) => settle({ ...answer, valid: data.file ? 0 : data.valid, stages: [], hash: null });

const scored = data.frames.filter((f) => f.recorded).map((f) => cameraOf(f, data.width));
let settled = false;
function settle(answer) {
  sceneUnit = 2 ** answer.exponent;
  if (!settled && camera.frame !== null) lookFrom(camera.frame);
  showResult(answer);
  showOverlays();
  draw();
  if (scored.length > 0) drawer.ask("score", { frames: scored });
  if (!settled && data.hash !== null) build(); /* to compare its bits with the native program's */
  settled = true;
}

/* ---- controls --------------------------------------------------------------------------------------------------------------- */

/* Offers the overlays of views that the scene was built from here: retained pixels, SuperClusters and texture. */
function showOverlays() {
  const isBuilt = built !== null && chosen("source") === "built";
  $("overlay").hidden = !data.frames.some((f) => f.recorded);
  const view = camera.frame === null || camera.frame < data.views;
  for (const label of document.querySelectorAll(".of-view")) label.hidden = !isBuilt || !view;
  const shown = document.querySelector("input[name=show]:checked");
  if (shown.closest("label").hidden) document.querySelector("input[name=show][value=picture]").checked = true;
}

function markFrames() {
  [...$("frames").querySelectorAll("button")].forEach((button, i) => button.setAttribute("aria-pressed", camera.frame === i));
  showOverlays();
}

function goTo(index) {
  if (index >= data.frames.length) return;
  lookFrom(index);
  markFrames();
  draw();
}

if (data.frames.some((f) => f.recorded)) {
  $("frames").hidden = false;
  data.frames.forEach((frame, i) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = frame.name;
    button.onclick = () => goTo(i);
    $("frames").appendChild(button);
  });
}
for (const input of document.querySelectorAll("input[name=show]")) {
  input.onchange = () => {
    if (onFrame() && camera.frame === null) lookFrom(0);
    markFrames();
    draw();
  };
}
for (const input of document.querySelectorAll("input[name=source]")) {
  input.onchange = () => (chosen("source") === "file" ? load() : build());
}
slider.oninput = () => {
  wanted = budgetOf(percentAt(Number(slider.value)));
  showBudget();
  build();
};
$("reset").onclick = () => goTo(0);
$("controls").onsubmit = (event) => event.preventDefault();

/* ---- mouse, touch, keys -------------------------------------------------------------------------------------------------------- */

const pointers = new Map();
const RADIANS = 3; /* across the whole picture */

canvas.onpointerdown = (event) => {
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
};
canvas.onpointerup = canvas.onpointercancel = (event) => pointers.delete(event.pointerId);
canvas.onpointermove = (event) => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const now = [event.clientX, event.clientY], size = canvas.clientWidth;
  const dx = (now[0] - before[0]) / size, dy = (now[1] - before[1]) / size;
  if (pointers.size === 1) {
    const sign = motion() === "orbit" ? 1 : -1;
    turn(sign * dx * RADIANS, -sign * dy * RADIANS);
  } else {
    const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
    const apart = (at) => Math.max(8, Math.hypot(at[0] - other[0], at[1] - other[1]));
    approach(apart(before) / apart(now));
    move(-dx / 2, -dy / 2, 0);
  }
  pointers.set(event.pointerId, now);
  moved();
};
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  approach(1.0015 ** Math.max(-200, Math.min(200, event.deltaY)));
  moved();
}, { passive: false });

const STEP = .08, ANGLE = .06;
const KEYS = {
  ArrowLeft: () => turn(motion() === "orbit" ? ANGLE : -ANGLE, 0), ArrowRight: () => turn(motion() === "orbit" ? -ANGLE : ANGLE, 0),
  ArrowUp: () => turn(0, motion() === "orbit" ? -ANGLE : ANGLE), ArrowDown: () => turn(0, motion() === "orbit" ? ANGLE : -ANGLE),
  w: () => move(0, 0, STEP), s: () => move(0, 0, -STEP), a: () => move(-STEP, 0, 0), d: () => move(STEP, 0, 0),
  e: () => move(0, -STEP, 0), q: () => move(0, STEP, 0), "+": () => approach(.92), "=": () => approach(.92), "-": () => approach(1.09),
  r: () => lookFrom(0),
};
canvas.onkeydown = (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (/^[1-9]$/.test(key)) {
    goTo(Number(key) - 1);
  } else if (KEYS[key]) {
    KEYS[key]();
    moved();
  } else {
    return;
  }
  event.preventDefault();
};

/* ---- the start --------------------------------------------------------------------------------------------------------------------- */

const load = () => drawer.ask("load", {});
done.open = ({ cpu, threads }) => Object.assign(document.body.dataset, { cpu, threads }); /* for tests */
document.title = `${data.title} - trim3r view`;
$("title").textContent = data.title;
$("budget").hidden = data.valid === 0;
$("source").hidden = !(data.file && data.valid > 0);
if (data.valid > 0) {
  slider.value = sliderAt(100 * wanted / data.valid);
  showBudget();
}
lookFrom(0);
markFrames();
const files = { wasm: bytesOf("wasm"), bundle: bytesOf("bundle") };
const drawer = new Runtime(false);
let builder = null;
load();
addEventListener("resize", () => draw());
