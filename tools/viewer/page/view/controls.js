/* SPDX-License-Identifier: Apache-2.0 */
/* What is shown, and from which frame. */

/* Offers the overlays of views that the scene was built from here: retained pixels, SuperClusters and texture. */
function showOverlays() {
  const isBuilt = built !== null && chosen("source") === "built";
  $("overlay").hidden = scored().length === 0;
  const view = camera.frame === null || camera.frame < data.views;
  for (const label of document.querySelectorAll(".of-view")) label.hidden = !isBuilt || !view;
  const shown = document.querySelector("input[name=show]:checked");
  if (shown.closest("label").hidden || (onFrame() && $("overlay").hidden)) document.querySelector("input[name=show][value=picture]").checked = true;
}

function markFrames() {
  [...$("frames").querySelectorAll("button")].forEach((button, i) => button.setAttribute("aria-pressed", camera.frame === i));
  markPlace();
  showOverlays();
}

function goTo(index) {
  if (index >= data.frames.length) return;
  lookFrom(index);
  markFrames();
  draw();
}

function offerFrames() {
  $("frames").hidden = scored().length === 0;
  $("frames").querySelectorAll("button").forEach((button) => button.remove());
  data.frames.forEach((frame, i) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = frame.name;
    button.onclick = () => goTo(i);
    $("frames").appendChild(button);
  });
}

for (const input of document.querySelectorAll("input[name=show]")) {
  input.onchange = () => {
    if (onFrame() && camera.frame === null) lookFrom(0);
    markFrames();
    draw();
  };
}
$("reset").onclick = () => goTo(0);
$("controls").onsubmit = (event) => event.preventDefault();
