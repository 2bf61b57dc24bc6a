#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""fork.py LIBRARY: a child of fork() builds, draws and ends with its parent's reconstructors, with any workers, and never
waits for threads that only its parent has."""
import multiprocessing
import os
import signal
import threading
import traceback

from common import FRAMES, check, small, trim3r, with_views

from checks import done

SECONDS = 60


def in_child(work):
    """Returns the exit status of a child that does the work; a signal ends one that hangs."""
    child = os.fork()
    if child == 0:
        signal.alarm(SECONDS)
        try:
            work()
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            os._exit(1)
    return os.waitpid(child, 0)[1]


def build(made):
    return made.build(300).gaussians.tobytes(), made.render(FRAMES[1].camera).tobytes()


def check_workers(workers, wanted):
    with with_views(workers=workers) as made, with_views(workers=workers) as unused:
        if workers > 1:
            build(made)

        def work():
            check(build(made) == wanted, "the bits of the parent")
            check(build(unused) == wanted, "workers that have not worked before")
            made.reset()
            for frame in (FRAMES[0], FRAMES[2]):
                made.add_view(frame)
            check(build(made) == wanted, "once more")
            check(in_child(lambda: check(build(made) == wanted, "the bits of a grandchild")) == 0, "a grandchild")
            with with_views(workers=workers) as own:
                check(build(own) == wanted, "a child's own")
            made.close()

        check(in_child(work) == 0, f"{workers} workers in a child")
        check(in_child(made.close) == 0, f"{workers} workers end in a child")
        check(in_child(lambda: None) == 0, f"{workers} workers are left alone")
        check(build(made) == wanted, "the parent goes on")


def score(index):
    return trim3r.evaluate([FRAMES[0], FRAMES[2]], FRAMES[1], [10], workers=2)[0].psnr


def check_pool():
    """The usual way to many processes, begun while workers wait in the parent."""
    with with_views(workers=2) as made:
        build(made)
        with multiprocessing.get_context("fork").Pool(2) as pool:
            scores = pool.map_async(score, range(4)).get(SECONDS)
    check(len(set(scores)) == 1 and scores[0] > 20, f"{scores}")


def check_at_work():
    """A child that is made while another thread builds cannot go on with that build: StateError at once."""
    entered, leave = threading.Event(), threading.Event()

    def progress(*_):
        entered.set()
        leave.wait(SECONDS)

    with with_views(workers=2, progress=progress) as made:
        thread = threading.Thread(target=lambda: made.build(300))
        thread.start()
        check(entered.wait(SECONDS), "it is at work")

        def work():
            try:
                made.render(FRAMES[1].camera)
            except trim3r.StateError as error:
                check("at work" in str(error), f"{error}")
                return
            check(False, "a build that no thread continues is drawn")

        check(in_child(work) == 0, "in a child of a process at work")
        leave.set()
        thread.join(SECONDS)
        check(len(made.rebuild(300)) == 300, "the parent goes on")


def main():
    signal.alarm(4 * SECONDS)
    with small() as made:
        made.add_view(FRAMES[0])
        made.add_view(FRAMES[2])
        wanted = build(made)
    for workers in (1, 2, 5):
        check_workers(workers, wanted)
    check_pool()
    check_at_work()
    done()


if __name__ == "__main__":
    main()
