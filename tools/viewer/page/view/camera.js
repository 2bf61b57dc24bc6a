/* SPDX-License-Identifier: Apache-2.0 */
/* The camera and its moves. */
const lens = () => data.frames[0]; /* a page has at least one frame: the one that it starts from */
const up = () => axesOf(lens().rotation)[1].map((x) => -x);
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
  const slope = Math.asin(Math.max(-1, Math.min(1, dot(camera.axes[2], up()))));
  const most = 1.45; /* radians: keeps up pointing up */
  pitch = Math.max(-most - slope, Math.min(most - slope, pitch));
  camera.axes = camera.axes.map((axis) => turned(axis, up(), yaw));
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
