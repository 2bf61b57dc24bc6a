# SPDX-License-Identifier: Apache-2.0
"""A terminal for the program under test."""
import os
import pty
import subprocess
import threading

END = b"\0"  # no program writes this


def on_terminal(command, both=True, **options):
    """Returns the exit status and what the program writes to stderr, and with `both` to stdout, if these are a terminal.

    The terminal stays open until all of it is read: Linux may drop what is left in one whose last writer has closed it."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=theirs if both else subprocess.DEVNULL, stderr=theirs,
                               **options)

    def end():
        process.wait()
        os.write(theirs, END)

    waiting = threading.Thread(target=end)
    waiting.start()
    written = b""
    while not written.endswith(END):
        written += os.read(ours, 65536)
    waiting.join()
    os.close(theirs)
    os.close(ours)
    return process.returncode, written[:-len(END)].decode()
