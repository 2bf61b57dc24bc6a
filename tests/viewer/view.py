#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""view.py TRIM3R: the page as a file and over loopback, and what is refused."""
import http.client
import json
import re
import socket
import subprocess
import sys
import tempfile
import time

from checks import check, done, run
from common import need_page

TRIM3R = sys.argv[1]


def page_of_a_file(room, scene, folder):
    page = f"{folder}/view.html"
    told = json.loads(run(TRIM3R, "view", room, "--context", "0,2", "--keep", "5", "-o", page, "--json").stdout)
    built = json.loads(run(TRIM3R, "build", room, "--context", "0,2", "--keep", "5", "-o", scene, "--json").stdout)
    check(told["hash"] == built["hash"], "the page is told the hash of the same build")
    check(told["gaussians"] == built["gaussians"] and told["viewpoints"] == 3, f"two views and the frame between: {told}")
    with open(page, encoding="utf-8") as file:
        text = file.read()
    check(len(text.encode()) == told["bytes"], "its bytes")
    check(text.startswith("<!DOCTYPE html>") and "<!--" not in text, "every mark is replaced")
    check(not re.search(r'(src|href)="(?!data:)', text) and "http://" not in text and "https://" not in text,
          "the page names nothing to fetch")
    again = f"{folder}/again.html"
    run(TRIM3R, "view", room, "--context", "0,2", "--keep", "5", "-o", again)
    with open(again, encoding="utf-8") as file:
        check(file.read() == text, "the same page again")
    many = json.loads(run(TRIM3R, "view", scene, room, "--compare", "1,3,4", "-o", page, "--force", "--json").stdout)
    check(many["viewpoints"] == 5 and "hash" not in many, f"frames to compare with: {many}")


def refused(room, scene, folder):
    for expect, words, *line in (
            (2, "REC.mcap or SCENE.ply is missing"),
            (2, "are both recordings", room, room),
            (2, "are both scenes", scene, scene),
            (2, "--compare needs a recording", scene, "--compare", "1"),
            (2, "own allocations", room, "--allocate", "given", "--importance", folder),
            (1, "frame 99", room, "--compare", "99", "-o", f"{folder}/no.html"),
            (1, "nowhere.mcap", f"{folder}/nowhere.mcap", "-o", f"{folder}/no.html")):
        ended = run(TRIM3R, "view", *line, expect=expect)
        check(words in ended.stderr, f"{line}: {ended.stderr}")


def ask(port, method="GET", path="/", host=None):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=30)
    connection.putrequest(method, path, skip_host=True)
    connection.putheader("Host", host or f"127.0.0.1:{port}")
    connection.endheaders()
    answer = connection.getresponse()
    return answer.status, answer.getheader("Content-Type"), answer.read()


def served(scene):
    with subprocess.Popen([TRIM3R, "view", scene, "--json"], stdout=subprocess.PIPE, text=True) as server:
        try:
            told = json.loads(server.stdout.readline())
            port = int(re.fullmatch(r"http://127\.0\.0\.1:(\d+)/", told["address"])[1])
            status, kind, body = ask(port)
            check(status == 200 and kind.startswith("text/html") and len(body) == told["bytes"], f"the page: {status}")
            check(ask(port, "HEAD")[0] == 200 and ask(port, host=f"localhost:{port}")[0] == 200, "HEAD, and localhost")
            check(ask(port, host="elsewhere.example")[0] == 403, "a page of another site is refused")
            idle = [socket.create_connection(("127.0.0.1", port)) for _ in range(3)]
            begun = time.monotonic()
            check(ask(port)[0] == 200 and time.monotonic() - begun < 2, "clients that ask nothing delay none")
            for each in idle:
                each.close()
            deaf = [socket.create_connection(("127.0.0.1", port)) for _ in range(3)]
            for each in deaf:
                each.sendall(f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
            begun = time.monotonic()
            check(ask(port)[0] == 200 and time.monotonic() - begun < 2, "clients that read no answer delay none")
            for each in deaf:
                each.close()
            slow = socket.create_connection(("127.0.0.1", port))
            slow.settimeout(30)
            begun = time.monotonic()
            try:
                while True:  # a byte now and then, and never a whole request
                    slow.sendall(b"G")
                    time.sleep(0.5)
            except OSError:
                check(4 < time.monotonic() - begun < 8, f"a slow client has 5 s: {time.monotonic() - begun:.1f}")
            check(ask(port, path="/other")[0] == 404 and ask(port, "POST")[0] == 405, "there is one page, to be read")
            taken = run(TRIM3R, "view", scene, "--port", str(port), expect=1)
            check(f"127.0.0.1:{port}: " in taken.stderr, f"a port that is taken: {taken.stderr}")
        finally:
            server.terminate()
            server.wait(30)


def served_at_port_80(scene):
    """Browsers leave out HTTP's own port."""
    with subprocess.Popen([TRIM3R, "view", scene, "--json", "--port", "80"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True) as server:
        if server.stdout.readline() == "":
            check("127.0.0.1:80: " in server.stderr.read(), "the system refuses the port: no reason")
            print("SKIPPED, port 80 is not ours here")
            return
        try:
            for host, status in (("127.0.0.1", 200), ("localhost", 200), ("127.0.0.1:8080", 403)):
                check(ask(80, host=host)[0] == status, f"{host} at port 80")
        finally:
            server.terminate()
            server.wait(30)


with tempfile.TemporaryDirectory() as scratch:
    recording, made = need_page(TRIM3R, scratch)
    page_of_a_file(recording, made, scratch)
    refused(recording, made, scratch)
    served(made)
    served_at_port_80(made)
done()
