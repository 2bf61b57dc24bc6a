/* SPDX-License-Identifier: Apache-2.0 */
/* Mouse, touch and keys. */
const pointers = new Map();
const RADIANS = 3; /* across the whole picture */

canvas.onpointerdown = (event) => {
  stopPlaying();
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
};
canvas.onpointerup = canvas.onpointercancel = (event) => pointers.delete(event.pointerId);
canvas.onpointermove = (event) => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const now = [event.clientX, event.clientY], size = canvas.clientWidth;
  const dx = (now[0] - before[0]) / size, dy = (now[1] - before[1]) / size;
  if (pointers.size === 1) {
    const sign = motion() === "orbit" ? 1 : -1;
    turn(sign * dx * RADIANS, -sign * dy * RADIANS);
  } else {
    const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
    const apart = (at) => Math.max(8, Math.hypot(at[0] - other[0], at[1] - other[1]));
    approach(apart(before) / apart(now));
    move(-dx / 2, -dy / 2, 0);
  }
  pointers.set(event.pointerId, now);
  moved();
};
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  approach(1.0015 ** Math.max(-200, Math.min(200, event.deltaY)));
  moved();
}, { passive: false });

const STEP = .08, ANGLE = .06;
const KEYS = {
  ArrowLeft: () => turn(motion() === "orbit" ? ANGLE : -ANGLE, 0), ArrowRight: () => turn(motion() === "orbit" ? -ANGLE : ANGLE, 0),
  ArrowUp: () => turn(0, motion() === "orbit" ? -ANGLE : ANGLE), ArrowDown: () => turn(0, motion() === "orbit" ? ANGLE : -ANGLE),
  w: () => move(0, 0, STEP), s: () => move(0, 0, -STEP), a: () => move(-STEP, 0, 0), d: () => move(STEP, 0, 0),
  e: () => move(0, -STEP, 0), q: () => move(0, STEP, 0), "+": () => approach(.92), "=": () => approach(.92), "-": () => approach(1.09),
  r: () => lookFrom(0),
};

function showKeys() {
  $("how").open = !$("how").open;
  if ($("how").open) $("how").scrollIntoView({ block: "nearest" });
}
addEventListener("keydown", (event) => { if (event.key === "?") showKeys(); });

canvas.onkeydown = (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (/^[1-9]$/.test(key)) {
    goTo(Number(key) - 1);
  } else if (KEYS[key]) {
    stopPlaying();
    KEYS[key]();
    moved();
  } else {
    return;
  }
  event.preventDefault();
};
