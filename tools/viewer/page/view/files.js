/* SPDX-License-Identifier: Apache-2.0 */
/* Files that are opened in the page, and scenes that it saves. The program's own readers and writers do it, in a
 * worker of its own for each file. */
const filesSource = sourceOf("files");

/* Returns the answer to a request of the worker. */
function withFile(request) {
  return new Promise((resolve, reject) => {
    const worker = new Worker(filesSource);
    const end = (settleIt, answer) => { worker.terminate(); settleIt(answer); };
    worker.onmessage = ({ data: answer }) => (answer.failed ? end(reject, new Error(answer.failed)) : end(resolve, answer));
    worker.onerror = (event) => end(reject, new Error(event.message || "the reader does not start"));
    worker.postMessage({ wasm: bytesOf("files-wasm"), ...request });
  });
}

const isRecording = (name) => /\.mcap$/i.test(name);

/* Returns the command that does what the page did not; "" where there is none. */
function remedyFor(name, reason) {
  if (/trim3r import/.test(reason)) return ""; /* it names the remedy itself */
  if (isRecording(name)) return ` The program shows what the page does not: trim3r view ${quoted(name)}`;
  return /ImageDecoder/.test(reason) ? ` Convert it: trim3r convert ${quoted(name)} -o ${quoted(name.replace(/\.[^.]*$/, ".ply"))}` : "";
}

/* Reads a file; says what is wrong with it, and the remedy. */
async function reading(file, read, remedy = (reason) => remedyFor(file.name, reason)) {
  say(`Reading ${file.name}`);
  try {
    await read();
  } catch ({ message }) {
    const of = `${file.name}: `;
    say(`${message.startsWith(of) ? "" : of}${message}.${remedy(message)}`, true);
  }
}

const openFile = (file) => reading(file, () => (isRecording(file.name) ? openRecording(file, [], []) : openScene(file)));

async function openScene(file) {
  const { bundle, start, gaussians, text } = await withFile({ kind: "read", name: file.name, bytes: await file.arrayBuffer() });
  const { focal, centre, position, rotation, width, height } = start;
  recording = null;
  show({ title: file.name, width, height, views: 0, valid: 0, gaussians, file: true, path: [],
         frames: [{ name: "the start", recorded: false, focal, centre, position, rotation }] }, bundle);
  $("remark").textContent = text;
  document.querySelector("input[name=source][value=file]").checked = true;
  load();
}

/* Shows another scene, or builds from other frames, in place of what the page showed before. */
function show(shown, bundle) {
  data = { ...shown, served: data.served, hash: null, stages: data.stages };
  firstBundle = bundle;
  builder?.end();
  builder = built = null;
  settled = false;
  uncrop();
  canvas.style.backgroundImage = "none"; /* the first picture was of another scene */
  present();
  drawer.open(bundle);
}

$("choose").onclick = () => $("open").click();
$("open").onchange = () => {
  if ($("open").files.length > 0) openFile($("open").files[0]);
  $("open").value = ""; /* so that the same file can be opened again */
};
addEventListener("dragover", (event) => event.preventDefault());
addEventListener("drop", (event) => {
  event.preventDefault();
  if (!$("choose").hidden && event.dataTransfer.files.length > 0) openFile(event.dataTransfer.files[0]);
});

/* ---- saving -------------------------------------------------------------------------------------------------------- */

$("save").onclick = () => drawer.ask("give");
done.give = async ({ scene }) => {
  const name = fileOfScene().replace(/(\.\w+)?$/, "-kept.ply");
  try {
    const { bytes, text } = await withFile({ kind: "write", name, scene });
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60e3);
    $("remark").textContent = text || `${name}: ${count(bytes.length)} bytes`;
  } catch (error) {
    $("remark").textContent = error.message;
  }
};
