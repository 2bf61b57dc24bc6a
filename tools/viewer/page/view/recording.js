/* SPDX-License-Identifier: Apache-2.0 */
/* A recording that is opened in the page, which builds a scene from some of its frames. */
const MOST_BYTES = 2 ** 30;
let recording = null; /* the file, while its frames are shown */

const indicesOf = (frames) => frames.map(({ name }) => name.replace(/\D/g, ""));

/* Returns the frames that a text lists, such as 0,2. */
function listed(id) {
  const text = $(id).value.trim();
  if (!/^(\d{1,9}(\s*,\s*\d{1,9})*)?$/.test(text)) throw new Error(`"${text}" is no list of frames, such as 0,2`);
  return text === "" ? [] : text.split(",").map(Number);
}

async function openRecording(file, context, compared) {
  if (file.size > MOST_BYTES) throw new Error(`${count(file.size)} bytes are more than a page reads, which is ${count(MOST_BYTES)}`);
  const { bundle, frames, text, ...counts } = await withFile({ kind: "record", name: file.name, bytes: await file.arrayBuffer(), context, compared });
  const { width, height } = frames[0];
  recording = file;
  wanted = counts.gaussians;
  show({ title: file.name, width, height, frames, file: false, ...counts }, bundle);
  $("context").value = indicesOf(frames.slice(0, counts.views)).join(",");
  $("compared").value = indicesOf(frames.slice(counts.views)).join(",");
  $("remark").textContent = text;
  build();
}

$("rebuild").onclick = () => reading(recording, () => openRecording(recording, listed("context"), listed("compared")), () => "");
for (const id of ["context", "compared"]) $(id).onkeydown = (event) => { if (event.key === "Enter") $("rebuild").click(); };
