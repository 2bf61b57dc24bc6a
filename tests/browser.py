# SPDX-License-Identifier: Apache-2.0
"""Drives a headless Chromium over the pipe of its DevTools protocol; needs no other package and no port."""
import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

NAMES = ("chromium", "chromium-browser", "google-chrome-stable", "google-chrome")
FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-dev-shm-usage", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-extensions",
         "--hide-scrollbars", "--remote-debugging-pipe")
WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist")  # rendered on the CPU


def find():
    """Returns the path of Chromium, or None."""
    return next((path for path in map(shutil.which, NAMES) if path), None)


def look(page, folder, name):
    """Saves a screenshot of the page in the folder; None: does nothing."""
    if folder:
        os.makedirs(folder, exist_ok=True)
        page.shot(os.path.join(folder, f"{name}.png"))


PHONE = (390, 844)
SMALLEST_TEXT, SMALLEST_TARGET = 12, 40  # CSS pixels
# Sizes of all visible texts and controls. An input counts as its label; the points of a chart accept taps nearby.
TEXTS = """(() => { const found = [], all = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (all.nextNode()) {
        const text = all.currentNode.textContent.trim(), it = all.currentNode.parentElement;
        if (!text || !it.checkVisibility() || it.closest("script, style, noscript")) continue;
        const scale = it.getScreenCTM ? it.getScreenCTM().a : 1, size = parseFloat(getComputedStyle(it).fontSize) * scale;
        found.push([size, text.slice(0, 40)]);
    } return found; })()"""
TARGETS = """[...document.querySelectorAll("a[href], button, select, summary, label, input")]
    .filter((it) => it.checkVisibility() && !(it.tagName === "INPUT" && it.labels.length)).map((it) => {
        const box = it.getBoundingClientRect(); return [Math.min(box.width, box.height), it.tagName + " " + it.textContent.trim()]; })"""


def on_a_phone(page):
    """Sets the size of a phone; returns what is too wide, too small to read or too small to touch, one per line."""
    page.size(*PHONE, mobile=True)
    page.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    wide, texts, targets = page.value("document.documentElement.scrollWidth"), page.value(TEXTS), page.value(TARGETS)
    found = [] if wide <= PHONE[0] else [f"the page is {wide} pixels wide"]
    found += [f"a text of {size:.1f} pixels: {text}" for size, text in texts if size < SMALLEST_TEXT]
    found += [f"a control of {side:.1f} pixels: {name}" for side, name in targets if side < SMALLEST_TARGET]
    return found if texts and targets else ["nothing to read or to touch"]


class Page:
    """A page; keeps its log lines, exceptions and network requests."""

    def __init__(self, program, width=1200, height=1000, timeout=60, webgl=False):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        commands, self.write = os.pipe()
        self.read, answers = os.pipe()

        def place():  # the protocol needs descriptors 3 and 4; 13 and 14 keep one dup2 from closing the other
            for target, source in ((13, commands), (14, answers)):
                os.dup2(source, target)
            os.dup2(13, 3)
            os.dup2(14, 4)

        self.browser = subprocess.Popen([program, *FLAGS, *(WEBGL if webgl else ()), f"--user-data-dir={self.profile.name}", "about:blank"],
                                        preexec_fn=place, close_fds=False, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(commands)
        os.close(answers)
        self.timeout, self.buffer, self.number, self.session = timeout, b"", 0, None
        self.logged, self.requested, self.events = [], [], []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.size(width, height)
        self.scheme("light")

    def _message(self, until):
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.read], [], [], max(0, until - time.monotonic()))
            if not ready:
                raise TimeoutError("the browser does not answer")
            part = os.read(self.read, 1 << 20)
            if not part:
                raise EOFError("the browser ended")
            self.buffer += part
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def _note(self, message):
        method, what = message["method"], message.get("params", {})
        self.events.append(method)
        if method == "Runtime.exceptionThrown":
            self.logged.append(what["exceptionDetails"].get("exception", {}).get("description", str(what)))
        elif method == "Runtime.consoleAPICalled" and what["type"] in ("error", "warning", "assert"):
            self.logged.append(str(what["args"]))
        elif method == "Log.entryAdded" and what["entry"]["level"] in ("error", "warning"):
            self.logged.append(what["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requested.append(what["request"]["url"][:100])

    def call(self, command, **parameters):
        self.number += 1
        message = {"id": self.number, "method": command, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + self.timeout
        while True:
            answer = self._message(until)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{command}: {answer['error']}")
                return answer["result"]
            if "method" in answer:
                self._note(answer)

    def size(self, width, height, mobile=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)

    def scheme(self, name):
        """Sets light or dark as the system's scheme, and turns off animated scrolling, so that clicks hit their
        target."""
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name},
                                                          {"name": "prefers-reduced-motion", "value": "reduce"}])

    def before_all(self, script):
        """Adds a script that runs in every page opened from now on, before the page's own scripts."""
        self.call("Page.addScriptToEvaluateOnNewDocument", source=script)

    def open(self, path):
        """Opens a file or an http address."""
        self.events.clear()
        self.call("Page.navigate", url=path if path.startswith("http://") else "file://" + os.path.abspath(path))
        until = time.monotonic() + self.timeout
        while "Page.loadEventFired" not in self.events:
            message = self._message(until)
            if "method" in message:
                self._note(message)

    def value(self, script):
        """Returns the value of a script's expression, awaited."""
        result = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{script}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait(self, script):
        until = time.monotonic() + self.timeout
        while not self.value(script):
            if time.monotonic() > until:
                raise TimeoutError(script)
            time.sleep(0.05)

    def place(self, selector):
        """Scrolls an element into view and returns its centre."""
        return self.value(f"""(() => {{ const it = document.querySelector({json.dumps(selector)});
            it.scrollIntoView({{ block: "center", behavior: "instant" }});
            const box = it.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; }})()""")

    def mouse(self, kind, place, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], **more)

    def hover(self, selector):
        self.mouse("mouseMoved", self.place(selector))

    def click(self, selector):
        place = self.place(selector)
        self.mouse("mouseMoved", place)
        self.mouse("mousePressed", place, button="left", clickCount=1)
        self.mouse("mouseReleased", place, button="left", clickCount=1)

    def key(self, name, code, text=""):
        for kind in ("keyDown", "keyUp"):
            more = {"text": text} if text and kind == "keyDown" else {}
            self.call("Input.dispatchKeyEvent", type=kind, key=name, code=name, windowsVirtualKeyCode=code, **more)

    def shot(self, path, whole=False):
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))

    def close(self):
        self.browser.terminate()
        try:
            self.browser.wait(10)
        except subprocess.TimeoutExpired:
            self.browser.kill()
            self.browser.wait()
        os.close(self.read)
        os.close(self.write)
        self.profile.cleanup()
