#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Make runtime/budget/blue_noise.c: a 64 x 64 void-and-cluster threshold map (Ulichney 1993).

    tools/blue_noise.py > runtime/budget/blue_noise.c

Every rank 0..4095 occurs once; the ranks below any level are spread evenly, also across the tile's borders."""
import numpy as np

SIDE, SIGMA = 64, 1.5


def filter_of():
    d = np.minimum(np.arange(SIDE), SIDE - np.arange(SIDE))
    return np.exp(-(d[:, None] ** 2 + d[None, :] ** 2) / (2 * SIGMA ** 2))


def ranks():
    kernel, n = filter_of(), SIDE * SIDE
    shift = lambda place: np.roll(np.roll(kernel, place // SIDE, 0), place % SIDE, 1).ravel()
    rng = np.random.RandomState(1)
    ones = np.zeros(n, bool)
    ones[rng.permutation(n)[: n // 10]] = True
    energy = sum(shift(p) for p in np.flatnonzero(ones))
    tightest = lambda: int(np.argmax(np.where(ones, energy, -np.inf)))
    emptiest = lambda: int(np.argmin(np.where(ones, np.inf, energy)))
    while True:  # the initial pattern: move points from clusters to voids until that changes nothing
        cluster = tightest()
        ones[cluster] = False
        energy -= shift(cluster)
        void = emptiest()
        ones[void] = True
        energy += shift(void)
        if void == cluster:
            break
    rank = np.zeros(n, int)
    start, start_energy, count = ones.copy(), energy.copy(), int(ones.sum())
    for r in range(count - 1, -1, -1):
        cluster = tightest()
        ones[cluster] = False
        energy -= shift(cluster)
        rank[cluster] = r
    ones, energy = start, start_energy
    for r in range(count, n):
        void = emptiest()
        ones[void] = True
        energy += shift(void)
        rank[void] = r
    return rank


if __name__ == "__main__":
    print('/* Made by tools/blue_noise.py; do not edit. */\n#include "blue_noise.h"\n')
    print("const uint8_t t3r_blue_noise_packed[T3R_BLUE_NOISE_BYTES] = {")
    flat = ranks()
    packed = [byte for a, b in zip(flat[::2], flat[1::2]) for byte in (a & 255, a >> 8 | (b & 15) << 4, b >> 4)]
    for i in range(0, len(packed), 24):
        print("    " + " ".join(f"{byte}," for byte in packed[i : i + 24]))
    print("};")
