#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""work.py LIBRARY: progress, cancelling, threads, and the end of a reconstructor."""
import copy
import gc
import signal
import threading

from common import FRAMES, SIDE, check, np, refused, small, trim3r, with_views

from checks import done


def check_progress():
    calls = []
    with with_views(progress=lambda *call: calls.append(call)) as made:
        made.build(200)
    check({stage for stage, _, _ in calls} > {"superclusters", "refine"}, f"stages: {calls[:3]}")
    check(all(0 <= finished <= total for _, finished, total in calls), "what is done of how much")


def check_stopping():
    """Any exception of a callback stops the work and leaves the call; the next call works."""
    stop = []

    def progress(*_):
        if stop:
            raise stop[0]

    with with_views(progress=progress, workers=2) as made:
        for error in (trim3r.Cancelled("enough"), KeyError("it"), KeyboardInterrupt()):
            stop[:] = [error]
            with refused(type(error)):
                made.build(200)
            stop.clear()
            with refused(trim3r.StateError):
                made.render(FRAMES[1].camera)
        wanted = made.build(200).gaussians.tobytes()
        stop[:] = [trim3r.Cancelled("enough")]
        with refused(trim3r.Cancelled, "enough"):
            made.render(FRAMES[1].camera)
        stop.clear()
        with with_views() as other:
            check(other.build(200).gaussians.tobytes() == wanted, "nothing is left of what was stopped")


def check_signal():
    """A signal's exception ends a build without a progress callback."""
    called = []

    def stop(*_):
        called.append(True)
        raise KeyboardInterrupt

    previous = signal.signal(signal.SIGALRM, stop)
    with small(2) as made, refused(KeyboardInterrupt):
        signal.setitimer(signal.ITIMER_REAL, 0.02)
        for _ in range(1000):
            made.reset()
            made.add_view(FRAMES[0])
            made.add_view(FRAMES[2])
            made.build(1000)
    signal.signal(signal.SIGALRM, previous)
    check(called == [True] and not made._lock.locked(), "the signal, and nothing is held")


def check_reentry():
    """A callback cannot call its own reconstructor."""
    made = with_views(progress=lambda *_: made.render(FRAMES[1].camera))
    with refused(trim3r.StateError, "at work"):
        made.build(200)
    made = with_views(progress=lambda *_: made.close())
    with refused(trim3r.StateError, "at work"):
        made.build(200)
    check(not made.closed, "it is not closed in the middle of its work")


def check_threads():
    """Runs several at once, each in a thread; one in two threads takes one call at a time."""
    results, turned_away = [], []

    def build(made):
        try:
            results.append(made.build(300).copy().gaussians.tobytes())
        except trim3r.StateError as error:
            turned_away.append(str(error))

    together([threading.Thread(target=build, args=(with_views(workers=2),)) for _ in range(4)])
    check(len(results) == 4 and len(set(results)) == 1, "four reconstructors, one result")
    entered, leave = threading.Event(), threading.Event()

    def wait(*_):
        entered.set()
        leave.wait(10)

    shared = with_views(progress=wait)
    first = threading.Thread(target=build, args=(shared,))
    first.start()
    check(entered.wait(10), "the first is at work")
    build(shared)
    leave.set()
    first.join()
    check(len(turned_away) == 1 and "at work" in turned_away[0] and len(results) == 5, f"{turned_away}")


def together(threads):
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def check_end():
    made = with_views(workers=3)
    scene = made.build(100)
    before = threading.active_count()
    made.close()
    made.close()
    check(made.closed and threading.active_count() == before, "closed twice")
    for call in (lambda: made.build(1), lambda: made.rebuild(1), lambda: made.render(FRAMES[0].camera), made.reset,
                 lambda: made.add_view(FRAMES[0]), lambda: made.picture(FRAMES[0].camera), made.__enter__().reset):
        with refused(trim3r.StateError, "closed"):
            call()
    with refused(trim3r.StateError):
        scene.positions.sum()
    with refused(TypeError):
        copy.deepcopy(made)
    for _ in range(20): # left to the garbage collector, at any time
        with_views(workers=2, progress=lambda *_: None).build(50)
    gc.collect()
    with with_views() as again:
        again.build(100)
        again.reset()
        check(again.valid_points == 0, "begun anew")
        again.add_view(FRAMES[1])
        check(again.valid_points == SIDE * SIDE and len(again.build(keep=50)) == SIDE * SIDE // 2, "one view")
        check(np.array_equal(again.build(100).copy().gaussians, again.rebuild(100).gaussians), "built twice")


def check_warm():
    """Slides a pair: a view replaces the oldest, and the previous scene becomes invalid."""
    with with_views(settings={"warm": 1}) as made:
        before = made.build(keep=10)
        made.add_view(FRAMES[1])
        check(made.valid_points == 2 * SIDE * SIDE, f"two views, not three: {made.valid_points}")
        with refused(trim3r.StateError, "copy()"):
            before.positions.sum()
        check(len(made.build(keep=10)) == round(2 * SIDE * SIDE / 10), "a tenth of both views")


def main():
    check_progress()
    check_stopping()
    check_signal()
    check_reentry()
    check_threads()
    check_end()
    check_warm()
    done()


if __name__ == "__main__":
    main()
