#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""speed.py TRIM3R SPEED: the README's picture of speed against accuracy, for tiny rooms: it names every method and
head."""
import os
import sys
import tempfile
import xml.etree.ElementTree

from checks import check, done, run

trim3r, speed = map(os.path.abspath, sys.argv[1:3])
NAMES = ("trim3r", "random", "eagles", "lightgaussian", "pup", "efficientgs", "efficientgs+finetune", "random+finetune", "analytic", "tiny")

with tempfile.TemporaryDirectory() as folder:
    run(speed, "picture", "--program", trim3r, "--size", "32x32", "--runs", "1", "--iterations", "3,5", "--svg", f"{folder}/speed.svg", "--cache", f"{folder}/cache")
    texts = ["".join(e.itertext()) for e in xml.etree.ElementTree.parse(f"{folder}/speed.svg").iter() if "text" in e.tag]
    print(texts)
    for name in NAMES:
        check(any(name in text.split() for text in texts), f"{name} is named: {texts}")
    check(sorted(os.listdir(folder)) == ["cache", "speed.svg"], "nothing else is left")
done()
