/* SPDX-License-Identifier: Apache-2.0 */
/* The scene: from the page's file, or built here within a budget. */
const count = (n) => n.toLocaleString("en");
/* Returns the name of the file that the scene came from. */
const fileOfScene = () => data.title.replace(/ and .*/, "");
/* Returns a name as a shell takes it. */
const quoted = (name) => /^[\w.,+-]+$/.test(name) ? name : `'${name.replaceAll("'", "'\\''")}'`;
/* Returns words that no line break parts. */
const unbroken = (words) => words.replaceAll(" ", "\u00a0");
let said = "", isUndrawn = false;
function say(text, bad = false) {
  if (!bad) said = text;
  $("status").textContent = text;
  $("status").classList.toggle("bad", bad);
  if (bad) $("progress").hidden = true;
}

/* A picture that cannot be drawn is an error until the next one is. */
function fail({ of, text }) {
  say(text, true);
  isUndrawn = of === "draw";
}

function endFailure() {
  if (isUndrawn) say(said);
  isUndrawn = false;
}

function showProgress({ stage, done: part, total }) {
  $("progress").hidden = false;
  $("progress").value = total > 0 ? part / total : 0;
  say(`Building: ${data.stages[stage]}`);
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
  const share = valid > 0 ? ` of ${count(valid)} points ${unbroken(`(${(100 * gaussians / valid).toFixed(1)} %)`)}` : "";
  say(`${count(gaussians)} Gaussians${share}.`);
  $("progress").hidden = true;
  $("stages").hidden = stages.length === 0;
  const rows = stages.map(({ stage, ms, hash: of }) => {
    const row = document.createElement("tr");
    for (const text of [data.stages[stage], ms.toFixed(1), of]) row.appendChild(document.createElement("td")).textContent = text;
    return row;
  });
  document.querySelector("#stages tbody").replaceChildren(...rows);
  document.body.dataset.hash = hash ?? "";
  document.body.dataset.gaussians = gaussians;
}

/* Cameras of recorded frames, with which pictures are compared. */
const scored = () => data.frames.filter((f) => f.recorded).map((f) => cameraOf(f, data.width));

done.score = ({ psnr }) => {
  if (builder?.busy) return; /* its progress is shown */
  const scores = psnr.map((dB, i) => unbroken(`${data.frames[i].name} ${dB.toFixed(2)} dB`));
  const parted = data.file && chosen("source") === "file" ? scores.length : data.views; /* what a file was built from is not known */
  const known = scores.slice(0, parted).join(", "), fresh = scores.slice(parted).join(", ");
  say(`${$("status").textContent} PSNR${fresh ? ` of new views: ${fresh}; of those that it is built from` : ""}: ${known}.`);
};

/* ---- the budget ---------------------------------------------------------------------------------------------------- */

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

slider.oninput = () => {
  wanted = budgetOf(percentAt(Number(slider.value)));
  showBudget();
  build();
};

/* ---- loading and building ------------------------------------------------------------------------------------------ */

let drawer = null, builder = null, built = null, settled = false;
let firstBundle = bytesOf("bundle"); /* of what is shown; builds start from it */

const load = () => drawer.ask("load");

function build() {
  $("progress").removeAttribute("value"); /* until the first stage reports */
  $("progress").hidden = false;
  document.querySelector("input[name=source][value=built]").checked = true;
  builder ??= new Runtime(true, firstBundle);
  builder.ask("build", { gaussians: wanted });
}

for (const input of document.querySelectorAll("input[name=source]")) {
  input.onchange = () => (chosen("source") === "file" ? load() : build());
}

done.open = ({ cpu, threads }) => Object.assign(document.body.dataset, { cpu, threads }); /* for tests */
done.build = (answer) => {
  if (!built) showBits(answer.hash);
  built = answer;
  if (chosen("source") === "built") drawer.ask("take", { scene: answer.scene });
  $("progress").hidden = true;
};
done.take = ({ origin }) => settle({ ...built, origin });
done.load = (answer) => settle({ ...answer, valid: data.file ? 0 : data.valid, stages: [], hash: null });

function settle(answer) {
  const isFirst = !settled;
  settled = true;
  sceneUnit = 2 ** answer.exponent;
  if (isFirst && camera.frame !== null) lookFrom(camera.frame);
  showResult(answer);
  showOverlays();
  measureCrop(answer);
  draw();
  if (scored().length > 0) drawer.ask("score", { frames: scored() });
  if (isFirst && data.hash !== null) build(); /* to compare its bits with the native program's */
}
