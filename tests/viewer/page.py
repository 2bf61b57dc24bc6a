#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""page.py TRIM3R [FOLDER]: the viewer in a headless Chromium: its hashes are the native ones, in one thread and in
several, the slider rebuilds, every overlay differs, mouse, touch and keyboard move the camera, a crop is drawn and saved,
files are opened, windows of all sizes; no errors, no requests. With FOLDER, screenshots go there."""
import base64
import contextlib
import gzip
import io
import json
import math
import os
import re
import shlex
import struct
import subprocess
import sys
import tempfile
import time
import zipfile

import browser
from checks import check, done, run, skip
from common import need_page
from hostile import formats

TRIM3R = os.path.abspath(sys.argv[1])
looks = os.path.abspath(sys.argv[2]) if len(sys.argv) > 2 else None
program = browser.find()
if program is None:
    skip("there is no Chromium (tools/setup --tests installs it)")

PICTURE = """(() => { const c = document.getElementById('picture'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
    let h = 2166136261; for (let i = 0; i < d.length; i++) h = Math.imul(h ^ d[i], 16777619); return h >>> 0; })()"""
FIRST = """(async () => { const image = new Image(), c = document.createElement('canvas');
    image.src = document.getElementById('picture').style.backgroundImage.slice(5, -2);
    await image.decode();
    [c.width, c.height] = [image.width, image.height];
    c.getContext('2d').drawImage(image, 0, 0);
    const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
    let h = 2166136261; for (let i = 0; i < d.length; i++) h = Math.imul(h ^ d[i], 16777619); return h >>> 0; })()"""
REMARK = "document.getElementById('remark').textContent"
STATUS = "document.getElementById('status').textContent"
STAGES = "Object.fromEntries([...document.querySelectorAll('#stages tbody tr')].map((r) => [r.cells[0].textContent, r.cells[2].textContent]))"


def drawn(page, action):
    """Returns the picture after an action that draws."""
    page.wait("isStill()")
    before = page.value("Number(document.body.dataset.drawn ?? 0)")
    action()
    page.wait(f"Number(document.body.dataset.drawn ?? 0) > {before}")
    return page.value(PICTURE)


SIMD128 = 1 << 16  # T3R_CPU_SIMD128


def opened(page, path):
    page.open(path)
    page.wait("document.body.dataset.drawn !== undefined && document.body.dataset.gaussians !== undefined")
    check(page.value("document.body.dataset.cpu") == str(SIMD128), "the page draws with vectors")


def slide(page, value):
    page.value(f"(() => {{ const s = document.getElementById('slider'); s.value = {value}; s.dispatchEvent(new Event('input')); }})()")


def budget(page, room):
    """Moves the slider from 100 to 2 %: another picture each time, and the bits of the native program."""
    seen = set()
    for share in (100, 30, 10, 2):
        wanted = max(1, round(page.value("data.valid") * share / 100))
        value = page.value(f"sliderAt({share})")
        before = page.value("document.body.dataset.hash")
        slide(page, value)
        page.wait(f"document.body.dataset.hash !== {json.dumps(before)}")
        count = int(page.value("document.body.dataset.gaussians"))
        check(abs(count - wanted) <= 0.01 * wanted, f"{share} %: {count} Gaussians, not about {wanted}")
        native = json.loads(run(TRIM3R, "replay", room, "--context", "0,2", "--gaussians", count, "--json").stdout)["stages"]
        for stage, digits in page.value(STAGES).items():
            check(native[stage] == digits, f"{share} %, {stage}: {digits} in the page, {native[stage]} natively")
        page.wait("isStill()")
        seen.add(page.value(PICTURE))
    check(len(seen) == 4, "every budget is another picture")
    shown = float(re.search(r"frame\s1\s([0-9.]+)\sdB", page.value(STATUS))[1])
    row = json.loads(run(TRIM3R, "eval", room, "--context", "0,2", "--target", "1", "--gaussians", count, "--json").stdout)["rows"][0]
    check(abs(shown - row["psnr_all"]) <= 0.005, f"built here: {shown} dB in the page, {row['psnr_all']} dB by eval")
    check("PSNR of new views: frame\u00a01" in page.value(STATUS), f"the frame between the context frames is a new view: {page.value(STATUS)}")


def shows(page):
    pictures = set()
    for show in ("depth", "alpha", "frame", "error", "mask", "clusters", "texture", "picture"):
        pictures.add(drawn(page, lambda: page.value(f"document.querySelector('input[name=show][value={show}]').click()")))
        browser.look(page, looks, f"view-{show}")
    check(len(pictures) == 8, f"eight ways to show a frame, {len(pictures)} pictures")


def motion(page):
    start = drawn(page, lambda: page.click("#reset"))
    seen = {start}
    page.value("document.getElementById('picture').focus()")
    for name, code, text in (("ArrowLeft", 37, ""), ("ArrowUp", 38, ""), ("w", 87, "w"), ("+", 187, "+")):
        seen.add(drawn(page, lambda: page.key(name, code, text)))
    check(page.value("document.querySelectorAll('#frames [aria-pressed=true]').length") == 0, "a move leaves the frame")
    x, y = page.place("#picture")

    def drag():
        page.mouse("mousePressed", (x, y), button="left", clickCount=1)
        page.mouse("mouseMoved", (x + 60, y + 20), button="left", buttons=1)
        page.mouse("mouseReleased", (x + 60, y + 20), button="left", clickCount=1)

    seen.add(drawn(page, drag))
    page.value("document.querySelector('input[name=motion][value=fly]').click()")
    seen.add(drawn(page, drag))
    seen.add(drawn(page, lambda: page.mouse("mouseWheel", (x, y), deltaX=0, deltaY=-200)))
    check(len(seen) == 8, f"seven moves, {len(seen)} pictures")
    check(drawn(page, lambda: page.key("r", 82, "r")) == start, "and back to the start")
    seen.add(drawn(page, lambda: page.key("2", 50, "2")))
    check(page.value("document.querySelector('#frames [aria-pressed=true]').textContent") == "frame 2", "frames by number")


def touch(page):
    """Two fingers pinch and drag; one orbits."""
    x, y = page.place("#picture")

    def fingers(*moves):
        for kind, points in zip(("touchStart", *("touchMove" for _ in moves[1:]), "touchEnd"), (*moves, ())):
            page.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x + dx, "y": y + dy, "id": i} for i, (dx, dy) in enumerate(points)])

    page.value("goTo(0)")
    far = page.value("camera.distance")
    fingers(((-40, 0), (40, 0)), ((-80, 0), (80, 0)))
    check(abs(page.value("camera.distance") / far - 0.5) < 0.01, "two fingers twice as far apart: half the distance")
    page.value("goTo(0)")
    axes = page.value("JSON.stringify(camera.axes)")
    place = page.value("camera.position")
    fingers(((-40, 0), (40, 0)), ((-40, 50), (40, 50)))
    moved = [b - a for a, b in zip(place, page.value("camera.position"))]
    check(page.value("JSON.stringify(camera.axes)") == axes and max(map(abs, moved)) > 0, "two fingers drag it sideways")
    fingers(((0, 0),), ((30, 0),))
    check(page.value("JSON.stringify(camera.axes)") != axes, "one finger orbits")
    page.value("goTo(0)")


def keys_are_listed(page):
    page.value("document.getElementById('picture').focus()")
    for is_open in (True, False):
        page.key("?", 191, "?")
        check(page.value("document.getElementById('how').open") == is_open, f"? opens and closes the list of keys: {is_open}")


def along_the_recording(page):
    """The slider stands at each recorded place, and where the camera goes; playing goes on to the last one."""
    count = page.value("data.path.length")
    check(count > 2 and page.value("document.getElementById('along').max") == str(count - 1), f"{count} places")
    at = "(() => { const p = data.path[PLACE]; return camera.position.every((x, i) => x === p[i]); })()"
    page.value("(() => { const s = document.getElementById('along'); s.value = 1; s.dispatchEvent(new Event('input')); })()")
    check(page.value(at.replace("PLACE", "1")), "the second place")
    plain = drawn(page, lambda: page.value("approach(3), moved()"))
    check(drawn(page, lambda: page.click("#trace")) != plain, "the path is drawn")
    page.click("#trace")
    label = "document.getElementById('along-text').textContent"
    for frame in (2, 1, 0):  # of the page: frames 1, 2 and 0 of the recording
        page.value(f"goTo({frame})")
        place = int(page.value(f"data.frames[{frame}].name").split()[1])
        stands = page.value("Number(document.getElementById('along').value)"), page.value(label)
        check(stands == (place, f"{place + 1} of {count}"), f"the slider follows the camera to frame {place}: {stands}")
    page.value("move(.01, 0, 0), moved()")
    check(page.value(label) == f"1 of {count}, the nearest", f"beside a place: {page.value(label)}")
    page.click("#play")
    page.wait("path.playing === 0")
    check(page.value(at.replace("PLACE", f"{count - 1}")), "played to the last place")
    near = page.value(PICTURE)
    check(drawn(page, lambda: page.value("move(0, 0, -2000), moved()")) != near, "from 2,000 units away")
    check(not page.value("document.getElementById('status').classList.contains('bad')"), f"no error: {page.value(STATUS)}")
    page.value("goTo(0)")
    page.wait(f"isStill() && {STATUS}.includes('dB')")


def accessible(page):
    unnamed = page.value("""[...document.querySelectorAll('input, button, canvas, progress')].filter((e) =>
        !e.getAttribute('aria-label') && !e.textContent && !(e.labels && e.labels.length)).length""")
    check(unnamed == 0, "everything that can be used has a name")
    check(page.value("document.getElementById('slider').getAttribute('aria-valuetext')").endswith("%"), "the slider tells its value")
    for scheme in ("light", "dark"):
        page.scheme(scheme)
        least = page.value("""(() => {
            const light = (c) => { const [r, g, b] = c.match(/[\\d.]+/g).map((x) => (x /= 255) <= .03928 ? x / 12.92 : ((x + .055) / 1.055) ** 2.4);
                                   return .2126 * r + .7152 * g + .0722 * b; };
            const back = (e) => { while (e && getComputedStyle(e).backgroundColor === 'rgba(0, 0, 0, 0)') e = e.parentElement;
                                  return light(getComputedStyle(e).backgroundColor); };
            return Math.min(...[...document.querySelectorAll('h1, p, legend, span, button, th, td, summary, output')]
                .filter((e) => e.textContent && e.offsetParent).map((e) => {
                    const [a, b] = [light(getComputedStyle(e).color), back(e)];
                    return (Math.max(a, b) + .05) / (Math.min(a, b) + .05); })); })()""")
        check(least >= 4.5, f"contrast of texts is at least 4.5 : 1 in {scheme}: {least:.2f}")
    page.scheme("light")


def at_width(page, width):
    page.value(f"document.querySelector('main').style.gridTemplateColumns = '{width}px 20rem'")
    page.value("goTo(0)")
    page.wait(f"isStill() && document.getElementById('picture').width === {width}")


def same_pictures(page, scene, room):
    """The picture that the file holds is the one that the page draws. A picture at rest has the hash of `trim3r render`;
    one that moves is smaller."""
    at_width(page, 64)
    check(page.value(FIRST) == page.value(PICTURE), "the first picture is the page's own")
    at_width(page, 320)
    native = json.loads(run(TRIM3R, "render", scene, room, "--view", "0", "--size", "320x240", "--json", "-o", f"{room}.png").stdout)["hash"]
    told = page.value("document.getElementById('drawn').textContent")
    check(re.fullmatch(f"320 x 240 in [0-9]+ ms, hash {native}\\.", told), f"a picture: {told}, natively {native}")
    page.value("globalThis.coarse = 0, coarseness = .5, done.draw = ((draw) => (a) => { coarse = a.coarse ? a.width : coarse; draw(a); })(done.draw)")
    page.value("turn(.1, 0), moved()")
    page.wait("isStill()")
    check(page.value("coarse") == 160 and page.value("document.getElementById('picture').width") == 320, "coarse, then whole")


def sketched(page):
    """A coarse picture of few Gaussians resembles one of the same size that has all of them."""
    page.value("goTo(0)")
    page.wait("isStill()")
    page.value("""globalThis.limit = 0, globalThis.answer = null,
        drawing = ((request) => (how) => ({ ...request(how), most: limit }))(drawing),
        done.draw = ((draw) => (a) => { answer = { gaussians: a.gaussians, pixels: a.pixels.slice() }; draw(a); })(done.draw)""")
    counts, pictures = [], []
    for limit in (0, 300, 1):
        drawn(page, lambda: page.value(f"limit = {limit}, draw()"))
        counts.append(page.value("answer.gaussians"))
        pictures.append(base64.b64decode(page.value("btoa(String.fromCharCode(...answer.pixels.filter((x, i) => i % 4 < 3)))")))
    whole, *others = pictures
    psnr = [10 * math.log10(65025 * len(whole) / sum((a - b) ** 2 for a, b in zip(whole, other))) for other in others]
    check(counts[0] > 600 and counts[1:] == [300, 1], f"Gaussians of pictures: {counts}")
    check(psnr[0] > 20 > psnr[1] + 5, f"300 Gaussians resemble the whole by {psnr[0]:.2f} dB, one by {psnr[1]:.2f} dB")


def fits(page, looks_as):
    """The picture and the lines below it are in the window, without scrolling."""
    for width, height in ((320, 640), (1280, 800), (2560, 1440), (3840, 2160)):
        page.size(width, height)
        page.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        low = page.value("document.getElementById('drawn').getBoundingClientRect().bottom")
        wide = page.value("document.documentElement.scrollWidth")
        check(low <= height and wide <= width, f"{width}x{height}: down to {low}, {wide} wide")
        page.wait("isStill()")
        drawn_width, shown_width = page.value("[canvas.width, Math.min(most.width, canvas.clientWidth)]")
        check(drawn_width == shown_width, f"{width}x{height}: {drawn_width} pixels in {shown_width}")
        browser.look(page, looks, f"{looks_as}-{width}")
    page.size(1200, 1000)


@contextlib.contextmanager
def served(*inputs):
    with subprocess.Popen([TRIM3R, "view", *inputs, "--json"], stdout=subprocess.PIPE, text=True) as server:
        try:
            yield json.loads(server.stdout.readline())["address"]
        finally:
            server.terminate()


def in_threads(page, room):
    """A served page may have threads; their bits are the native ones."""
    with served(room, "--context", "0,2") as address:
        opened(page, address)
        check(page.value("crossOriginIsolated"), "a served page is isolated")
        check(page.value("Number(document.body.dataset.threads) === Math.min(navigator.hardwareConcurrency, 8)"), "as many threads as processors")
        page.wait("document.getElementById('bits').dataset.same !== undefined && isStill()")
        check(page.value("document.getElementById('bits').dataset.same") == "true", "the same bits in threads")


def narrower_than_the_recording(page, folder):
    """A recording of another shape than the window and wider than it: its scores are there all the same."""
    wide, scene = f"{folder}/wide.mcap", f"{folder}/wide.ply"
    run(TRIM3R, "room", "--size", "480x480", "-o", wide)
    run(TRIM3R, "build", wide, "--context", "0,2", "--keep", "1", "--refine", "0", "-o", scene)
    run(TRIM3R, "view", scene, wide, "--context", "0,2", "--refine", "0", "-o", f"{folder}/wide.html")
    page.size(390, 844, True)
    opened(page, f"{folder}/wide.html")
    page.wait("isStill()")
    check("dB" in page.value(STATUS), f"on a phone: {page.value(STATUS)}")
    browser.look(page, looks, "view-390")
    fits(page, "view")


def set_slider(page, label, value):
    page.value(f"""(() => {{ const s = document.querySelector('#crop input[aria-label="{label}"]');
        s.value = {value}; s.dispatchEvent(new Event('input')); }})()""")


def rows_of(path):
    """Returns the rows of a .ply of floats, by name."""
    with open(path, "rb") as file:
        head, body = file.read().split(b"end_header\n", 1)
    names = re.findall(r"property float (\w+)", head.decode())
    count = int(re.search(r"element vertex (\d+)", head.decode())[1])
    check(len(body) == count * len(names) * 4, f"{path}: {count} rows")
    return [dict(zip(names, row)) for row in struct.iter_unpack(f"<{len(names)}f", body)]


def save(page, folder):
    """Returns the rows of the file that the page saves."""
    page.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=folder)
    page.click("#save")
    page.wait("document.getElementById('remark').textContent.includes('-kept.ply')")
    saved = os.path.join(folder, page.value("document.getElementById('remark').textContent").split(":")[0])
    until = time.monotonic() + 30
    while not os.path.exists(saved) and time.monotonic() < until:
        time.sleep(0.05)
    return rows_of(saved)


def same_rows(rows, wanted, names):
    for row, want in zip(rows, wanted, strict=True):
        worst = max(abs(row[name] - want[name]) for name in names)
        check(worst < 2e-3, f"a row that is {worst} off")


def crops(page, scene, folder):
    """A box and a least opacity leave out the same Gaussians in the picture, in the count and in the file that is
    saved."""
    whole = drawn(page, lambda: page.value("draw()"))
    page.value("document.getElementById('crop').open = true")
    page.wait("crop.table !== null && isStill()")
    cropped = drawn(page, lambda: set_slider(page, "x, to", 500))
    least = 0.5
    set_slider(page, "Least opacity", round(100 * least))
    page.wait("isStill()")
    browser.look(page, looks, "view-crop")
    limit = page.value("endsOf(0)[1]")
    rows = rows_of(scene)
    wanted = [row for row in rows if row["x"] <= limit + 1e-6 and 1 / (1 + math.exp(-row["opacity"])) >= least - 1e-5]
    check(cropped != whole and 0 < len(wanted) < len(rows) / 2, f"{len(wanted)} of {len(rows)} are left")
    left = page.value("document.getElementById('kept').textContent")
    check(left == f"{len(wanted):,} of {len(rows):,} Gaussians are left.", f"{left} {len(wanted)} are wanted")
    same_rows(save(page, folder), wanted, ("x", "y", "z", "f_dc_0", "opacity", "scale_0"))
    command = shlex.split(page.value("document.getElementById('crop-command').textContent"))
    os.chdir(folder)
    run(TRIM3R, *command[1:], "--force")
    check(rows_of("scene-kept.ply") == wanted, f"the same by {command}")
    set_slider(page, "x, from", 600)  # beyond the other end
    page.wait("document.body.dataset.kept === '0' && isStill()")
    check(page.value("document.getElementById('save').disabled"), "nothing is left to save")
    page.click("#uncrop")
    page.wait("isStill()")
    check(page.value(PICTURE) == whole and page.value("document.getElementById('kept').textContent").startswith("All "), "and all of it again")


def choose(page, path):
    """Opens a file as the button does."""
    root = page.call("DOM.getDocument")["root"]["nodeId"]
    node = page.call("DOM.querySelector", nodeId=root, selector="#open")["nodeId"]
    page.call("DOM.setFileInputFiles", nodeId=node, files=[path])


def opens(page, scene, folder):
    """Files of other programs are read by the program's own readers; others are refused with the command that converts
    them."""
    native = json.loads(run(TRIM3R, "view", scene, "-o", f"{folder}/native.html", "--json").stdout)
    packed, splat, spz, glb, sog = (f"{folder}/{name}" for name in ("packed.compressed.ply", "s.splat", "s.spz", "s.glb", "s.sog"))
    for path in (packed, splat, spz, glb, sog):
        run(TRIM3R, "convert", scene, "-o", path)
    with open(glb, "rb") as file:
        text = file.read()
    with open(f"{folder}/odd.glb", "wb") as file:
        file.write(text.replace(b'"meshes":[', b'"meshes":{', 1))
    with open(f"{folder}/none.glb", "wb") as file:
        file.write(text.replace(b"KHR_gaussian_splatting", b"KHR_gaussian_splattin_"))
    with open(f"{folder}/old.spz", "wb") as file:
        file.write(gzip.compress(old_spz(50)))
    with open(f"{folder}/cut.ply", "wb") as out, open(scene, "rb") as whole:
        out.write(whole.read()[:-5])
    with open(f"{folder}/bomb.spz", "wb") as file:
        file.write(gzip.compress(bytes(160 << 20)))
    gaussians = native["gaussians"]
    for path, wanted in ((scene, gaussians), (packed, gaussians), (splat, gaussians), (spz, gaussians), (glb, gaussians),
                         (sog, gaussians), (f"{folder}/old.spz", 50)):
        choose(page, path)
        name = os.path.basename(path)
        page.wait(f"document.title.startsWith({json.dumps(name)}) && document.body.dataset.gaussians === '{wanted}' && isStill()")
    with open(spz, "rb") as file:
        whole = bytearray(file.read())
    for name, change in (("torn.spz", whole[:-1]), ("lost.spz", whole[:16] + struct.pack("<I", 1 << 30) + whole[20:]), ("broken.spz", whole[:112] + bytes(4) + whole[116:]),
                         ("vast.spz", whole[:40] + struct.pack("<Q", 1 << 40) + whole[48:])):
        with open(f"{folder}/{name}", "wb") as file:
            file.write(change)
    for path, words in ((f"{folder}/torn.spz", "cut off in stream 4"), (f"{folder}/lost.spz", "their table at byte 1073741824"),
                        (f"{folder}/broken.spz", "invalid zstd data"), (f"{folder}/vast.spz", "unpacks to more than"),
                        *bad_archives(sog, folder), (f"{folder}/odd.glb", "not JSON"),
                        (f"{folder}/none.glb", "no primitive with"),
                        (f"{folder}/cut.ply", "byte "),
                        (f"{folder}/bomb.spz", "unpacks to more than")):
        choose(page, path)
        page.wait(f"document.getElementById('status').textContent.includes({json.dumps(words)})")
        page.wait("document.getElementById('status').classList.contains('bad')")
    with open(scene, "rb") as file:
        dropped = base64.b64encode(file.read()).decode()
    page.value(f"""(() => {{ const d = new DataTransfer(), b = Uint8Array.from(atob('{dropped}'), (c) => c.charCodeAt(0));
        d.items.add(new File([b], 'dropped.ply')); document.dispatchEvent(new DragEvent('drop', {{ dataTransfer: d, bubbles: true }})); }})()""")
    page.wait(f"document.title.startsWith('dropped') && document.body.dataset.gaussians === '{gaussians}' && isStill()")
    dropped = page.value(PICTURE)
    opened(page, f"{folder}/native.html")
    page.wait("isStill()")
    check(page.value(PICTURE) == dropped, "a scene that is dropped is seen as the native program shows it")
    faint_archive(page, folder)


def type_frames(page, context, compared):
    """Builds the recording's scene from other frames."""
    for field, text in (("context", context), ("compared", compared)):
        page.value(f"document.getElementById('{field}').value = {json.dumps(text)}")
    page.click("#rebuild")


def as_natively(page, path, context, target, *settings):
    """Checks that the page built what the program does, from these frames, and scores it likewise."""
    page.wait(f"document.title.startsWith({json.dumps(os.path.basename(path))}) && document.body.dataset.hash && isStill() && {STATUS}.includes('dB')")
    gaussians = page.value("document.body.dataset.gaussians")
    native = json.loads(run(TRIM3R, "replay", path, "--context", context, "--gaussians", gaussians, *settings, "--json").stdout)["stages"]
    stages = page.value(STAGES)
    check(len(stages) > 2 and all(native[stage] == digits for stage, digits in stages.items()), f"{path}, {context}: {stages}, natively {native}")
    shown = float(re.search(rf"frame\s{target}\s([0-9.]+)\sdB", page.value(STATUS))[1])
    row = json.loads(run(TRIM3R, "eval", path, "--context", context, "--target", target, "--gaussians", gaussians, *settings, "--json").stdout)["rows"][0]
    check(abs(shown - row["psnr_all"]) <= 0.005, f"{path}: {shown} dB in the page, {row['psnr_all']} dB by eval")
    return page.value(PICTURE)


def opens_recordings(page, folder):
    """A recording that is opened is built as the program builds it: from frames that are chosen, then from others."""
    room = f"{folder}/walk.mcap"
    run(TRIM3R, "room", "--size", "64x48", "-o", room)
    opened(page, f"{folder}/page.html")
    choose(page, room)
    chosen = json.loads(run(TRIM3R, "build", room, "--context", "auto", "--keep", "10", "-o", f"{folder}/auto.ply", "--json").stdout)
    frames = [str(frame) for frame in chosen["context"]]
    middle = (chosen["context"][0] + chosen["context"][1]) // 2
    first = as_natively(page, room, ",".join(frames), middle)
    check(page.value("document.body.dataset.gaussians") == str(chosen["gaussians"]), "a tenth of the points")
    check(page.value("data.frames.map((frame) => frame.name.slice(6)).join()") == ",".join([*frames, str(middle)]), "the frames to look from")
    check(page.value("document.getElementById('context').value") == ",".join(frames), "the frames that were chosen are named")
    type_frames(page, "0, 2", "1,4")
    page.wait("data.views === 2")
    second = as_natively(page, room, "0,2", 4)
    check(second != first and page.value("data.frames.length") == 4, "another scene, and two frames to compare with")
    before = page.value("document.body.dataset.hash")
    slide(page, page.value("sliderAt(2)"))
    page.wait(f"document.body.dataset.hash !== {json.dumps(before)} && isStill()")
    as_natively(page, room, "0,2", 1)
    pictures = {drawn(page, lambda: page.value(f"document.querySelector('input[name=show][value={show}]').click()"))
                for show in ("frame", "error", "mask", "clusters", "texture", "picture")}
    check(len(pictures) == 6, f"{len(pictures)} pictures of a frame")
    browser.look(page, looks, "view-recording")
    on_a_phone(page)
    for compression in ("zstd", "lz4"):
        packed = f"{folder}/{compression}.mcap"
        run(TRIM3R, "room", "--size", "64x48", "--compression", compression, "-o", packed)
        choose(page, packed)
        check(as_natively(page, packed, ",".join(frames), middle) == first, f"the same of {compression}")
    for context, compared, words in (("0;2", "", '"0;2" is no list of frames'), ("0,9", "", "there is no frame 9: the recording holds 6"),
                                     ("0,2,0", "", "frame 0 is named twice"), (",".join(map(str, range(17))), "", "at most 16 frames"),
                                     ("0", "1," * 31 + "1", "at most 32 frames")):
        type_frames(page, context, compared)
        refused(page, words)
    large = f"{folder}/large.mcap"
    run(TRIM3R, "room", "--size", "1500x1000", "--frames", "4", "-o", large, "--force")
    choose(page, large)
    page.wait(f"{REMARK}.includes('750x500')")
    frames = page.value("data.frames.map((frame) => Number(frame.name.slice(6)))")
    views = page.value("data.views")
    as_natively(page, large, ",".join(map(str, frames[:views])), frames[views], "--working", "750x500")
    choose(page, f"{folder}/scene.ply")
    page.wait("document.title.startsWith('scene') && isStill()")
    check(page.value("document.getElementById('recording').hidden"), "a scene has no frames to choose")
    bad_recordings(page, room, folder)


def refused(page, words):
    page.wait(f"{STATUS}.includes({json.dumps(words)})")
    page.wait("document.getElementById('status').classList.contains('bad')")


def bad_recordings(page, room, folder):
    """Damaged recordings, and those that a page cannot show, are refused with the command that shows them."""
    with open(room, "rb") as file:
        whole = file.read()
    packed = {}
    for compression in ("zstd", "lz4"):
        with open(f"{folder}/{compression}.mcap", "rb") as file:
            packed[compression] = file.read()
    cases = [("none.mcap", b"?" * 100, "none.mcap: "), ("empty.mcap", whole[:40], "empty.mcap: ")]
    for compression, data in packed.items():
        at = data.index(compression.encode()) - 4  # the chunk's compression, after its size unpacked and its CRC
        first = at + 4 + len(compression) + 8
        cases += [(f"vast_{compression}.mcap", data[:at - 12] + struct.pack("<Q", 1 << 40) + data[at - 4:], "byte "),
                  (f"short_{compression}.mcap", data[:at - 12] + struct.pack("<Q", 100) + data[at - 4:], "longer than its uncompressed_size"),
                  (f"torn_{compression}.mcap", data[:first] + bytes(1000) + data[first + 1000:], "byte ")]
    for name, data, words in cases:
        with open(f"{folder}/{name}", "wb") as file:
            file.write(data)
        choose(page, f"{folder}/{name}")
        refused(page, words)
        refused(page, f"trim3r view {name}")
    with open(f"{folder}/huge.mcap", "wb") as file:
        file.truncate((1 << 30) + 1)
    choose(page, f"{folder}/huge.mcap")
    refused(page, "more than a page reads")
    os.remove(f"{folder}/huge.mcap")
    choose(page, f"{folder}/bent.mcap")
    refused(page, "its frames have no depth")
    with open(f"{folder}/jpeg.mcap", "wb") as file:
        file.write(bag_of_jpeg())
    choose(page, f"{folder}/jpeg.mcap")
    refused(page, "trim3r import jpeg.mcap")
    with open(f"{folder}/cut.mcap", "wb") as file:
        file.write(whole[:len(whole) * 3 // 4])
    choose(page, f"{folder}/cut.mcap")
    page.wait(f"document.title.startsWith('cut') && isStill() && {STATUS}.includes('dB')")
    check("cut off" in page.value(REMARK), f"a cut: {page.value(REMARK)}")


def bag_of_jpeg():
    """Returns a bag whose colour is in JPEG, which import decodes."""
    names = ("image/compressed", "depth", "camera_info", "pose")
    kinds = ("sensor_msgs/msg/CompressedImage", *(formats.TYPES[name] for name in names[1:]))
    records = [formats.channel(i + 1, f"/camera/{name}", kind) for i, (name, kind) in enumerate(zip(names, kinds))]
    for i in range(3):
        stamp = i * 33 * 10**6 + 10**9
        messages = (formats.compressed(stamp, "jpeg", formats.jpeg(16)), formats.image(stamp, encoding="16UC1", data=struct.pack("<H", 1500) * 256),
                    formats.camera_info(stamp), formats.pose(stamp, (0.01 * i, 0, 0)))
        records += [formats.message(channel + 1, stamp, data) for channel, data in enumerate(messages)]
    return formats.mcap(*records)


def bad_archives(path, folder):
    """Writes damaged copies of a .sog; returns their paths and words of their refusals."""
    with open(path, "rb") as file:
        whole = file.read()
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    picture = members["sh0.webp"]
    at, entry = whole.index(picture), whole.index(b"PK\1\2")
    without = {name: member for name, member in members.items() if name != "sh0.webp"}
    cases = [("none.sog", b"?", "no zip archive"), ("cut.sog", whole[:-30], "no zip archive"),
             ("changed.sog", whole[:at + 40] + bytes([whole[at + 40] ^ 1]) + whole[at + 41:], "sh0.webp: it cannot be read"),
             ("long.sog", whole[:entry + 24] + struct.pack("<I", 1 << 30) + whole[entry + 28:], "unpacks to more than"),
             ("lost.sog", zipped(without), "sh0.webp: the archive does not hold it"),
             ("vast.sog", zipped({**members, "sh0.webp": picture[:21] + b"\xff\xff\xff\x1f" + picture[25:]}), "unpacks to more than"),
             ("no_picture.sog", zipped({**members, "sh0.webp": b"RIFF"}), "sh0.webp: no lossless WebP"),
             ("bomb.sog", zipped({**members, "more": bytes(160 << 20)}), "unpacks to more than")]
    for name, data, _ in cases:
        with open(f"{folder}/{name}", "wb") as file:
            file.write(data)
    return [(f"{folder}/{name}", words) for name, _, words in cases]


def zipped(members):
    """Returns an archive of deflated members."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, member in members.items():
            archive.writestr(name, member)
    return out.getvalue()


def faint_archive(page, folder):
    """A .sog of nearly transparent Gaussians, whose members are deflated, has the native program's picture: no colour was
    scaled by opacity."""
    names = "x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3".split()
    rows = [[x / 4, y / 4, 2, x / 3, y / 5, -.3, -x - 1, -1.5, -1.6, -1.7, 1, .1 * x, .1 * y, 0] for x in range(5) for y in range(-4, 4)]
    scene, sog = f"{folder}/faint.ply", f"{folder}/faint.sog"
    with open(scene, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n".encode())
        file.write("".join(f"property float {name}\n" for name in names).encode() + b"end_header\n")
        file.write(b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows))
    run(TRIM3R, "convert", scene, "-o", sog)
    with zipfile.ZipFile(sog) as archive:
        packed = zipped({name: archive.read(name) for name in archive.namelist()})
    with open(sog, "wb") as file:
        file.write(packed)
    choose(page, sog)
    page.wait(f"document.title.startsWith('faint') && document.body.dataset.gaussians === '{len(rows)}' && isStill()")
    chosen = page.value(PICTURE)
    run(TRIM3R, "view", sog, "-o", f"{folder}/faint.html")
    opened(page, f"{folder}/faint.html")
    page.wait("isStill()")
    check(page.value(PICTURE) == chosen, "a .sog is seen as the native program shows it")


def old_spz(count):
    """Returns an .spz of version 2: points on a grid, all equal but for their places."""
    places = b"".join(struct.pack("<i", round((i % 5 if axis == 0 else i // 5) * 1000))[:3] for i in range(count) for axis in range(3))
    return (struct.pack("<4sIIBBBB", b"NGSP", 2, count, 0, 12, 0, 0) + places + bytes([200] * count) + bytes([128] * 3 * count)
            + bytes([100] * 3 * count) + bytes([128] * 3 * count))


def on_a_phone(page):
    check(browser.on_a_phone(page) == [], f"on a phone: {browser.on_a_phone(page)}")
    check(page.value("document.getElementById('picture').clientWidth") > 300, "the picture is as wide")
    browser.look(page, looks, "view-phone")
    page.size(1200, 1000)


def harmonics(page, room, folder):
    """A scene whose colours depend on the viewpoint, or one of mip-splatting, also with thin Gaussians that this makes
    fainter, is drawn as by `trim3r render` and scored as by eval."""
    names = "x y z f_dc_0 f_dc_1 f_dc_2".split() + [f"f_rest_{i}" for i in range(9)]
    names += "opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3".split()
    rest = [0, 1.5, 0, 0, -1.2, 0, .9, 0, 0]  # red and blue change from left to right
    scene, mip, hashes = f"{folder}/harmonics.ply", "comment SplatRenderMode: mip\n", set()
    for mark, width in (("", -1.8), (mip, -1.8), ("", -5), (mip, -5)):
        rows = [[x / 4, y / 4, 2, .2, .1, -.3, *rest, 3, *[width] * 3, 1, 0, 0, 0] for x in range(-4, 5) for y in range(-3, 4)]
        with open(scene, "wb") as file:
            file.write(f"ply\nformat binary_little_endian 1.0\n{mark}element vertex {len(rows)}\n".encode())
            file.write("".join(f"property float {name}\n" for name in names).encode() + b"end_header\n")
            file.write(b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows))
        run(TRIM3R, "view", scene, room, "--context", "0,2", "-o", f"{folder}/harmonics.html")
        opened(page, f"{folder}/harmonics.html")
        page.wait("isStill()")
        shown = float(re.search(r"frame\s1\s([0-9.]+)\sdB", page.value(STATUS))[1])
        row = json.loads(run(TRIM3R, "eval", room, "--context", "0,2", "--target", "1", "--scene", scene, "--json").stdout)["rows"][0]
        check(abs(shown - row["psnr_all"]) <= 0.005, f"harmonics {mark!r}: {shown} dB in the page, {row['psnr_all']} dB by eval")
        at_width(page, 320)
        native = json.loads(run(TRIM3R, "render", scene, room, "--view", "0", "--size", "320x240", "--json", "-o", f"{room}.png").stdout)["hash"]
        told = page.value("document.getElementById('drawn').textContent")
        check(told.endswith(f"hash {native}."), f"harmonics {mark!r}, {width}: {told}, natively {native}")
        hashes.add(native)
    check(len(hashes) == 4, "mip-splatting is another picture")
    same_rows(save(page, folder), rows_of(scene), names)


def beyond_the_lens(page, folder):
    """What a lens with distortion leaves black counts in no score: the page has that of eval."""
    room, bent, pictures = f"{folder}/large.mcap", f"{folder}/bent", f"{folder}/pictures"
    run(TRIM3R, "room", "--size", "192x144", "-o", room)
    run(TRIM3R, "eval", room, "--context", "0,2", "--target", "1", "--keep", "10", "--images", pictures)
    run(TRIM3R, "view", room, "--context", "0,2", "-o", f"{folder}/large.html")
    with open(f"{folder}/large.html", encoding="utf-8") as file:
        views = json.loads(re.search(r'id="data">(.*?)</script>', file.read())[1])["frames"]
    os.makedirs(bent)
    frames = []
    for view, name in zip(views, ("context_a", "context_b", "target"), strict=True):
        os.rename(f"{pictures}/1/{name}.png", f"{bent}/{name}.png")
        w, x, y, z = view["rotation"]
        axes = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
        pose = [[row[0], -row[1], -row[2], place] for row, place in zip(axes, view["position"])] + [[0, 0, 0, 1]]
        frames.append({"file_path": f"{name}.png", "transform_matrix": pose})
    lens = {"fl_x": views[0]["focal"][0], "cx": views[0]["centre"][0] + .5, "cy": views[0]["centre"][1] + .5, "k1": .1}
    with open(f"{bent}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"frames": frames, **lens}, file)
    run(TRIM3R, "import", bent, "-o", f"{bent}.mcap")
    settings = ("--context", "0,1", "--depth", "stereo", "--keep", "10")
    run(TRIM3R, "view", f"{bent}.mcap", *settings, "--compare", "2", "-o", f"{bent}.html")
    opened(page, f"{bent}.html")
    page.wait(f"document.getElementById('bits').dataset.same === 'true' && isStill() && {STATUS}.includes('dB')")
    shown = float(re.search(r"frame\s2\s([0-9.]+)\sdB", page.value(STATUS))[1])
    row = json.loads(run(TRIM3R, "eval", f"{bent}.mcap", *settings, "--target", "2", "--json").stdout)["rows"][0]
    check(abs(shown - row["psnr_all"]) <= 0.005, f"a lens: {shown} dB in the page, {row['psnr_all']} dB by eval")


with tempfile.TemporaryDirectory() as scratch:
    recording, scene = need_page(TRIM3R, scratch)
    run(TRIM3R, "view", recording, "--context", "0,2", "-o", f"{scratch}/both.html")
    page = browser.Page(program, timeout=120)
    try:
        opened(page, f"{scratch}/both.html")
        page.wait("document.getElementById('bits').dataset.same !== undefined && isStill()")
        check(page.value("document.getElementById('bits').dataset.same") == "true", "the page has the native hash")
        accessible(page)
        shows(page)
        motion(page)
        touch(page)
        keys_are_listed(page)
        along_the_recording(page)
        budget(page, recording)
        on_a_phone(page)
        opened(page, f"{scratch}/page.html")
        check(page.value("document.getElementById('budget').hidden"), "a scene alone has no budget to choose")
        check("Gaussians" in page.value(STATUS), f"it is drawn: {page.value(STATUS)}")
        check(page.value("document.body.dataset.threads") == "1", "a page in a file has one thread")
        browser.look(page, looks, "view-scene")
        crops(page, scene, scratch)
        run(TRIM3R, "view", scene, recording, "--context", "0,2", "-o", f"{scratch}/pair.html")
        opened(page, f"{scratch}/pair.html")
        of_file = page.value("document.body.dataset.gaussians")
        page.click("input[name=source][value=built]")
        page.wait("document.body.dataset.hash !== ''")
        page.click("input[name=source][value=file]")
        page.wait("document.body.dataset.hash === ''")
        check(page.value("document.body.dataset.gaussians") == of_file, "from the file, built here, and back")
        same_pictures(page, scene, recording)
        at_width(page, 64)
        sketched(page)
        harmonics(page, recording, scratch)
        beyond_the_lens(page, scratch)
        narrower_than_the_recording(page, scratch)
        opens(page, scene, scratch)
        opens_recordings(page, scratch)
        check(all(url.startswith(("file:", "blob:", "data:")) for url in page.requested), f"requests: {page.requested}")
        in_threads(page, recording)
        check(page.logged == [], f"nothing on the console: {page.logged}")
    finally:
        page.close()
done()
