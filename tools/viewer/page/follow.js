/* SPDX-License-Identifier: Apache-2.0 */
/* A map that grows: asks the server for new lines of its run, and for the map when its file has changed. Draws latency,
 * decisions and PSNR over the run, and the camera's path. */
const feed = { version: "", at: 0, rows: [], shown: null };
const POLL_MS = 500;
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);

/* ---- the feed ------------------------------------------------------------------------------------------------------ */

async function loadMap(version) {
  const answer = await fetch("map");
  if (!answer.ok) return;
  feed.version = version;
  const bundle = await answer.arrayBuffer();
  drawer.open(bundle);
  load();
}

/* The first line has the offset of the lines after it, 0 when the file began anew, and the version of the map's file. */
async function poll() {
  const answer = await fetch(`lines?${feed.at}`);
  if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
  const [head, ...lines] = (await answer.text()).split("\n"), [from, version] = head.split(" ");
  if (Number(from) !== feed.at) feed.rows = [];
  feed.at = Number(from) + lines.reduce((sum, line) => sum + line.length + 1, 0) - 1; /* lines end in a newline */
  const rows = lines.filter((line) => line !== "").map((line) => JSON.parse(line));
  feed.rows.push(...rows);
  if (rows.length > 0) {
    showPath(feed.rows);
    if ($("ride").checked) ride();
    showRun();
  }
  if (version !== feed.version) await loadMap(version);
}

async function pollForever() {
  for (;;) {
    try {
      await poll();
    } catch (error) {
      say(`The run is out of reach: ${error.message}`, true);
    }
    await new Promise((wake) => setTimeout(wake, POLL_MS));
  }
}

/* ---- the camera ---------------------------------------------------------------------------------------------------- */

const newest = () => feed.rows[feed.rows.length - 1];

function ride() {
  if (newest()) travelTo(feed.rows.length - 1);
}

/* ---- the run over time --------------------------------------------------------------------------------------------- */

/* Returns the canvas cleared, in CSS pixels. */
function cleared(id) {
  const it = $(id), scale = devicePixelRatio, to = it.getContext("2d");
  it.width = Math.round(it.clientWidth * scale);
  it.height = Math.round(it.clientHeight * scale);
  to.scale(scale, scale);
  return { to, width: it.clientWidth, height: it.clientHeight };
}

const taken = (row) => row.decision === "taken";
const sorted = (values) => [...values].sort((a, b) => a - b);
const share = (values, part) => values[Math.min(values.length - 1, Math.floor(values.length * part))];

/* Bars: milliseconds of each keyframe; frames that are none have full height. */
function drawTimeline() {
  const { to, width, height } = cleared("timeline"), rows = feed.rows;
  const most = Math.max(1e-3, ...rows.map((row) => row.ms)), step = width / rows.length, tallest = height - 20;
  rows.forEach((row, i) => {
    const tall = taken(row) ? row.ms / most * tallest : tallest;
    to.fillStyle = taken(row) ? ink("accent") : ink("bad");
    to.fillRect(i * step, height - tall, Math.max(1, step - (step > 3)), tall);
  });
  const scores = rows.map((row) => row.psnr_before), known = scores.filter((x) => x !== null);
  const low = Math.min(...known), range = Math.max(...known) - low || 1;
  drawLine(to, scores.map((x, i) => x === null ? null : [(i + .5) * step, height - 4 - (x - low) / range * (tallest - 6)]), ink("ink"), 1.5);
  to.fillStyle = ink("ink");
  to.font = "12px system-ui, sans-serif";
  to.fillText(`Bars: up to ${most.toFixed(1)} ms${known.length ? `; line: ${low.toFixed(1)} to ${Math.max(...known).toFixed(1)} dB` : ""}`, 6, 14, width - 12);
}

/* The path on the two axes of the world along which it is longest. */
function drawMap() {
  const { to, width, height } = cleared("path"), places = feed.rows.map((row) => row.position);
  const ranges = [0, 1, 2].map((axis) => places.map((p) => p[axis])).map((x) => [Math.min(...x), Math.max(...x)]);
  const axes = [0, 1, 2].sort((a, b) => (ranges[b][1] - ranges[b][0]) - (ranges[a][1] - ranges[a][0])).slice(0, 2).sort();
  const size = Math.max(1e-6, ...axes.map((axis) => ranges[axis][1] - ranges[axis][0])), scale = (Math.min(width, height) - 20) / size;
  const at = (p) => axes.map((axis, i) => (i ? height : width) / 2 + (i ? -1 : 1) * (p[axis] - (ranges[axis][0] + ranges[axis][1]) / 2) * scale);
  drawLine(to, places.map(at), ink("quiet"), 1.5);
  feed.rows.filter((row) => !taken(row)).forEach((row) => drawDot(to, at(row.position), ink("bad"), 2.5));
  drawDot(to, at((feed.shown ?? newest()).position), ink("accent"), 4);
}

function describe(row) {
  const times = sorted(feed.rows.filter(taken).map((each) => each.ms)), reasons = {};
  for (const each of feed.rows) if (!taken(each)) reasons[each.decision] = (reasons[each.decision] ?? 0) + 1;
  const refused = Object.entries(reasons).map(([reason, n]) => `${n} ${reason}`).join(", ");
  const score = row.psnr_before === null ? "" : `, ${row.psnr_before.toFixed(1)} dB before it`;
  return `Frame ${row.frame}: ${taken(row) ? `keyframe ${row.keyframe}` : row.decision}, ${row.ms.toFixed(1)} ms${score}, ` +
    `${count(row.added)} added, ${count(row.removed + row.crowded)} removed, ${count(row.gaussians)} Gaussians. ` +
    (times.length ? `${count(times.length)} keyframes: ${share(times, .5).toFixed(1)} ms median, ${share(times, .95).toFixed(1)} ms 95 %, ` +
    `${share(times, 1).toFixed(1)} ms worst. ` : "") + `Not taken: ${refused || "none"}.`;
}

function showRun() {
  if (feed.rows.length === 0) return;
  $("run").hidden = false;
  drawTimeline();
  drawMap();
  $("moment").textContent = describe(feed.shown ?? newest());
  document.body.dataset.rows = feed.rows.length;
}

$("timeline").onpointermove = ({ offsetX }) => {
  feed.shown = feed.rows[Math.floor(offsetX / $("timeline").clientWidth * feed.rows.length)] ?? null;
  showRun();
};
$("timeline").onpointerleave = () => { feed.shown = null; showRun(); };
$("ride").onchange = () => { if ($("ride").checked) ride(); };
for (const kind of ["pointerdown", "wheel", "keydown"]) canvas.addEventListener(kind, () => { $("ride").checked = false; });
for (const id of ["reset", "play"]) $(id).addEventListener("click", () => { $("ride").checked = false; });
along.addEventListener("input", () => { $("ride").checked = false; });
$("ride").closest("label").hidden = false;
$("choose").hidden = true;
$("trace").checked = true;
addEventListener("resize", showRun);
pollForever();
