/* SPDX-License-Identifier: Apache-2.0 */
/* The camera's path through a recording: drawn over the picture, and travelled by a slider or by itself. */
const path = { poses: [], playing: 0 };
const along = $("along"), STEP_MS = 80;

function showPath(poses) {
  path.poses = poses;
  $("path-controls").hidden = poses.length < 2;
  along.max = Math.max(0, poses.length - 1);
  describePlace();
}

function describePlace() {
  const text = `${Number(along.value) + 1} of ${path.poses.length}`;
  $("along-text").textContent = text;
  along.setAttribute("aria-valuetext", text);
}

/* Looks from a place of the path. */
function travelTo(index) {
  const pose = path.poses[index];
  along.value = index;
  describePlace();
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
