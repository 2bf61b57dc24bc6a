#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""chart's report in a headless Chromium: every axis, the legend, pointer and keyboard, pictures, light and dark, a
phone; no errors, no requests.

report.py TRIM3R [FOLDER]; with FOLDER, screenshots go there."""
import sys
import tempfile

import browser
from checks import check, done, run, skip
from common import built_in, made_up

trim3r = sys.argv[1]
looks = sys.argv[2] if len(sys.argv) > 2 else None
program = browser.find()
if program is None:
    skip("there is no Chromium (tools/setup --tests installs it)")

SPOTS = "[...document.querySelectorAll('.live .spot')]"
TITLES = f"{SPOTS}.map((g) => g.getAttribute('aria-label'))"
TICKS = "[...document.querySelectorAll('.live text:not(.axis)')].map((t) => t.textContent)"
TOP = "Math.min(...[...document.querySelectorAll('.live .near')].map((c) => Number(c.getAttribute('cy'))))"
COLOUR = "getComputedStyle(document.body).backgroundColor"


def opened(page, path):
    page.open(path)
    page.wait("document.querySelector('.live .spot') !== null")


def axes(page, svg_titles):
    """The page first shows what C drew; every choice changes the drawing."""
    titles = page.value(TITLES)
    check(len(titles) == 9, f"a point for each method and budget: {titles}")
    front = [t.replace(", on the front", "") for t in titles if "on the front" in t]
    check(sorted(front) == sorted(t.replace(", on the front", "") for t in svg_titles if "on the front" in t),
          f"script and C agree on the front: {front}")
    check(len(page.value("[...document.querySelectorAll('.ring')].map(() => 1)")) == len(front), "it is ringed")
    check(any("630 ms" in t and "30.85 dB" in t for t in titles), "means over scenes")
    check(len(page.value("[...document.querySelectorAll('.whisker')].map(() => 1)")) == 9, "times have a spread")
    seen = set()
    for quality in (1, 2):
        for cost in (1, 2, 3, 4):
            page.click(f"#qualities label:nth-of-type({quality}) input")
            page.click(f"#costs label:nth-of-type({cost}) input")
            check(page.value(f"{SPOTS}.length") == 9, "every point on every axis")
            seen.add(tuple(page.value(TITLES)))
            check(len(page.value(TICKS)) >= 6, "ticks")
    check(len(seen) == 8, "each pair of axes is another chart")
    check(page.value("document.querySelectorAll('#qualities input').length") == 2, "only qualities that there are")
    page.click("#qualities label:nth-of-type(1) input")
    page.click("#costs label:nth-of-type(1) input")


def scenes(page):
    everything = page.value(TITLES)
    for index, psnr in ((1, "29.85"), (3, "31.85")):
        page.value(f"""(() => {{ const s = document.querySelector('#scene select'); s.value = {index};
                       s.dispatchEvent(new Event('change')); }})()""")
        check(any(t.startswith(f"best, 100 % kept: {psnr} dB") for t in page.value(TITLES)), f"scene {index} alone")
    page.value("(() => { const s = document.querySelector('#scene select'); s.value = 0; s.dispatchEvent(new Event('change')); })()")
    check(page.value(TITLES) == everything, "and all of them again")


def legend(page):
    ticks = page.value(TICKS)
    button = "#legend [data-series='0']"
    check(page.value("[...document.querySelectorAll('#legend [data-series]')].map((b) => b.textContent)") ==
          ["best", "worse", "fast"], "the legend")
    top = page.value(TOP)
    page.click(button)
    titles = page.value(TITLES)
    check(abs(page.value(TOP) - top) < 20 and page.value(TICKS) != ticks, "the axes follow what is shown")
    check(page.value(f"document.querySelector(\"{button}\").getAttribute('aria-pressed')") == "false", "it tells")
    check(len(titles) == 6 and not any(t.startswith("best") for t in titles), "a series goes")
    check(any(t.startswith("worse") and "on the front" in t for t in titles), "and the front is that of what is left")
    page.click(button)
    check(len(page.value(TITLES)) == 9, "and comes back")
    page.hover("#legend [data-series='1']")
    check(page.value("document.querySelectorAll('.muted .lit').length") >= 4, "a series lights up under the pointer")


def pointer_and_keys(page):
    tip = "document.querySelector('#tip')"
    page.hover(".spot[data-point='0'] .mark")
    check(not page.value(f"{tip}.hidden") and "best, 100 % kept" in page.value(f"{tip}.textContent"), "hover shows settings")
    check("its quartiles" in page.value(f"{tip}.textContent"), "and the spread of a time")
    browser.look(page, looks, "hover")
    page.mouse("mouseMoved", [2, 2])
    check(page.value(f"{tip}.hidden"), "only while the pointer is there")
    check(page.value(f"{SPOTS}.filter((g) => g.tabIndex === 0).length") == 1, "the chart is one stop of the tabulator")
    page.value(f"{SPOTS}.find((g) => g.tabIndex === 0).focus()")
    check(not page.value(f"{tip}.hidden"), "focus shows settings, too")
    visited = set()
    for _ in range(9):
        page.key("ArrowRight", 39)
        visited.add(page.value("document.activeElement.dataset.point"))
    check(len(visited) == 9, f"arrow keys visit every point: {visited}")
    series = page.value("document.activeElement.dataset.series")
    page.key("ArrowDown", 40)
    check(page.value("document.activeElement.dataset.series") != series, "and go from series to series")
    page.key("Enter", 13, "\r")
    name = page.value("document.activeElement.getAttribute('aria-label')")
    heading = page.value("document.querySelector('#detail h2').textContent")
    check(name.startswith(heading + ":"), f"Enter opens the point: {heading}, {name}")
    page.key("Escape", 27)
    check(page.value(f"{tip}.hidden"), "Escape closes the hint")
    page.click("#detail .close")
    check(page.value("document.querySelector('#detail').hidden"), "a point can be closed")


def colours(page):
    page.scheme("light")
    light = page.value(COLOUR)
    page.scheme("dark")
    dark = page.value(COLOUR)
    check(light != dark, "the page follows the reader's setting")
    page.click("#theme")
    check(page.value(COLOUR) == light, "light on request")
    page.click("#theme")
    page.scheme("light")
    check(page.value(COLOUR) == dark, "dark on request")
    browser.look(page, looks, "dark")
    page.click("#theme")
    check(page.value(COLOUR) == light, "and what the reader has set again")


def phone(page):
    page.size(360, 740, mobile=True)
    page.wait("document.querySelector('.live').viewBox.baseVal.width < 400")
    check(page.value("document.documentElement.scrollWidth") <= 360, "nothing is wider than a phone")
    check(page.value("[...document.querySelectorAll('.live text')].every((t) => t.getBoundingClientRect().right <= 361)"),
          "nor are the chart's texts")
    found = browser.on_a_phone(page)
    check(found == [], f"readable and touchable: {found}")
    browser.look(page, looks, "phone")
    first = ".spot[data-point='0'] .mark"
    x, y = page.place(first)
    tap = {"button": "left", "clickCount": 1}
    page.mouse("mousePressed", [x - 40, y - 30], **tap)
    page.mouse("mouseReleased", [x - 40, y - 30], **tap)
    check(page.value("document.querySelector('#detail').hidden"), "a tap far from every point opens none")
    page.mouse("mousePressed", [x - 19, y], **tap)
    page.mouse("mouseReleased", [x - 19, y], **tap)
    check(page.value("document.querySelector('#detail h2').textContent").startswith("best, 100 %"), "a tap beside a point opens it")
    found = browser.on_a_phone(page)
    check(found == [], f"so is an open point: {found}")
    page.click("#detail .close")
    page.size(1200, 1000)
    page.wait("document.querySelector('.live').viewBox.baseVal.width > 900")


def pictures(page, path):
    opened(page, path)
    shots = "[...document.querySelectorAll('#detail .strip img')]"
    page.click(".spot[data-point='0'] .mark")
    check(page.value(f"{shots}.map((i) => i.alt)") == ["render", "target"], "a click shows the pictures")
    page.wait("document.querySelector('#detail canvas').width === 48")
    check(page.value(f"Promise.all({shots}.map((i) => i.decode())).then(() => {shots}.every((i) => i.naturalWidth === 48))"),
          "that there are")
    mean = """(() => { const c = document.querySelector('#detail canvas'), d = c.getContext('2d').getImageData(0, 0, 48, 48).data;
        let sum = 0; for (let i = 0; i < d.length; i += 4) sum += d[i] + d[i + 1] + d[i + 2]; return sum / 48 / 48 / 3; })()"""
    good = page.value(mean)
    check(good > 0, "an error map that is not empty")
    browser.look(page, looks, "pictures")
    cases = page.value("[...document.querySelectorAll('#detail select option')].map((o) => o.textContent)")
    check(len(cases) > 2 and any(c.startswith("den, frame") for c in cases), f"the case can be chosen: {cases}")
    first = page.value(f"{shots}[0].src")
    page.click("#detail .next")
    check(page.value(f"{shots}[0].src") != first, "another case, another picture")
    page.click("#detail .previous")
    check(page.value(f"{shots}[0].src") == first, "and back")
    page.click("#detail .pin")
    random = page.value(f"{SPOTS}.find((g) => g.getAttribute('aria-label').startsWith('random, 5 %')).dataset.point")
    page.click(f".spot[data-point='{random}'] .mark")
    page.wait("[...document.querySelectorAll('#detail canvas')].every((c) => c.width === 48)")
    check(page.value(f"{shots}.length") == 4, "two points side by side")
    check(page.value(mean) > 2 * good, "a bad render has a brighter error map")
    page.click("#front td button")
    check(page.value("document.querySelector('#detail h2').textContent").startswith("trim3r"), "the table opens points, too")


with tempfile.TemporaryDirectory() as folder:
    known, both, svg = f"{folder}/known.html", f"{folder}/both.html", f"{folder}/known.svg"
    run(trim3r, "chart", made_up(f"{folder}/t.csv"), "-o", known, "--svg", svg, "--against", "build_ms")
    tables, folders = built_in(trim3r, folder)
    run(trim3r, "chart", *tables, "--pictures", folders[0], "--pictures", folders[1], "--against", "scene_bytes", "-o", both)
    titles = [line.split("</title>")[0] for line in open(svg, encoding="utf-8").read().split("<title>")[1:]]
    try:
        tab = browser.Page(program)
    except (EOFError, TimeoutError) as error:
        skip(f"{program} does not start here: {error}")
    try:
        opened(tab, known)
        browser.look(tab, looks, "light")
        for part in (axes, scenes, legend, pointer_and_keys, colours, phone):
            part(*((tab, titles) if part is axes else (tab,)))
        pictures(tab, both)
        check(tab.logged == [], f"the console is silent: {tab.logged}")
        away = [url for url in tab.requested if not url.startswith(("data:", f"file://{folder}/"))]
        check(away == [], f"nothing is asked for: {away}")
        check(sum(not url.startswith("data:") for url in tab.requested) == 2, "but the two pages themselves")
    finally:
        tab.close()
done()
