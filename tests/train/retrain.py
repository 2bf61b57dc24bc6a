#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The smallest run of tools/study/train/retrain: heads come with their training's settings, an interrupted run
continues, existing results are kept.

retrain.py TRAIN_FOLDER BUILD_FOLDER TRIM3R"""
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

TRAIN, BUILD, TRIM3R = map(os.path.abspath, sys.argv[1:4])
os.environ["TRIM3R_BUILD"] = BUILD
sys.dont_write_bytecode = True
sys.path.insert(0, TRAIN)
import needs  # noqa: E402, F401  (ends with 77 where torch is missing)

import cv2  # noqa: E402
import head_net  # noqa: E402
import numpy as np  # noqa: E402

HEADS = os.path.join(TRAIN, "..", "..", "..", "quant", "heads")


class Retrain(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.data = os.path.join(cls.folder.name, "pictures")
        os.mkdir(cls.data)
        picture = np.random.default_rng(1).integers(0, 255, (48, 48, 3), np.uint8)
        cv2.imwrite(os.path.join(cls.data, "a.png"), cv2.resize(picture, (192, 192)))
        cls.out = os.path.join(cls.folder.name, "heads")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_it(self, *arguments, expect=0):
        command = [sys.executable, "-B", os.path.join(TRAIN, "retrain"), *arguments, "--head", "tiny", "--crop", "64",
                   "--batch", "2", "--processes", "1", "--data", self.data, "--program", TRIM3R, "--out", self.out]
        found = subprocess.run(command, capture_output=True, text=True, timeout=600)
        self.assertEqual(found.returncode, expect, found.stderr)
        return found.stdout if expect == 0 else found.stderr

    def told(self, name):
        with open(os.path.join(self.out, name + ".json"), encoding="utf-8") as file:
            return json.load(file)

    def floats(self, name):
        (path,) = glob.glob(os.path.join(self.out, "runs", f"{name}-*", f"{name}.safetensors"))
        return head_net.load_safetensors(path)[0]

    def test_heads_and_how_they_were_trained(self):
        first = self.run_it("eagles", "rooms", "--steps", "4")
        self.assertRegex(first, r"2 heads to be trained, about \d+ min by 1 processes; 0 are there")
        self.assertRegex(first, r"eagles: step 4/4 .* left \(\d+ of all\)")
        eagles, rooms = self.told("eagles"), self.told("rooms")
        self.assertEqual([eagles[k] for k in ("mask", "kind", "start", "steps")], ["eagles", "all", "tiny", 4])
        self.assertEqual([rooms[k] for k in ("mask", "kind", "start", "data")], ["trim3r", "rooms", None, []])
        self.assertEqual(eagles["data"], ["pictures"])
        for name in ("eagles", "rooms"):
            answer = subprocess.run([TRIM3R, "head-info", os.path.join(self.out, name + ".t3w")], check=True,
                                    capture_output=True, text=True)  # fmt: skip
            self.assertIn(name, answer.stdout)
        shipped, _ = head_net.load_safetensors(os.path.join(HEADS, "tiny.safetensors"))
        made = self.floats("eagles")
        apart = [float((a - b).abs().max()) for a, b in zip(made.parameters(), shipped.parameters())]
        self.assertTrue(0 < max(apart) < 0.02, f"it goes on with the shipped head: {apart}")
        fresh = self.floats("rooms")
        self.assertGreater(max(float((a - b).abs().max()) for a, b in zip(fresh.parameters(), shipped.parameters())), 0.1)

        again = self.run_it("eagles", "rooms", "--steps", "4")
        self.assertIn("0 heads to be trained", again)
        os.remove(os.path.join(self.out, "eagles.t3w"))  # as if interrupted earlier: its steps are not repeated
        self.assertNotIn("step", self.run_it("eagles", "--steps", "4").replace("--steps", ""))
        with open(os.path.join(self.out, "eagles.t3w"), "r+b") as head:
            kept = head.read()
            head.seek(6)
            head.write(b"\0\0")  # of another bits epoch: quantized again
        self.assertNotIn("step", self.run_it("eagles", "--steps", "4").replace("--steps", ""))
        with open(os.path.join(self.out, "eagles.t3w"), "rb") as head:
            self.assertEqual(head.read(), kept)
        self.assertTrue(eagles["shipped"])
        copy = shutil.copy(os.path.join(HEADS, "tiny.safetensors"), self.folder.name)
        self.assertIn("1 heads to be trained", self.run_it("eagles", "--steps", "4", "--from", copy), "from elsewhere")
        self.assertFalse(self.told("eagles")["shipped"])
        self.assertIn("1 heads to be trained", self.run_it("eagles", "--steps", "5"))
        self.assertEqual(self.told("eagles")["steps"], 5)

    def test_what_is_refused(self):
        self.assertIn("no head is called speed", self.run_it("speed", expect=2))
        split = os.path.join(self.folder.name, "splits.json")
        with open(split, "w", encoding="utf-8") as file:
            json.dump({"train": [], "test": ["pictures"]}, file)
        try:
            self.assertIn("is kept for tests", self.run_it("eagles", expect=2))
        finally:
            os.remove(split)
        self.assertIn("posed views", self.run_it("recorded", "--steps", "4", expect=1))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
