/* SPDX-License-Identifier: Apache-2.0 */
/* The workers: one draws, another one builds. Each handles one request at a time; a newer request replaces a waiting one
 * of its kind. */
function bytesOf(id) {
  const text = atob($(id).textContent), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}
const sourceOf = (id) => URL.createObjectURL(new Blob([$(id).textContent], { type: "text/javascript" }));

const ORDER = ["open", "load", "take", "build", "measure", "keep", "give", "draw", "score"];
const source = sourceOf("worker"), wasm = bytesOf("wasm");
const done = {};

class Runtime {
  constructor(builds, bundle) {
    this.waiting = {};
    this.busy = false;
    this.worker = new Worker(source);
    this.worker.onmessage = ({ data: answer }) => this.#answer(answer);
    this.worker.onerror = (event) => say(event.message || "the runtime does not start", true);
    this.builds = builds;
    this.open(bundle);
  }

  /* Opens another bundle; requests that wait were about the one before. */
  open(bundle) {
    this.waiting = {};
    this.ask("open", { wasm, bundle, width: data.width, height: data.height, most, builds: this.builds, isShared: data.served });
  }

  get still() {
    return !this.busy && Object.keys(this.waiting).length === 0;
  }

  ask(kind, more = {}) {
    this.waiting[kind] = more;
    this.#next();
  }

  end() {
    this.worker.terminate();
  }

  #next() {
    const kind = ORDER.find((k) => this.waiting[k]);
    if (this.busy || !kind) return;
    const request = { kind, ...(kind === "draw" ? drawing(this.waiting[kind]) : this.waiting[kind]) };
    delete this.waiting[kind];
    this.busy = true;
    this.asked = performance.now();
    this.worker.postMessage(request);
  }

  #answer(answer) {
    if (answer.kind === "progress") return showProgress(answer);
    this.busy = false;
    if (answer.kind === "failed") fail(answer);
    else done[answer.kind]({ ...answer, took: performance.now() - this.asked });
    this.#next();
  }
}
