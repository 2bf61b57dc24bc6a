#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""completion.py TRIM3R: shells complete commands, options and files; the answer to a misspelt word suggests the
right one."""
import os
import shutil
import subprocess

from program import TRIM3R, check, expect, in_scratch, write


def completed(*words):
    """Returns bash's suggestions for the last word."""
    line = " ".join(f"'{word}'" for word in words)
    script = (f"source script.bash; COMP_WORDS=('{TRIM3R}' {line}); COMP_CWORD={len(words)}; _trim3r; "
              "printf '%s\\n' \"${COMPREPLY[@]}\"")
    return subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True).stdout.split()


def bash_completes():
    with open("script.bash", "w", encoding="utf-8") as file:
        file.write(expect(0, "completion", "bash"))
    subprocess.run(["bash", "-n", "script.bash"], check=True)
    write("scene.ply", b"ply")
    check(completed("bu") == ["build"], f"bu: {completed('bu')}")
    check({"info", "import"} <= set(completed("i")), f"i: {completed('i')}")
    check(completed("build", "--gau") == ["--gaussians"], f"--gau: {completed('build', '--gau')}")
    check(set(completed("plan", "--s")) >= {"--size", "--svg", "--seed"}, f"--s: {completed('plan', '--s')}")
    check("--complete" not in completed("plan", "--"), "a hidden option is offered")
    check(set(completed("info", "sc")) == {"scene.ply", "script.bash"}, f"files: {completed('info', 'sc')}")
    check("scene.ply" in completed("build", "--prune", "sce"), "no file for --prune")
    check(completed("build", "--gaussians", "sce") == [], "a file for a number")
    check(completed("build", "--wavelet", "h") == ["haar"], f"--wavelet h: {completed('build', '--wavelet', 'h')}")
    check(completed("replay", "--align", "") == ["on", "off"], f"--align: {completed('replay', '--align', '')}")


def other_shells():
    for shell in ("zsh", "fish"):
        with open(f"script.{shell}", "w", encoding="utf-8") as file:
            file.write(expect(0, "completion", shell, out="trim3r"))
        if shutil.which(shell):
            done = subprocess.run([shell, "-n", f"script.{shell}"], capture_output=True, text=True)
            check(done.returncode == 0, f"{shell} -n: {done.stderr}")
    expect(0, "completion", "fish", "-o", "copy.fish")
    with open("copy.fish", encoding="utf-8") as one, open("script.fish", encoding="utf-8") as other:
        check(one.read() == other.read(), "-o writes another script")
    expect(2, "completion", err="missing")
    expect(2, "completion", "tcsh", err="tcsh")


def nearly():
    expect(2, "biuld", err="did you mean build?")
    expect(2, "reply", err="did you mean replay?")
    expect(2, "plan", "--gausians", 5, err="did you mean --gaussians?")
    expect(2, "plan", "--gausians=5", err="did you mean --gaussians?")
    expect(2, "plan", "--no-such-option", err="unrecognized option")
    expect(2, "plan", "--size", err="requires an argument")
    for word in ("paint", "x" * 200):
        code = subprocess.run([TRIM3R, word], capture_output=True, text=True)
        check(code.returncode == 2 and "did you mean" not in code.stderr, f"{word[:9]}: {code.stderr}")


def completion():
    if shutil.which("bash"):
        bash_completes()
    other_shells()
    nearly()
    check(os.path.exists("script.zsh"), "no script")


in_scratch(completion)
