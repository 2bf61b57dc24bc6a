#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A training run: repeatable, resumable, shared among processes, and rounded like integers; usage: training.py
TRAIN_FOLDER BUILD_FOLDER"""
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest

TRAIN, BUILD = sys.argv[1:3]
os.environ["TRIM3R_BUILD"] = BUILD
os.environ["OMP_NUM_THREADS"] = "1"
sys.path.insert(0, TRAIN)
import train  # noqa: E402  (ends with 77 where torch is missing)
import head_net  # noqa: E402
import numpy as np  # noqa: E402
import samples  # noqa: E402
import torch  # noqa: E402

STEPS = 6


def run_in(folder, *more):
    common = (
        "--head",
        "tiny",
        "--steps",
        str(STEPS),
        "--crop",
        "64",
        "--batch",
        "2",
        "--novel",
        "0.5",
        "--out",
        folder,
    )
    return train.Run(train.options_of([*common, *more]))


def same(a, b):
    return all(torch.equal(x, y) for x, y in zip(a.state_dict().values(), b.state_dict().values()))


class Gradients(Exception):
    """Raised in place of sharing, when a step's own gradients are ready."""


def step_as_two(one, two):
    """Makes a step of `one` with the mean of its gradients and `two`'s; `two` then equals `one`."""

    def stop():
        raise Gradients

    def share():
        for mine, other in zip(one.head.parameters(), two.head.parameters()):
            mine.grad.copy_((mine.grad + other.grad) / 2)
        for mine, other in zip(one.head.buffers(), two.head.buffers()):  # ranges
            mine.copy_(torch.maximum(mine, other))

    two._share_gradients, one._share_gradients = stop, share
    try:
        two.one_step()
    except Gradients:
        one.one_step()
    two.head.load_state_dict(one.head.state_dict())
    two.step = one.step


class Training(unittest.TestCase):
    def test_the_same_seed_gives_the_same_head_also_after_a_stop(self):
        with tempfile.TemporaryDirectory() as folder:
            one, two, three = (os.path.join(folder, name) for name in ("one", "two", "three"))
            whole = run_in(one)
            whole.train()
            first = run_in(two)
            for _ in range(STEPS // 2):
                first.one_step()
            first.save()
            second = run_in(two)
            self.assertEqual(second.step, STEPS // 2)
            second.train()
            self.assertTrue(same(whole.head, second.head))
            other = run_in(three, "--seed", "2")
            other.train()
            self.assertFalse(same(whole.head, other.head))
            for name in ("checkpoint.pt", "log.csv", "curves.png", "tiny.safetensors"):
                self.assertTrue(os.path.exists(os.path.join(one, name)), name)
            with self.assertRaises(SystemExit):
                run_in(one, "--seed", "2")  # another run's checkpoint lies there

    def test_processes_share_a_step(self):
        """Two processes give the bits of one that takes the mean of both shares' gradients."""
        options = "--head tiny --steps 4 --crop 64 --batch 2 --novel 0 --quantized 0".split()
        with tempfile.TemporaryDirectory() as folder:
            shared, *alone = (os.path.join(folder, name) for name in ("shared", "first", "second"))
            command = [sys.executable, os.path.join(TRAIN, "train.py"), *options, "--processes", "2", "--out", shared]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, timeout=300)
            got = torch.load(os.path.join(shared, "checkpoint.pt"))["head"]
            one, two = (train.Run(train.options_of([*options, "--batch", "1", "--out", out])) for out in alone)
            two.rank = 1
            while one.step < one.options.steps:
                step_as_two(one, two)
        expected, begun = one.head.state_dict(), head_net.Head(head_net.HEADS["tiny"], one.options.seed).state_dict()
        self.assertTrue(all(torch.equal(got[key], expected[key]) for key in expected))
        self.assertFalse(any(torch.equal(got[key], begun[key]) for key in expected if key.startswith("weight")))

    def test_a_saved_head_is_what_was_trained(self):
        head = head_net.Head(head_net.HEADS["small"], 3)
        for n in range(1, len(head.layers)):
            getattr(head, f"range{n}").fill_(2.5)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "small.safetensors")
            head_net.save_safetensors(head, path, "small")
            again, name = head_net.load_safetensors(path)
            with open(path, "rb") as file:
                (size,) = struct.unpack("<Q", file.read(8))
                graph = json.loads(json.loads(file.read(size))["__metadata__"]["trim3r"])
        self.assertEqual(name, "small")
        self.assertEqual(graph["layers"], head.layers)
        self.assertTrue(all(torch.equal(a, b) for a, b in zip(head.parameters(), again.parameters())))

    def test_shipped_sizes(self):
        for name, most, parameters in (("tiny", 400, 4e3), ("small", 5000, 48e3)):
            head = head_net.Head(head_net.HEADS[name])
            self.assertLessEqual(head_net.multiply_accumulates(head.layers), most, name)
            self.assertLess(sum(p.numel() for p in head.parameters()), parameters, name)

    def test_rounding_changes_little_and_lets_derivatives_through(self):
        head = head_net.Head(head_net.HEADS["tiny"], 5)
        drawn = samples.Samples([], 64, 1.0).crops(np.random.default_rng(1), 2)
        batch = train.objective.Batch(drawn, "cpu")
        head.mode = "observe"
        plain = head(batch.features, batch.index)
        head.mode = "quantized"
        rounded = head(batch.features, batch.index)
        noise = (rounded - plain).std() / (plain - plain.mean(0)).std()
        self.assertGreater(float(noise), 0)
        self.assertLess(float(noise), 0.1)
        rounded.square().sum().backward()
        self.assertTrue(all(float(p.grad.abs().sum()) > 0 for p in head.weight))

    def test_a_triplet_teaches(self):
        source = samples.Samples([], 96, 1.0)
        head = head_net.Head(head_net.HEADS["tiny"])
        for seed in range(8):
            context, target = source.triplet(np.random.default_rng(seed))
            loss, decibel = train.objective.novel_loss(head, context, target, train.perceptual.StandIn(), "cpu")
            if loss is not None:
                loss.backward()
                self.assertGreater(decibel, 12)  # drawn in the right place: noise would give 7
        self.assertTrue(all(torch.isfinite(p.grad).all() for p in head.parameters()))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
