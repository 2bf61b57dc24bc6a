/* SPDX-License-Identifier: Apache-2.0 */
/* The camera's path through a recording: drawn over the picture, and travelled by a slider or by itself. */
const path = { poses: [], playing: 0 };
const along = $("along"), STEP_MS = 80;

function showPath(poses) {
  path.poses = poses;
  $("path-controls").hidden = poses.length < 2;
  along.max = Math.max(0, poses.length - 1);
  markPlace();
}

const TURN = 1e-3, THERE = 1e-9; /* of the scene's unit, squared: a half turn, and what counts as no way at all */

/* Returns how far away a place of the path is. The turn from it decides between places at one point. */
function wayTo({ position, rotation }, turned) {
  const apart = add(position, camera.position, -1), same = Math.abs(rotation.reduce((sum, q, i) => sum + q * turned[i], 0));
  return dot(apart, apart) + TURN * sceneUnit ** 2 * (1 - same);
}

/* Moves the slider to the place that is nearest to the camera. */
function markPlace() {
  if (path.poses.length === 0) return;
  const turned = quaternionOf(camera.axes), ways = path.poses.map((pose) => wayTo(pose, turned));
  const least = ways.reduce((best, way, i) => (way < ways[best] ? i : best), Number(along.value));
  along.value = least;
  const text = `${least + 1} of ${path.poses.length}${ways[least] < THERE * sceneUnit ** 2 ? "" : ", the nearest"}`;
  $("along-text").textContent = text;
  along.setAttribute("aria-valuetext", text);
}

/* Looks from a place of the path. */
function travelTo(index) {
  const pose = path.poses[index];
  along.value = index;
  Object.assign(camera, { position: [...pose.position], axes: axesOf(pose.rotation), distance: 1.5 * sceneUnit, frame: null });
  moved();
}

function stopPlaying() {
  clearInterval(path.playing);
  path.playing = 0;
  $("play").textContent = "Play";
}

/* Goes on to the next place whenever the last one is drawn. */
function play() {
  if (path.playing) return stopPlaying();
  if (Number(along.value) >= path.poses.length - 1) travelTo(0);
  $("play").textContent = "Stop";
  path.playing = setInterval(() => {
    if (Number(along.value) >= path.poses.length - 1) stopPlaying();
    else if (drawer.still) travelTo(Number(along.value) + 1);
  }, STEP_MS);
}

along.oninput = () => { stopPlaying(); travelTo(Number(along.value)); };
$("play").onclick = play;
$("trace").onchange = () => draw();

overPicture.push(() => {
  if (!$("trace").checked || path.poses.length === 0) return;
  const points = path.poses.map((pose) => projected(pose.position)), last = points[points.length - 1];
  drawBright(points, "#ffd24d");
  if (last) drawDot(context, last, "#ffd24d", 5);
});
