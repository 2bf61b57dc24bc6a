# SPDX-License-Identifier: Apache-2.0
"""The program from outside: exit codes, messages, JSON. The program is the first argument of each script that uses this."""
import json
import os
import resource
import subprocess
import sys
import tempfile

from checks import check, done

TRIM3R = os.path.abspath(sys.argv[1])
HEADS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "quant", "heads")


def run(*arguments):
    done = subprocess.run([TRIM3R, *map(str, arguments)], capture_output=True, text=True, timeout=300)
    return done.returncode, done.stdout, done.stderr


def expect(code, *arguments, err=None, out=None):
    """Runs and checks the exit code and a piece of either stream; an error must say something, and only there."""
    got, stdout, stderr = run(*arguments)
    line = " ".join(map(str, arguments))
    check(got == code, f"{line}: exit {got}, not {code}: {stderr.strip()}")
    if code != 0:
        check(stderr.strip() != "", f"{line}: no message")
    if err:
        check(err in stderr, f"{line}: '{stderr.strip()}' does not say '{err}'")
    if out:
        check(out in stdout, f"{line}: '{stdout.strip()}' does not say '{out}'")
    return stdout


def fill_disk():
    """Limits files in the child process to 64 bytes, like a full disk."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (64, resource.RLIM_INFINITY))


def expect_full(target, *arguments):
    """Exit 1 that names `target` when the disk is full, and neither a whole nor a partial file left there."""
    # Python ignores the signal that would come first; the child must, too
    done = subprocess.run([TRIM3R, *map(str, arguments)], capture_output=True, text=True, timeout=300,
                          preexec_fn=fill_disk, restore_signals=False)
    line = " ".join(map(str, arguments))
    check(done.returncode == 1 and target in done.stderr, f"{line} on a full disk: {done.returncode} {done.stderr}")
    check(not [name for name in os.listdir(".") if name.startswith(target)], f"{line} on a full disk leaves a file")


def expect_json(*arguments):
    stdout = expect(0, *arguments, "--json")
    try:
        return json.loads(stdout)
    except ValueError:
        check(False, f"{' '.join(map(str, arguments))}: not JSON: {stdout[:200]}")
        return {}


def write(path, content):
    with open(path, "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())
    return path


def room(size="64x64", name="room.mcap", frames=6):
    """The built-in recording: small, as every command takes longer on larger pictures."""
    expect(0, "room", "--size", size, "--frames", frames, "-o", name)
    return name


def beyond(path):
    """Returns how many of the last Gaussians of a .ply are its rim and backdrop."""
    with open(path, "rb") as file:
        head = file.read().split(b"end_header\n", 1)[0]
    return int(head.rsplit(b"comment trim3r backdrop ", 1)[1]) if b"trim3r backdrop" in head else 0


def weight_file(path, bits="8"):
    """The float head small, quantized by the recording tiny.mcap under the file's name; the file's bytes."""
    expect(0, "quantize", os.path.join(HEADS, "small.safetensors"), "--calibrate", "tiny.mcap", "--weights", bits,
           "--activations", bits, "--name", path.split(".")[0], "-o", path)
    return open(path, "rb").read()


def in_scratch(*tests):
    """Runs each test, all in one empty folder."""
    with tempfile.TemporaryDirectory(prefix="trim3r-cli-") as folder:
        os.chdir(folder)
        for test in tests:
            test()
        os.chdir("/")
    done()
