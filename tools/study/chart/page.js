/* SPDX-License-Identifier: Apache-2.0 */
"use strict";
(() => {
  const $ = (id) => document.getElementById(id);
  const data = JSON.parse($("data").textContent);
  const { measures, points, series, scenes, cases, choices } = data;
  const state = { choice: data.start.choice, quality: data.start.quality, cost: data.start.cost, hidden: new Set(),
                  point: null, beside: null, at: 0 };
  let spots = [], marks = new Map();

  /* ---- small helpers ---- */
  const SVG = "http://www.w3.org/2000/svg";
  function make(name, attributes = {}, ...children) {
    const it = name.startsWith("svg:") ? document.createElementNS(SVG, name.slice(4)) : document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) it.setAttribute(key, value);
    it.append(...children.filter((child) => child !== null));
    return it;
  }
  const own = (s) => `--own: var(--c${series[s].colour})`;
  const spread = (p, m) => choices[state.choice].spreads[p][m]; // [mean, low, median, high, cases] or null
  const pair = () => choices[state.choice].pairs[`${state.quality}:${state.cost}`];
  const title = (p) => series[points[p].series].name + (points[p].keep ? `, ${points[p].keep}` : "");

  function text(m, value) {
    const { unit, decimals } = measures[m];
    if (value === null || value === undefined) return "\u2013";
    const short = (v) => String(Number(v.toPrecision(3)));
    if (unit === "ms") return value >= 1000 ? `${short(value / 1000)} s` : `${short(value)} ms`;
    if (unit === "bytes") {
      let power = 0;
      for (; value >= 1024 && power < 4; power++) value /= 1024;
      return `${value.toFixed(power ? 2 : 0)} ${["B", "KiB", "MiB", "GiB", "TiB"][power]}`;
    }
    return value.toFixed(decimals) + (unit ? ` ${unit}` : "");
  }
  const many = (s) => s[4] >= 4; // fewer cases have no meaningful quartiles

  /* ---- shown data ---- */
  function shown() {
    return points.map((_, p) => p).filter((p) => !state.hidden.has(points[p].series) && spread(p, state.quality) && spread(p, state.cost));
  }
  function front(list) {
    const complete = new Set(pair() ? pair().complete : []), sign = measures[state.quality].less ? -1 : 1;
    const place = (p) => [spread(p, state.cost)[0], sign * spread(p, state.quality)[0]];
    const order = list.filter((p) => complete.has(p)).sort((a, b) => place(a)[0] - place(b)[0] || place(b)[1] - place(a)[1] || a - b);
    const found = [];
    for (const p of order) {
      const last = found.length ? place(found[found.length - 1]) : null, [x, y] = place(p);
      if (!last || y > last[1] || (y === last[1] && x === last[0])) found.push(p);
    }
    return found;
  }

  /* ---- the chart ---- */
  function scale(axis, from, to) {
    const f = axis.log ? Math.log : (v) => v, low = f(axis.low), high = f(axis.high);
    return (v) => from + Math.min(1, Math.max(0, (f(v) - low) / (high - low))) * (to - from);
  }
  function ticks(axis, place, least) {
    let last = -Infinity;
    return axis.ticks.filter(([v]) => {
      const fits = Math.abs(place(v) - last) >= least;
      if (fits) last = place(v);
      return fits;
    });
  }
  /* Ticks at 1, 2 and 5 times powers of ten. */
  function roundTicks(low, high, log) {
    const step = 10 ** Math.floor(Math.log10((high - low) / 8)), found = [];
    const every = [1, 2, 5, 10].map((t) => t * step).find((s) => (high - low) / s <= 8);
    if (!log) {
      for (let v = Math.ceil(low / every) * every; v <= high; v += every) found.push(v);
      return found;
    }
    for (let power = 10 ** Math.floor(Math.log10(low)); power <= high; power *= 10) {
      found.push(...[1, 2, 5].map((t) => t * power).filter((v) => v >= low && v <= high));
    }
    return found;
  }
  /* Returns the axis of the visible points if some are hidden, otherwise the axis of all points. */
  function fitted(axis, measure, list) {
    const whiskers = measures[measure].unit === "ms";
    const values = list.flatMap((p) => { const s = spread(p, measure); return whiskers && many(s) ? [s[0], s[1], s[3]] : [s[0]]; });
    const least = Math.min(...values), most = Math.max(...values);
    if (state.hidden.size === 0 || !(most - least > 1e-3 * Math.abs(most))) return axis;
    const log = axis.log && most / least > 5, room = log ? (most / least) ** .06 : .06 * (most - least);
    const [low, high] = log ? [least / room, most * room] : [axis.low >= 0 ? Math.max(0, least - room) : least - room, most + room];
    return { ...axis, low, high, log, ticks: roundTicks(low, high, log).map((v) => [v, text(measure, v)]) };
  }
  function draw() {
    const wide = Math.max(300, $("canvas").clientWidth), high = Math.round(Math.min(600, Math.max(340, wide * 0.55)));
    const list = shown(), at = pair(), best = front(list), onFront = new Set(best);
    const focused = document.activeElement && document.activeElement.closest ? document.activeElement.closest(".spot") : null;
    const svg = make("svg:svg", { viewBox: `0 0 ${wide} ${high}`, class: "live", role: "group", "aria-label": "Points; arrow keys move, Enter opens" });
    marks = new Map();
    spots = list;
    $("tip").hidden = true;
    if (!at) {
      $("canvas").replaceChildren(make("p", { class: "quiet" }, "Nothing here has both of these measures."));
      return;
    }
    const left = 66, right = wide - 16, top = 34, bottom = high - 48;
    const xs = fitted(at.x, state.cost, list), ys = fitted(at.y, state.quality, list);
    const x = scale(xs, left, right), y = ys.falling ? scale(ys, top, bottom) : scale(ys, bottom, top);
    const px = (p) => x(spread(p, state.cost)[0]), py = (p) => y(spread(p, state.quality)[0]);
    for (const [v, label] of ticks(ys, y, 22)) {
      svg.append(make("svg:path", { class: "grid", d: `M${left},${y(v)}H${right}` }),
                 make("svg:text", { x: left - 8, y: y(v) + 4, "text-anchor": "end" }, label));
    }
    for (const [v, label] of ticks(xs, x, 50)) {
      svg.append(make("svg:path", { class: "grid", d: `M${x(v)},${top}V${bottom}` }),
                 make("svg:text", { x: x(v), y: bottom + 18, "text-anchor": "middle" }, label));
    }
    const q = measures[state.quality];
    svg.append(make("svg:text", { class: "axis", x: 0, y: 14 }, q.title + (q.less ? ", less is better" : "")),
               make("svg:text", { class: "axis", x: right, y: high - 8, "text-anchor": "end" }, measures[state.cost].title),
               make("svg:text", { x: right, y: 14, "text-anchor": "end" }, "\u2196 better and cheaper"));
    if (best.length) {
      const steps = best.map((p, i) => (i ? `H${px(p)}V${py(p)}` : `M${px(p)},${bottom}V${py(p)}`)).join("") + `H${right}`;
      svg.append(make("svg:path", { class: "reach", d: `${steps}V${bottom}Z` }), make("svg:path", { class: "front", d: steps }));
    }
    series.forEach((s, i) => {
      const line = s.points.filter((p) => list.includes(p));
      if (line.length > 1) {
        svg.append(make("svg:path", { class: "line of", "data-series": i, style: own(i), d: "M" + line.map((p) => `${px(p)},${py(p)}`).join("L") }));
      }
    });
    const small = wide < 560 ? 5.2 : 5.8, time = measures[state.cost].unit === "ms", complete = new Set(at.complete);
    const tab = list.includes(state.point) ? state.point : best[0] ?? list[0];
    for (const p of [...list].reverse()) {
      const s = points[p].series, cost = spread(p, state.cost);
      const g = make("svg:g", { class: `spot of${complete.has(p) ? "" : " part"}${onFront.has(p) ? " on-front" : ""}${p === state.point ? " chosen" : ""}`,
                                "data-point": p, "data-series": s, style: own(s), role: "button", tabindex: p === tab ? 0 : -1,
                                "aria-label": `${title(p)}: ${text(state.quality, spread(p, state.quality)[0])}, ${text(state.cost, cost[0])}${onFront.has(p) ? ", on the front" : ""}` });
      if (time && many(cost)) {
        g.append(make("svg:path", { class: "whisker", d: `M${x(cost[1])},${py(p)}H${x(cost[3])}M${x(cost[2])},${py(p) - 4}v8` }));
      }
      g.append(make("svg:circle", { class: "near", cx: px(p), cy: py(p), r: 13 }),
               make("svg:path", { class: "mark", d: data.shapes[series[s].shape], transform: `translate(${px(p)} ${py(p)}) scale(${small})` }));
      if (onFront.has(p)) g.append(make("svg:circle", { class: "ring", cx: px(p), cy: py(p), r: small + 4 }));
      svg.append(g);
      marks.set(p, { g, x: px(p), y: py(p) });
    }
    let last = null;
    for (const p of best) {
      const edge = px(p) - 44 < left, place = edge ? [px(p) + 10, py(p) + 19] : [px(p) - 9, py(p) - 10];
      if (points[p].keep && (!last || Math.abs(place[0] - last[0]) > 40 || Math.abs(place[1] - last[1]) > 15)) {
        svg.append(make("svg:text", { x: place[0], y: place[1], "text-anchor": edge ? "start" : "end", "pointer-events": "none" }, points[p].keep.replace(" kept", "")));
        last = place;
      }
    }
    svg.append(...[...svg.querySelectorAll(".on-front")]); // above the others
    $("canvas").replaceChildren(svg);
    if (focused && marks.has(Number(focused.dataset.point))) marks.get(Number(focused.dataset.point)).g.focus({ preventScroll: true });
    const pale = list.length - list.filter((p) => complete.has(p)).length;
    $("note").hidden = pale === 0;
    $("note").textContent = complete.size === 0 ? "" : `${pale} pale point${pale === 1 ? " was" : "s were"} not measured on all ${at.cases} cases; choose a scene that they share.`;
    table($("front"), best);
    table($("all"), list);
  }

  function tip(p) {
    const mark = marks.get(p), box = $("tip");
    if (!mark) return;
    const row = (name, value) => make("tr", {}, make("td", {}, name), make("td", {}, value));
    const mean = (m) => (spread(p, m) ? [row(measures[m].title, text(m, spread(p, m)[0]))] : []);
    const s = spread(p, state.cost), rows = [...mean(state.quality), ...mean(state.cost)];
    if (many(s)) rows.push(row("its median", text(state.cost, s[2])), row("its quartiles", `${text(state.cost, s[1])} \u2026 ${text(state.cost, s[3])}`));
    rows.push(...mean(data.gaussians), row("Cases", String(spread(p, state.quality)[4])));
    box.replaceChildren(make("b", {}, title(p)), make("span", { class: "quiet" }, points[p].settings.join(", ")), make("table", {}, ...rows));
    box.hidden = false;
    const ratio = $("canvas").clientWidth / $("canvas").firstChild.viewBox.baseVal.width;
    const x = mark.x * ratio, y = mark.y * ratio, toLeft = x > $("plot").clientWidth / 2;
    const leftEdge = toLeft ? x - box.offsetWidth - 18 : x + 18;
    box.style.left = `${Math.max(0, Math.min(leftEdge, $("plot").clientWidth - box.offsetWidth))}px`;
    box.style.top = `${y < $("plot").clientHeight / 2 ? y + 20 : y - box.offsetHeight - 20}px`;
  }
  function light(s) {
    const svg = $("canvas").querySelector(".live");
    if (!svg) return;
    svg.classList.toggle("muted", s !== null);
    for (const it of svg.querySelectorAll(".of")) it.classList.toggle("lit", it.dataset.series === String(s));
  }

  /* ---- tables ---- */
  function table(details, list) {
    const shownMeasures = measures.map((_, m) => m).filter((m) => list.some((p) => spread(p, m)));
    const head = make("tr", {}, make("th", {}, ""), make("th", { class: "number" }, "kept"),
                      ...shownMeasures.map((m) => make("th", { class: "number" }, measures[m].title)));
    const rows = list.map((p) => {
      const name = make("button", { type: "button" }, series[points[p].series].name);
      name.onclick = () => choose(p, true);
      return make("tr", {}, make("td", {}, name), make("td", { class: "number" }, points[p].keep.replace(" kept", "")),
                  ...shownMeasures.map((m) => make("td", { class: "number" }, spread(p, m) ? text(m, spread(p, m)[0]) : "")));
    });
    details.querySelector(".scroll").replaceChildren(make("table", {}, head, ...rows));
    details.hidden = list.length === 0;
  }

  /* ---- a point and its pictures ---- */
  const source = (picture) => "data:image/png;base64," + $(`p${picture}`).textContent;
  function image(picture, name) {
    return make("img", { src: source(picture), alt: name });
  }
  const heat = [[0, 0, 4], [87, 16, 110], [188, 55, 84], [249, 142, 9], [252, 255, 164]]; // also .scale in the style
  async function pixels(picture) {
    const img = new Image();
    img.src = source(picture);
    await img.decode();
    const canvas = make("canvas", { width: img.naturalWidth, height: img.naturalHeight }), pen = canvas.getContext("2d", { willReadFrequently: true });
    pen.drawImage(img, 0, 0);
    return { canvas, pen, all: pen.getImageData(0, 0, canvas.width, canvas.height) };
  }
  /* Draws the mean difference of the colours, brightest at 64 of 255; dark where the score does not count. */
  async function errors(render, target, mask) {
    const a = await pixels(render), b = await pixels(target), m = mask === null ? null : await pixels(mask), out = a.all.data;
    for (let i = 0; i < out.length; i += 4) {
      const off = [0, 1, 2].reduce((sum, c) => sum + Math.abs(out[i + c] - b.all.data[i + c]), 0) / 3;
      const t = Math.min(off / 64, 1) * (heat.length - 1), k = Math.min(Math.floor(t), heat.length - 2);
      const counts = m === null || m.all.data[i] > 127 ? 1 : 0.25;
      for (let c = 0; c < 3; c++) out[i + c] = counts * (heat[k][c] + (t - k) * (heat[k + 1][c] - heat[k][c]));
    }
    a.pen.putImageData(a.all, 0, 0);
    a.canvas.setAttribute("role", "img");
    a.canvas.setAttribute("aria-label", "error map");
    return a.canvas;
  }
  function strip(p, at) {
    const cell = points[p].cells.find((c) => c[0] === at);
    if (!cell || cell[1] === null) return make("p", { class: "quiet" }, `${title(p)}: no picture of this case.`);
    const [, render, target, mask, ...values] = cell;
    const scored = measures.map((_, m) => m).filter((m) => measures[m].quality && values[m] !== null).map((m) => text(m, values[m])).slice(0, 2).join(" / ");
    const box = make("div", { class: "strip" }, make("figure", {}, image(render, "render"), make("figcaption", {}, `${title(p)}: ${scored}`)));
    if (target !== null) {
      const map = make("figure", {}, make("canvas", { width: 1, height: 1 }),
                       make("figcaption", {}, "error, 0", make("span", { class: "scale" }), "64 of 255 and more"));
      box.append(make("figure", {}, image(target, "target"), make("figcaption", {}, "target, held out")), map);
      errors(render, target, mask).then((canvas) => map.firstChild.replaceWith(canvas));
    }
    return box;
  }
  function detail(move) {
    const p = state.point, box = $("detail");
    box.hidden = p === null;
    if (p === null) return;
    box.setAttribute("style", own(points[p].series));
    const close = make("button", { type: "button", class: "close" }, "Close"), pin = make("button", { type: "button", class: "pin" },
      state.beside === p ? "Kept for comparison" : "Keep for comparison");
    close.onclick = () => choose(null);
    pin.onclick = () => { state.beside = p; detail(); };
    const told = measures.map((_, m) => m).filter((m) => spread(p, m)), number = { class: "number" };
    const rows = told.map((m) => make("tr", {}, make("td", {}, measures[m].title), make("td", number, text(m, spread(p, m)[0])),
                                      ...[1, 2, 3].map((i) => make("td", number, many(spread(p, m)) ? text(m, spread(p, m)[i]) : ""))));
    box.replaceChildren(make("div", { class: "top" }, make("h2", {}, title(p)), make("div", {}, pin, " ", close)),
                        make("p", { class: "settings" }, points[p].settings.join(", ")));
    const scene = choices[state.choice].scene, list = points[p].cells.map((c) => c[0]).filter((c) => scene === null || cases[c].scene === scene);
    if (list.some((c) => points[p].cells.find((cell) => cell[0] === c)[1] !== null)) {
      if (!list.includes(state.at)) state.at = list[0];
      const select = make("select", { "aria-label": "Case" }, ...list.map((c) => make("option", { value: c }, `${scenes[cases[c].scene]}${cases[c].name ? ", " + cases[c].name : ""}`)));
      const step = (by, name) => {
        const button = make("button", { type: "button", "aria-label": name, class: name }, by < 0 ? "\u2190" : "\u2192");
        button.onclick = () => { state.at = list[(list.indexOf(state.at) + by + list.length) % list.length]; detail(); box.querySelector(`.${name}`).focus(); };
        return button;
      };
      select.value = state.at;
      select.onchange = () => { state.at = Number(select.value); detail(); };
      box.append(make("div", { class: "cases" }, step(-1, "previous"), select, step(1, "next")), strip(p, state.at));
      if (state.beside !== null && state.beside !== p) box.append(strip(state.beside, state.at));
    } else {
      box.append(make("p", { class: "quiet" }, "The report was made without pictures of this point."));
    }
    box.append(make("div", { class: "scroll" }, make("table", {}, make("tr", {}, make("th", {}, ""), ...["mean", "lower quartile", "median", "upper quartile"].map((name) => make("th", number, name))), ...rows)));
    if (move) box.scrollIntoView({ behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth", block: "nearest" });
  }
  function choose(p, move) {
    state.point = p;
    $("tip").hidden = true;
    for (const [q, mark] of marks) mark.g.classList.toggle("chosen", q === p);
    detail(move);
  }

  /* ---- controls ---- */
  function radios(fieldset, name, list) {
    for (const m of list) {
      const input = make("input", { type: "radio", name, value: m });
      input.checked = m === state[name];
      input.onchange = () => { state[name] = m; draw(); };
      fieldset.append(make("label", {}, input, make("span", {}, measures[m].title)));
    }
  }
  function legend() {
    const redraw = () => { for (const b of $("legend").querySelectorAll("[aria-pressed]")) b.setAttribute("aria-pressed", !state.hidden.has(Number(b.dataset.series))); draw(); };
    series.forEach((s, i) => {
      const button = make("button", { type: "button", "aria-pressed": "true", "data-series": i, style: own(i) },
                          make("svg:svg", { viewBox: "-1.5 -1.5 3 3", "aria-hidden": "true" }, make("svg:path", { d: data.shapes[s.shape] })), s.name);
      button.onclick = () => { if (!state.hidden.delete(i)) state.hidden.add(i); redraw(); };
      button.onpointerenter = button.onfocus = () => light(state.hidden.has(i) ? null : i);
      button.onpointerleave = button.onblur = () => light(null);
      $("legend").append(button);
    });
    if (series.length > 3) {
      const every = make("button", { type: "button", class: "plain" }, "all / none");
      every.onclick = () => { if (state.hidden.size) state.hidden.clear(); else series.forEach((_, i) => state.hidden.add(i)); redraw(); };
      $("legend").append(every);
    }
  }
  function keys(event) {
    const g = event.target.closest(".spot");
    if (!g) return;
    const p = Number(g.dataset.point), steps = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };
    if (event.key === "Enter" || event.key === " ") {
      choose(p, true);
    } else if (event.key === "Escape") {
      $("tip").hidden = true;
    } else if (event.key in steps) {
      let at = spots.indexOf(p), by = steps[event.key];
      const jump = event.key === "ArrowUp" || event.key === "ArrowDown", s = points[p].series;
      do at = (at + by + spots.length) % spots.length; while (jump && points[spots[at]].series === s && spots[at] !== p);
      g.setAttribute("tabindex", -1);
      marks.get(spots[at]).g.setAttribute("tabindex", 0);
      marks.get(spots[at]).g.focus();
    } else {
      return;
    }
    event.preventDefault();
  }
  function theme() {
    const names = ["auto", "light", "dark"], now = names.indexOf(document.documentElement.dataset.theme || "auto");
    const next = names[(now + 1) % names.length];
    document.documentElement.dataset.theme = next;
    $("theme").textContent = `Theme: ${next}`;
  }

  /* Returns the point nearest to a tap, within half a finger's width, or null. */
  function nearest(event) {
    const svg = $("canvas").firstChild, box = svg.getBoundingClientRect(), ratio = box.width / svg.viewBox.baseVal.width;
    const away = ([, mark]) => Math.hypot(event.clientX - box.x - mark.x * ratio, event.clientY - box.y - mark.y * ratio);
    const best = [...marks].reduce((a, b) => (a === null || away(b) < away(a) ? b : a), null);
    return best !== null && away(best) <= 22 ? best[0] : null;
  }
  const spotOf = (event) => (event.target.closest ? event.target.closest(".spot") : null);
  $("canvas").addEventListener("pointerover", (e) => { const g = spotOf(e); if (g) tip(Number(g.dataset.point)); });
  $("canvas").addEventListener("pointerout", () => { $("tip").hidden = true; });
  $("canvas").addEventListener("focusin", (e) => { const g = spotOf(e); if (g) tip(Number(g.dataset.point)); });
  $("canvas").addEventListener("focusout", () => { $("tip").hidden = true; });
  $("canvas").addEventListener("click", (e) => {
    const near = nearest(e), g = spotOf(e); // a click from assistive software has no position, only a target
    if (near !== null || g) choose(near ?? Number(g.dataset.point), true);
  });
  $("canvas").addEventListener("keydown", keys);
  $("theme").onclick = theme;
  const there = (m) => points.some((_, p) => choices[0].spreads[p][m]);
  radios($("qualities"), "quality", measures.map((_, m) => m).filter((m) => measures[m].quality && there(m)));
  radios($("costs"), "cost", measures.map((_, m) => m).filter((m) => measures[m].cost && there(m)));
  choices.forEach((c, i) => $("scene").querySelector("select").append(make("option", { value: i }, c.scene === null ? `all ${scenes.length}` : scenes[c.scene])));
  $("scene").hidden = choices.length < 2;
  $("scene").querySelector("select").value = state.choice;
  $("scene").querySelector("select").onchange = (e) => { state.choice = Number(e.target.value); draw(); detail(); };
  $("about").append(` ${data.about}`);
  $("left-out").textContent = data.leftOut;
  legend();
  $("controls").hidden = $("legend").hidden = false;
  new ResizeObserver(() => { if ($("canvas").clientWidth !== draw.width) { draw.width = $("canvas").clientWidth; draw(); } }).observe($("canvas"));
  draw();
  draw.width = $("canvas").clientWidth;
})();
