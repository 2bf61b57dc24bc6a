#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Train a Gaussian head.

    tools/study/train/train.py --head small --out build/small     made-up pictures alone
    tools/study/train/train.py --head small --out build/small --data DIR --data DIR2
    tools/study/train/train.py --processes 2 ...                                  shares every step; so does torchrun
    tools/study/train/train.py --start quant/heads/small.safetensors --mask eagles ...   goes on, for a rival's points
    tools/study/train/train.py --smoke --out build/smoke                          two minutes; fails unless the loss falls

A step draws pictures (samples.py), lets the runtime analyse, prune and prepare them with a budget drawn at random, asks
the head for footprints, draws these, refines them twice as the runtime does, and draws again. Triplets are lifted to
their surfaces and drawn in a third view as well. The loss of a picture is log(MSE + lambda x perceptual term): its mean
over pictures is minus the mean PSNR, but for the perceptual term (GaussianTrim3R eq. 3). The last share of the steps
runs with weights and activations rounded as `trim3r quantize` will round them.

OUT gets checkpoint.pt (the same command again continues), log.csv, curves.png and NAME.safetensors. The same command
and seed give the same head on the same machine with as many processes."""
import argparse
import csv
import math
import os
import socket
import subprocess
import sys
import time

import needs  # noqa: F401

import numpy as np
import torch
import torch.distributed as distributed

import curves
import head_net
import objective
import perceptual
import samples
import splatting

WARM_UP = 300  # steps until the highest learning rate
COLUMNS = ("step", "seconds", "psnr_plain", "psnr_refined", "psnr_novel", "loss", "rate", "phase")
SMOKE_STEPS, SMOKE_FACTOR = 200, 0.4  # the squared error must fall below this share of the untrained head's


def options_of(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--head", choices=sorted(head_net.HEADS), default="small", help="which network (small)")
    parser.add_argument("--out", required=True, metavar="DIR", help="checkpoint, log, curves and the head (needed)")
    parser.add_argument("--name", help="name in the weight file (default: the head's)")
    parser.add_argument(
        "--data", action="append", default=[], metavar="DIR", help="a folder of images or posed views; repeat"
    )
    parser.add_argument(
        "--made-up", type=float, default=0.6, metavar="SHARE", help="of pictures that are made up (0.6)"
    )
    parser.add_argument(
        "--kind", choices=samples.KINDS, default="all",
        help="one kind of scenes alone: those of --data (recorded), made-up rooms, or made-up pictures (all)",
    )  # fmt: skip
    parser.add_argument(
        "--mask", choices=samples.MASKS, default="trim3r", metavar="METHOD",
        help=f"whose choice of points the head is trained for: {', '.join(samples.MASKS)} (trim3r)",
    )  # fmt: skip
    parser.add_argument("--steps", type=int, default=12000, help="(12000)")
    parser.add_argument("--batch", type=int, default=4, help="pictures a step, over all processes (4)")
    parser.add_argument("--crop", type=int, default=128, help="side of a picture, pixels (128)")
    parser.add_argument("--novel", type=float, default=0.25, metavar="SHARE", help="of steps with a triplet (0.25)")
    parser.add_argument(
        "--quantized", type=float, default=0.15, metavar="SHARE", help="of steps with rounding, at the end (0.15)"
    )
    parser.add_argument("--rate", type=float, default=2e-3, help="highest learning rate (0.002)")
    parser.add_argument("--seed", type=int, default=1, help="(1)")
    parser.add_argument("--processes", type=int, default=1, help="that share every step on this machine (1)")
    parser.add_argument("--threads", type=int, default=1, help="of each process (1)")
    parser.add_argument(
        "--device", default="cpu", help="where the network runs (cpu); splats are drawn on the processor"
    )
    parser.add_argument("--start", metavar="FILE.safetensors", help="begin with this head, widened if it is narrower")
    parser.add_argument("--lpips", nargs=2, metavar=("TRUNK.pth", "HEADS.pth"), help="LPIPS instead of the stand-in")
    parser.add_argument(
        "--smoke", action="store_true", help=f"{SMOKE_STEPS} steps; exit status 1 unless the loss falls"
    )
    options = parser.parse_args(arguments)
    if (options.kind == "recorded") > bool(options.data) or options.kind in ("rooms", "pictures") and options.data:
        parser.error(f"--kind {options.kind} {'needs' if options.kind == 'recorded' else 'excludes'} --data")
    if options.kind == "pictures":
        options.novel = 0.0  # one view each
    if options.smoke:
        options.steps, options.crop, options.rate = SMOKE_STEPS, 96, 5e-3
    return options


def means(rows):
    """Returns each column's mean over the rows that have a number there."""
    columns = ([v for v in column if math.isfinite(v)] for column in zip(*rows))
    return [sum(c) / len(c) if c else math.nan for c in columns]


