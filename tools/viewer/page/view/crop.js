/* SPDX-License-Identifier: Apache-2.0 */
/* The crop: Gaussians outside a box, or fainter than a limit, are left out of the drawing and of the file that is saved.
 * The box has the axes of the world. Its sliders run over shares of the Gaussians along an axis, so that those far away
 * take no room. */
const AXES = ["x", "y", "z"];
const crop = { sliders: [], texts: [], table: null, origin: null };

function addSlider(row, name, value, most) {
  const input = document.createElement("input");
  Object.assign(input, { type: "range", min: 0, max: most, step: 1, value });
  input.defaultValue = value;
  input.setAttribute("aria-label", name);
  input.oninput = applyCrop;
  row.appendChild(input);
  return input;
}

function addRow(name) {
  const row = document.createElement("div"), text = document.createElement("output");
  row.className = "row";
  row.append(name, text);
  $("limits").appendChild(row);
  crop.texts.push(text);
  return row;
}

const STEPS = 1000;
for (const axis of AXES) {
  const row = addRow(axis);
  crop.sliders.push([addSlider(row, `${axis}, from`, 0, STEPS), addSlider(row, `${axis}, to`, STEPS, STEPS)]);
}
const faintest = addSlider(addRow("opacity"), "Least opacity", 0, 100);

const isCropped = () => Number(faintest.value) > 0 || crop.sliders.some(([low, high]) => Number(low.value) > 0 || Number(high.value) < STEPS);

/* Takes the measures of a new scene as soon as they are needed. */
function measureCrop({ gaussians, origin } = {}) {
  if (origin) Object.assign(crop, { table: null, origin });
  if (gaussians !== undefined) showKept(gaussians, gaussians);
  if (($("crop").open || isCropped()) && !crop.table) drawer.ask("measure", { shares: STEPS });
}
done.measure = ({ table }) => {
  crop.table = table;
  showLimits();
  if (isCropped()) applyCrop();
};

/* Returns an end of the box in the worker's units; at the end of a slider there is none. */
function limitOf(axis, end) {
  const at = Number(crop.sliders[axis][end].value);
  return at === end * STEPS ? [-(2 ** 31), 2 ** 31 - 1][end] : crop.table[axis][at];
}

const inWorld = (axis, q20) => crop.origin[axis] + q20 * sceneUnit / 2 ** 20;
const endsOf = (axis) => crop.sliders[axis].map((input) => inWorld(axis, crop.table[axis][Number(input.value)]));

function showLimits() {
  AXES.forEach((_, axis) => {
    const ends = endsOf(axis).map((x) => x.toPrecision(3));
    crop.texts[axis].textContent = ends.join(" to ");
    crop.sliders[axis].forEach((input, end) => input.setAttribute("aria-valuetext", ends[end]));
  });
  crop.texts[3].textContent = `from ${faintest.value} %`;
}

/* Returns the command that cuts the same part out of the file, whose numbers it does not round. A bound lies half a step
 * beyond the place at which the page cuts, so that places which the page rounds to it are kept as well. */
function cropCommand() {
  const step = sceneUnit / 2 ** 20, digits = Math.max(0, Math.ceil(1 - Math.log10(step)));
  const bound = (axis, end) => {
    const at = Number(crop.sliders[axis][end].value);
    return at === end * STEPS ? "" : (inWorld(axis, crop.table[axis][at]) + (end - .5) * step).toFixed(digits);
  };
  const box = [0, 1].map((end) => AXES.map((_, axis) => bound(axis, end)).join(",")).join(",");
  const least = Number(faintest.value) / 100, kept = fileOfScene().replace(/(\.\w+)?$/, "-kept.ply");
  return `trim3r convert ${quoted(fileOfScene())}${box === ",,,,," ? "" : ` --crop=${box}`}` +
    `${least > 0 ? ` --min-opacity ${least}` : ""} -o ${quoted(kept)}`;
}

function showKept(kept, whole) {
  const isOfFile = data.file && chosen("source") === "file";
  $("crop-command").textContent = isOfFile && crop.table && isCropped() && kept > 0 ? cropCommand() : "";
  $("kept").textContent = kept === whole ? `All ${count(whole)} Gaussians are kept.` : `${count(kept)} of ${count(whole)} Gaussians are left.`;
  $("save").disabled = kept === 0;
  document.body.dataset.kept = kept;
}

function applyCrop() {
  if (!crop.table) return measureCrop();
  showLimits();
  drawer.ask("keep", { opacity: Number(faintest.value) / 100, low: AXES.map((_, axis) => limitOf(axis, 0)), high: AXES.map((_, axis) => limitOf(axis, 1)) });
}
done.keep = ({ gaussians, whole }) => {
  showKept(gaussians, whole);
  drawMoving();
};

function uncrop() {
  for (const input of [...crop.sliders.flat(), faintest]) input.value = input.defaultValue;
}
$("uncrop").onclick = () => { uncrop(); applyCrop(); };
$("crop").ontoggle = () => { measureCrop(); draw(); };

/* The box, while it is being chosen. */
overPicture.push(() => {
  if (!$("crop").open || !crop.table || !isCropped()) return;
  const ends = AXES.map((_, axis) => endsOf(axis));
  const corner = (bits) => ends.map((pair, axis) => pair[bits >> axis & 1]);
  for (let bits = 0; bits < 8; bits++) {
    for (let axis = 0; axis < 3; axis++) {
      if ((bits >> axis & 1) === 0) drawBright(edge(corner(bits), corner(bits | 1 << axis)), "#62cdbb");
    }
  }
});

/* Returns an edge in pieces, so that the part in front of the camera is drawn. */
function edge(from, to) {
  const pieces = 16;
  return Array.from({ length: pieces + 1 }, (_, i) => projected(add(from, add(to, from, -1), i / pieces)));
}
