/* SPDX-License-Identifier: Apache-2.0 */
/* Scene files that are opened in the page, and those that it saves. The program's own readers and writers do it, in a
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

/* Returns the command that does what the page did not; "" where there is none. */
function remedyFor(name, reason) {
  if (/\.mcap$/i.test(name)) return ` A recording is shown by: trim3r view ${quoted(name)}`;
  return /ImageDecoder/.test(reason) ? ` Convert it: trim3r convert ${quoted(name)} -o ${quoted(name.replace(/\.[^.]*$/, ".ply"))}` : "";
}

async function openFile(file) {
  say(`Reading ${file.name}`);
  try {
    if (/\.mcap$/i.test(file.name)) throw new Error("the page does not read such files");
    const { bundle, start, gaussians, text } = await withFile({ kind: "read", name: file.name, bytes: await file.arrayBuffer() });
    showScene({ title: file.name, gaussians, start }, bundle);
    $("remark").textContent = text;
  } catch (error) {
    say(`${file.name}: ${error.message}.${remedyFor(file.name, error.message)}`, true);
  }
}

/* Shows a scene in place of what the page showed before. */
function showScene({ title, gaussians, start }, bundle) {
  const { focal, centre, position, rotation, width, height } = start;
  data = { title, width, height, views: 0, valid: 0, gaussians, file: true, served: data.served, hash: null, stages: data.stages,
           frames: [{ name: "the start", recorded: false, focal, centre, position, rotation }], path: [] };
  builder?.end();
  builder = built = null;
  settled = false;
  document.querySelector("input[name=source][value=file]").checked = true;
  uncrop();
  canvas.style.backgroundImage = "none"; /* the first picture was of another scene */
  present();
  drawer.open(bundle);
  load();
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
