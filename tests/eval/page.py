#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""page.py TRIM3R [FOLDER]: the page of `trim3r eval --html` in a headless Chromium, on a phone: the scores of the
run, every picture present, error maps at a touch; no errors, no requests. With FOLDER, screenshots go there."""
import csv
import os
import sys
import tempfile

from checks import check, done, run, skip

import browser

trim3r = sys.argv[1]
looks = sys.argv[2] if len(sys.argv) > 2 else None
program = browser.find()
if program is None:
    skip("there is no Chromium (tools/setup --tests installs it)")

METHODS = ("trim3r", "random")
TABLES = """[...document.querySelectorAll('details')].map((d) => ({ summary: d.querySelector('summary').textContent,
    note: (d.querySelector('p') || d.querySelector('summary')).textContent,
    rows: [...d.querySelectorAll('tr')].map((r) => [...r.children].map((c) => c.textContent)) }))"""


def made(folder):
    page, table = f"{folder}/page.html", f"{folder}/table.csv"
    recordings = []
    for name, seed in (("room", "1"), ("den", "5")):
        recordings.append(f"{folder}/{name}.mcap")
        run(trim3r, "room", "--size", "48x48", "--seed", seed, "-o", recordings[-1])
    run(trim3r, "eval", *recordings, "--keep", "100,5", "--methods", ",".join(METHODS), "--csv", table, "--html", page)
    with open(table, newline="", encoding="utf-8") as file:
        return page, list(csv.DictReader(file))


def tables(page, rows):
    means, scores = page.value(TABLES)
    check((means["summary"], scores["summary"]) == ("Means", "Scores"), "means of the scenes, then all rows")
    heading, *lines = scores["rows"]
    check(len(lines) == len(rows) == 24 and all(len(line) == len(heading) for line in lines), f"every row: {len(lines)} of {len(rows)}")
    for line, row in zip(lines, rows):
        for name in ("scene", "method", "keep", "gaussians"):
            check(line[heading.index(name)] == row[name], f"{name}: {line}, {row}")
        for name in ("psnr_all", "psnr"):
            check(abs(float(line[heading.index(name)]) - float(row[name])) < 0.006, f"{name}: {line}, {row}")
    check("head" not in heading and f"head {rows[0]['head']}" in scores["note"], f"what all rows share: {scores['note']}")
    seen = page.value("""[...document.querySelectorAll('details[open] th')].filter((c) => c.getBoundingClientRect().right <= 390)
                         .map((c) => c.textContent)""")
    check({"scene", "method", "keep", "psnr_all"} <= set(seen), f"the score is seen without scrolling: {seen}")


def pictures(page):
    images = "[...document.querySelectorAll('img')]"
    check(page.value(f"Promise.all({images}.map((i) => {{ i.loading = 'eager'; return i.decode(); }})).then(() => "
                     f"{images}.every((i) => i.naturalWidth === 48 && i.alt !== ''))"), "every picture is there")
    page.value("document.querySelector('.compared').scrollIntoView()")
    browser.look(page, looks, "pictures")
    switch, place = "(() => { const b = document.querySelector('label').getBoundingClientRect(); return [b.x, b.y]; })()", "scrollY"
    (x, y), scrolled = page.value(switch), page.value(place)
    check(0 < x < 390 and 0 < y < 844 and scrolled > 0, f"the switch stays at hand: {x}, {y}")
    page.mouse("mousePressed", [x + 20, y + 20], button="left", clickCount=1)
    page.mouse("mouseReleased", [x + 20, y + 20], button="left", clickCount=1)
    check(page.value(place) == scrolled, "and moves nothing")
    filters = "[...document.querySelectorAll('.compared')].map((v) => getComputedStyle(v).filter)"
    check(set(page.value(filters)) == {"brightness(3)"}, "errors at a touch")
    browser.look(page, looks, "errors")


with tempfile.TemporaryDirectory() as folder:
    path, measured = made(folder)
    try:
        tab = browser.Page(program)
    except (EOFError, TimeoutError) as error:
        skip(f"{program} does not start here: {error}")
    try:
        tab.open(path)
        found = browser.on_a_phone(tab)
        check(found == [], f"readable and touchable: {found}")
        browser.look(tab, looks, "top")
        tables(tab, measured)
        pictures(tab)
        check(tab.logged == [], f"the console is silent: {tab.logged}")
        check(tab.requested == [f"file://{os.path.abspath(path)}"] + [url for url in tab.requested if url.startswith("data:")],
              f"nothing but the page is asked for: {tab.requested}")
    finally:
        tab.close()
done()
