/* SPDX-License-Identifier: Apache-2.0 */
/* The start, and the texts of each scene. */
function present() {
  document.title = `${data.title} - trim3r view`;
  $("title").textContent = data.title;
  $("remark").textContent = "";
  $("bits").hidden = true;
  $("recording").hidden = recording === null;
  $("budget").hidden = data.valid === 0;
  $("source").hidden = !(data.file && data.valid > 0);
  if (data.valid > 0) {
    slider.value = sliderAt(100 * wanted / data.valid);
    showBudget();
  }
  shapePicture();
  offerFrames();
  lookFrom(0);
  showPath(data.path.map((numbers) => ({ position: numbers.slice(0, 3), rotation: numbers.slice(3) })));
  markFrames();
}

present();
drawer = new Runtime(false, firstBundle);
load();
addEventListener("resize", () => draw());
