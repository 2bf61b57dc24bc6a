#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""page.py TRIM3R [FOLDER]: the page of `trim3r stress --html` in a headless Chromium: the worst cases in falling
order as in the table of the same run, refused cells, every picture present, light and dark, a phone; no errors,
no requests. With FOLDER, screenshots go there."""
import csv
import re
import sys
import tempfile

import browser
from checks import check, done, near, run, skip

trim3r = sys.argv[1]
looks = sys.argv[2] if len(sys.argv) > 2 else None
program = browser.find()
if program is None:
    skip("there is no Chromium (tools/setup --tests installs it)")

WORST = 5
METHODS = ("trim3r", "random")
SECTIONS = """[...document.querySelectorAll('section')].map((s) => ({
    heading: s.querySelector('h2').textContent,
    captions: [...s.querySelectorAll('figcaption')].map((f) => f.textContent) }))"""
TABLES = """[...document.querySelectorAll('details')].map((d) => ({ summary: d.querySelector('summary').textContent,
    open: d.open, rows: [...d.querySelectorAll('tr')].map((r) => [...r.children].map((c) => c.textContent)) }))"""
IMAGES = "[...document.querySelectorAll('img')]"
COLOUR = "getComputedStyle(document.body).backgroundColor"
INK = "getComputedStyle(document.querySelector('h1')).color"


def made(folder):
    """Makes the page and the rows of a run: a scene, losses of several perturbations, a refused cell."""
    page, table = f"{folder}/worst.html", f"{folder}/worst.csv"
    run(trim3r, "stress", "--working", "40x40", "--rows", "noise,depth-all,depth-lattice,pose,black,scene-bars,scene-wall",
        "--captures", "0", "--methods", ",".join(METHODS), "--keep", "20", "--csv", table, "--html", page, "--worst", WORST)
    with open(table, newline="", encoding="utf-8") as file:
        return page, list(csv.DictReader(file))


def expected(rows):
    """Returns [(perturbation, strength, loss)]: for each perturbation the worst of the first method, the worst
    first."""
    worst = {}
    for row in rows:
        if row["method"] == METHODS[0] and row["psnr_lost"] != "":
            lost = float(row["psnr_lost"])
            if row["perturbation"] not in worst or lost > worst[row["perturbation"]][1]:
                worst[row["perturbation"]] = (row["strength"], lost)
    order = sorted(worst, key=lambda name: -worst[name][1])
    return [(name, *worst[name]) for name in order][:WORST]


def worst_cases(page, rows):
    sections, want = page.value(SECTIONS), expected(rows)
    check(len(sections) == len(want) == WORST, f"as many as were asked for: {len(sections)}")
    shown = []
    for section, (name, strength, lost) in zip(sections, want):
        check(section["heading"].startswith(f"{name} {strength} "), f"{section['heading']}, not {name} {strength}")
        captions = section["captions"]
        check(captions[:5] == ["context a", "its depth, near is bright", "context b", "its depth, near is bright", "target"],
              f"what goes in: {captions}")
        rendered = [c for c in captions if "% kept" in c]
        check([c.split(",")[0] for c in rendered] == list(METHODS), f"what each method made of it: {rendered}")
        shown.append(float(re.search(r"(-?[\d.]+) lost", rendered[0])[1]))
        near(shown[-1], lost, 0.006, f"{name}: the loss of the table")
    check(shown == sorted(shown, reverse=True) and shown[0] > shown[-1], f"the greatest loss first: {shown}")
    text = page.value("document.querySelector('p').textContent")
    check("trim3r at 20 % loses most PSNR" in text, f"by what it is ranked: {text}")


def tables(page, rows):
    refused, everything = page.value(TABLES)
    check(refused["open"] and not everything["open"], "what was refused is seen at once, the rows at a click")
    lines = refused["rows"][1:]
    names = {(row["perturbation"], row["strength"]) for row in rows if row["status"] == "refused"}
    check(("depth-all", "100") in names, "something was refused")
    check({(line[2], line[3].split(" ")[0]) for line in lines} == names, f"it is listed: {lines}")
    check(all(line[5] == "refused" and line[6] for line in lines), "with its reason")
    check(any("no valid depth" in line[6] and line[4] == "every method and budget" for line in lines), "once a cell")
    check(len(everything["rows"]) == 1 + len(rows), "all rows")
    page.click("details:nth-of-type(2) summary")
    check(page.value(TABLES)[1]["open"], "a click opens them")
    page.click("details:nth-of-type(2) summary")


def pictures(page):
    loaded = f"Promise.all({IMAGES}.map((i) => {{ i.loading = 'eager'; return i.decode(); }})).then(() => " \
             f"{IMAGES}.every((i) => i.naturalWidth === 40 && i.naturalHeight === 40 && i.alt !== ''))"
    check(page.value(loaded), "every picture is there")
    filters = "[...document.querySelectorAll('.compared')].map((v) => getComputedStyle(v).filter)"
    check(set(page.value(filters)) == {"none"}, "pictures first")
    page.click("label[for='errors']")
    check(set(page.value(filters)) == {"brightness(3)"}, "then their errors")
    browser.look(page, looks, "errors")
    page.click("label[for='errors']")


def luminance(colour):
    red, green, blue = (float(v) for v in re.findall(r"[\d.]+", colour)[:3])
    return (0.2126 * red + 0.7152 * green + 0.0722 * blue) / 255


def colours(page):
    for scheme, dark in (("light", False), ("dark", True)):
        page.scheme(scheme)
        paper, ink = luminance(page.value(COLOUR)), luminance(page.value(INK))
        check((paper < 0.5) == dark and (ink > 0.5) == dark and abs(paper - ink) > 0.6, f"{scheme}: {paper}, {ink}")
        browser.look(page, looks, scheme)
    page.scheme("light")


def phone(page):
    found = browser.on_a_phone(page)
    check(found == [], f"readable and touchable: {found}")
    page.value("document.querySelector('section').scrollIntoView()")
    rows = page.value("[...document.querySelectorAll('section:first-of-type figure')].map((f) => f.getBoundingClientRect().top)")
    check(len(set(rows)) < len(rows), "pictures stand side by side")
    browser.look(page, looks, "phone")
    page.size(360, 740, mobile=True)
    check(page.value("document.documentElement.scrollWidth") <= 360, "nothing is wider than a smaller phone")


with tempfile.TemporaryDirectory() as folder:
    path, measured = made(folder)
    try:
        tab = browser.Page(program)
    except (EOFError, TimeoutError) as error:
        skip(f"{program} does not start here: {error}")
    try:
        tab.open(path)
        worst_cases(tab, measured)
        tables(tab, measured)
        for part in (pictures, colours, phone):
            part(tab)
        check(tab.logged == [], f"the console is silent: {tab.logged}")
        away = [url for url in tab.requested if not url.startswith(("data:", f"file://{folder}/"))]
        check(away == [], f"nothing is asked for: {away}")
        check(sum(not url.startswith("data:") for url in tab.requested) == 1, "but the page itself")
    finally:
        tab.close()
done()