class Run:
    def __init__(self, options):
        self.options, self.step, self.rows, self.seconds = options, 0, [], 0.0
        self.rank, self.world = int(os.environ.get("RANK", 0)), int(os.environ.get("WORLD_SIZE", 1))
        torch.set_num_threads(options.threads)
        torch.manual_seed(options.seed)
        torch.use_deterministic_algorithms(options.device == "cpu")
        if self.world > 1:
            distributed.init_process_group("gloo")
        self.device = options.device
        if self.device == "cuda" and self.world > 1:
            self.device = f"cuda:{int(os.environ['LOCAL_RANK'])}"
        if options.start:
            self.head = head_net.widened(
                head_net.load_safetensors(options.start)[0], head_net.HEADS[options.head], options.seed
            )
        else:
            self.head = head_net.Head(head_net.HEADS[options.head], options.seed)
        self.head.to(self.device)
        self.optimizer = torch.optim.Adam(self.head.parameters(), lr=options.rate)
        self.term = perceptual.Lpips(*options.lpips) if options.lpips else perceptual.StandIn()
        self.samples = samples.Samples(
            options.data, options.crop, options.made_up, kind=options.kind, mask=options.mask
        )
        os.makedirs(options.out, exist_ok=True)
        self.checkpoint = os.path.join(options.out, "checkpoint.pt")
        if os.path.exists(self.checkpoint) and not options.smoke:
            self._resume()

    def _identity(self):
        o = self.options
        return [
            o.head,
            o.steps,
            o.batch,
            o.crop,
            o.seed,
            o.made_up,
            o.novel,
            o.quantized,
            o.rate,
            sorted(o.data),
            o.start,
            o.lpips,
            self.world,
            o.kind,
            o.mask,
        ]

    def _resume(self):
        state = torch.load(self.checkpoint, map_location="cpu")
        if state["identity"] != self._identity():
            sys.exit(f"train: {self.checkpoint} belongs to a run with other options; choose another --out")
        self.head.load_state_dict(state["head"])
        self.optimizer.load_state_dict(state["optimizer"])
        self.step, self.rows, self.seconds = state["step"], state["rows"], state["seconds"]

    def save(self):
        if self.rank == 0:
            state = {"identity": self._identity(), "head": self.head.state_dict(), "step": self.step, "rows": self.rows,
                     "optimizer": self.optimizer.state_dict(), "seconds": self.seconds}  # fmt: skip
            torch.save(state, self.checkpoint + ".new")
            os.replace(self.checkpoint + ".new", self.checkpoint)  # a run killed here keeps the previous checkpoint
            with open(os.path.join(self.options.out, "log.csv"), "w", newline="", encoding="utf-8") as file:
                csv.writer(file).writerows([COLUMNS, *self.rows])
            curves.draw_curves(self.rows, os.path.join(self.options.out, "curves.png"))

    def phase(self):
        quantized_from = self.options.steps * (1 - self.options.quantized)
        if self.step >= quantized_from:
            return "quantized"
        return "observe" if self.step >= quantized_from - max(20, self.options.steps // 20) else "float"

    def rate(self):
        done = self.step / self.options.steps
        warm_up = max(1, min(WARM_UP, self.options.steps // 4))
        return self.options.rate * (min(1, (self.step + 1) / warm_up) * 0.5 * (1 + math.cos(math.pi * done)) + 0.003)

    def one_step(self):
        o = self.options
        rng = np.random.default_rng([o.seed, self.step, self.rank])
        shared = np.random.default_rng([o.seed, self.step, 1 << 20])
        self.head.mode = self.phase()
        for group in self.optimizer.param_groups:
            group["lr"] = self.rate()
        drawn = self.samples.crops(rng, max(1, o.batch // self.world))
        batch = objective.Batch(drawn, self.device, rng.random(len(drawn)) < 0.6)
        loss, seen = objective.planar_loss(self.head, batch, rng, self.term, self.device)
        novel = math.nan
        if shared.random() < o.novel:
            context, target = self.samples.triplet(rng)
            extra, decibel = objective.novel_loss(self.head, context, target, self.term, self.device)
            if extra is not None:
                loss, novel = loss + 0.5 * extra, decibel
        self.optimizer.zero_grad()
        loss.backward()
        self._share_gradients()
        torch.nn.utils.clip_grad_norm_(self.head.parameters(), 1.0)
        self.optimizer.step()
        self.step += 1
        return [seen[0], seen[1], novel, float(loss)]

    def _share_gradients(self):
        if self.world == 1:
            return
        gradients = [p.grad for p in self.head.parameters()]
        flat = torch.cat([g.flatten().cpu() for g in gradients])
        distributed.all_reduce(flat)
        at = 0
        for g in gradients:
            g.copy_((flat[at : at + g.numel()] / self.world).reshape(g.shape))
            at += g.numel()
        for n in range(1, len(self.head.layers) + 1):  # all processes take the largest range seen by any
            seen = getattr(self.head, f"range{n}")
            most = seen.cpu()
            distributed.all_reduce(most, distributed.ReduceOp.MAX)
            seen.copy_(most)

    def train(self, every=50):
        o, since, gathered = self.options, time.time(), []
        keep_every = min(250, max(1, o.steps // 8))
        while self.step < o.steps:
            phase, rate = self.phase(), self.rate()
            gathered.append(self.one_step())
            if self.step % every == 0 or self.step == o.steps:
                now = time.time()
                self.seconds, since = self.seconds + now - since, now
                plain, refined, novel, loss = means(gathered)
                gathered = []
                self.rows.append(
                    [self.step, round(self.seconds, 1)]
                    + [round(float(v), 3) for v in (plain, refined, novel, loss)]
                    + [round(rate, 6), phase]
                )
                if self.rank == 0:
                    left = self.seconds / self.step * (o.steps - self.step) / 60
                    print(
                        f"step {self.step}/{o.steps} {phase}: {plain:.2f} dB, refined {refined:.2f},",
                        f"novel {novel:.2f}; {left:.0f} min left",
                        flush=True,
                    )
            if self.step % keep_every == 0 or self.step == o.steps:
                self.save()
        self.head.mode = "quantized" if o.quantized > 0 else "float"
        if self.rank == 0:
            name = o.name or o.head
            head_net.save_safetensors(self.head, os.path.join(o.out, f"{name}.safetensors"), name)


def held_out_error(run, count=16):
    """Returns the geometric mean of the squared error over generated pictures that no step draws, in their own view,
    unrefined."""
    rng, total = np.random.default_rng([run.options.seed, 1 << 40]), 0.0
    with torch.no_grad():
        for _ in range(count // 4):
            batch = objective.Batch(run.samples.crops(rng, 4), run.device)
            splats = splatting.planar_splats(*batch.footprints(run.head, run.device), batch.pixel)
            drawn = splatting.draw(
                splats, batch.start, objective.drawing_order(rng, batch.start), batch.width, batch.height
            )
            total += float(
                torch.log(objective.errors(drawn, batch.pictures, batch.weight, run.term)[0] + objective.FLOOR).sum()
            )
    return math.exp(total / count)


def launch(options, arguments):
    """Runs processes that share the steps, as torchrun would start them; the first failure ends all."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    ranks = []
    for rank in range(options.processes):
        environment = {**os.environ, "RANK": str(rank), "LOCAL_RANK": str(rank), "WORLD_SIZE": str(options.processes),
                       "MASTER_ADDR": "127.0.0.1", "MASTER_PORT": str(port),
                       "OMP_NUM_THREADS": str(max(1, (os.cpu_count() or 1) // options.processes))}  # fmt: skip
        ranks.append(subprocess.Popen([sys.executable, os.path.abspath(__file__), *arguments], env=environment))
    try:
        while (codes := [r.poll() for r in ranks]).count(None) and not any(codes):
            time.sleep(0.2)
        return next((c for c in codes if c), 0)
    finally:
        for r in ranks:
            r.kill()


def main(arguments=None):
    arguments = sys.argv[1:] if arguments is None else arguments
    options = options_of(arguments)
    if options.processes > 1 and "RANK" not in os.environ:
        return launch(options, arguments)
    run = Run(options)
    before = held_out_error(run) if options.smoke else 0
    run.train(every=20 if options.steps <= 1000 else 50)
    if options.smoke and run.rank == 0:
        factor = held_out_error(run) / before
        print(f"smoke: squared error of pictures not trained on fell to {factor:.3f} (must be below {SMOKE_FACTOR})")
        return 0 if factor < SMOKE_FACTOR else 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
