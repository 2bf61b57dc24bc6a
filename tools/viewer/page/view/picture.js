/* SPDX-License-Identifier: Apache-2.0 */
/* The picture. While the camera moves, pictures are as coarse as their pace demands: of fewer pixels, and of fewer
 * Gaussians. Once it rests, one is drawn whole. */
const canvas = $("picture"), context = canvas.getContext("2d", { willReadFrequently: true });
const chosen = (name) => document.querySelector(`input[name=${name}]:checked`).value;
const motion = () => chosen("motion");

const MOST_PIXELS = 2e6, LEAST_SIDE = 48;
const ratio = () => data.width / data.height;
const density = () => Math.min(devicePixelRatio, 2);
const leastWidth = () => Math.ceil(LEAST_SIDE * Math.max(1, ratio()));

/* Returns the size of a picture that is about so wide. */
function sized(width) {
  const whole = Math.max(leastWidth(), Math.round(width));
  return { width: whole, height: Math.round(whole / ratio()) };
}

let most = null; /* the largest picture that is drawn; a larger canvas stretches it */

/* Takes the shape of the scene's pictures. */
function shapePicture() {
  document.documentElement.style.setProperty("--ratio", ratio());
  most = sized(Math.sqrt(MOST_PIXELS * ratio()));
  ({ width: canvas.width, height: canvas.height } = most);
}

const PACE_MS = 28, REST_MS = 150, LEAST_MOVING = 240;
let coarseness = .5, resting = 0;

const fullWidth = () => Math.min(most.width, canvas.clientWidth * density());

function keepPace(took) {
  const step = Math.max(.75, Math.min(1.15, Math.sqrt(PACE_MS / took)));
  coarseness = Math.max(Math.min(1, LEAST_MOVING / fullWidth()), Math.min(1, coarseness * step));
}

/* Returns the Gaussians of a coarse picture: one for two pixels, in steps, so that few pictures need another sample. */
const gaussiansFor = ({ width, height }) => Math.round(2 ** (Math.round(2 * Math.log2(width * height / 2)) / 2));

const OF_VIEW = ["mask", "clusters", "texture"]; /* planes that only the worker which builds has */
const isStill = () => resting === 0 && drawer.still && (!builder || builder.still); /* for tests */

function drawing({ coarse }) {
  const show = chosen("show"), frame = camera.frame ?? 0;
  const flat = document.querySelector(`#overlay input[value=${show}]`);
  const size = sized(fullWidth() * (coarse ? coarseness : 1));
  const from = flat ? cameraOf(data.frames[frame], data.width)
                    : { ...cameraOf(lens(), size.width), position: camera.position, rotation: quaternionOf(camera.axes) };
  return { camera: from, ...size, show, frame, coarse, most: coarse ? gaussiansFor(size) : 0 };
}

function draw(coarse = false) {
  if (!settled) return; /* there is no scene yet */
  (OF_VIEW.includes(chosen("show")) ? builder : drawer).ask("draw", { coarse });
}

/* Draws coarsely now, and whole once nothing has changed for a while. */
function drawMoving() {
  draw(true);
  clearTimeout(resting);
  resting = setTimeout(() => { resting = 0; draw(); }, REST_MS);
}

function onFrame() {
  return document.querySelector("#overlay input:checked") !== null;
}

/* Handles a move: away from a frame, overlays that only frames have are switched off. */
function moved() {
  if (onFrame() && camera.frame === null) document.querySelector("input[name=show][value=picture]").checked = true;
  markFrames();
  drawMoving();
}

let pictures = 0;
const overPicture = []; /* functions that draw lines over a picture from the camera */
done.draw = ({ pixels, width, height, ms, show, coarse, hash, gaussians, took }) => {
  if (coarse) keepPace(took);
  endFailure();
  if (show !== chosen("show")) return; /* it was asked for before another choice */
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  context.putImageData(new ImageData(pixels, width, height), 0, 0);
  if (!onFrame()) overPicture.forEach((over) => over());
  if (coarse) $("drawn").textContent = `${width} x ${height} of ${count(gaussians)} Gaussians while it moves, ${Math.round(1000 / took)} pictures a second.`;
  else $("drawn").textContent = hash ? `${width} x ${height} in ${ms.toFixed(0)} ms, hash ${hash}.` : "";
  if (!coarse) document.body.dataset.drawn = ++pictures; /* for tests: pictures that are whole */
  const of = camera.frame === null ? "from a free viewpoint" : `from ${data.frames[camera.frame].name}`;
  canvas.setAttribute("aria-label", `${document.querySelector(`input[name=show][value=${show}]`).nextSibling.textContent}, ${of}`);
};

/* ---- lines in the picture ------------------------------------------------------------------------------------------ */

/* Draws a line through points of a plane; null breaks it. */
function drawLine(to, points, colour, width) {
  to.strokeStyle = colour;
  to.lineWidth = width;
  to.beginPath();
  points.forEach((p, i) => { if (p && points[i - 1]) to.lineTo(...p); else if (p) to.moveTo(...p); });
  to.stroke();
}

function drawDot(to, [x, y], colour, radius) {
  to.fillStyle = colour;
  to.beginPath();
  to.arc(x, y, radius, 0, 2 * Math.PI);
  to.fill();
}

/* Returns the place in the picture, or null for what lies behind the camera. */
function projected(point) {
  const seen = camera.axes.map((axis) => dot(axis, add(point, camera.position, -1))), { focal, centre } = cameraOf(lens(), canvas.width);
  return seen[2] > 1e-3 * camera.distance ? [0, 1].map((i) => focal[i] * seen[i] / seen[2] + centre[i]) : null;
}

/* Draws a line that stands out from any picture. */
function drawBright(points, colour) {
  drawLine(context, points, "#000a", 4);
  drawLine(context, points, colour, 2);
}
