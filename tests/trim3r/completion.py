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
    write("scene.spz", b"NGSP")
    write("scene.npz", b"PK")
    write("s.t3w", b"T3RW")
    write("scores.csv", b"scene")
    os.mkdir("scans")
    for line, found in {("info", "sc"): {"scene.ply", "scene.spz", "scans"},
                        ("build", "--prune", "sc"): {"scene.ply", "scene.spz", "scans"},
                        ("convert", "-o", "sc"): {"scene.ply", "scene.spz", "scans"},
                        ("import", "--pointmaps", "sc"): {"scene.npz", "scans"},
                        ("eval", "--csv", "sc"): {"scores.csv", "scans"},
                        ("completion", "-o", "scr"): {"script.bash"},
                        ("help", "bu"): {"build"}, ("help", "comp"): {"completion"},
                        ("build", "--poses", "e"): {"estimate", "estimate-colour"},
                        ("build", "--arena", ""): {"min", "full"},
                        ("build", "--head", "s"): {"small", "s.t3w", "scans"}, ("replay", "--stream", "--lines", "s"): {"scans"},
                        ("eval", "--heads", "s"): {"small", "s.t3w", "scans"},
                        ("eval", "--heads", "none,t"): {"none,tiny"},
                        ("eval", "--heads", "none,tiny,s"): {f"none,tiny,{name}" for name in ("small", "s.t3w", "scans")},
                        ("build", "--importance", "a,sco"): {"a,scores.csv"},
                        ("convert", "--up", "-"): {"-x", "-y", "-z"},
                        ("room", "--compression", "z"): {"zstd"},
                        ("build", "--color", "a"): {"auto", "always"}}.items():
        check(set(completed(*line)) == found, f"{line}: {completed(*line)}")
    check(completed("build", "--gaussians", "sce") == [], "a file for a number")
    check(completed("build", "--wavelet", "h") == ["haar"], f"--wavelet h: {completed('build', '--wavelet', 'h')}")
    check(completed("replay", "--align", "") == ["on", "off"], f"--align: {completed('replay', '--align', '')}")


def in_fish(line):
    path = f"{os.path.dirname(TRIM3R)}:{os.environ['PATH']}"
    done = subprocess.run(["fish", "-c", f"source script.fish; complete -C '{line}'"], capture_output=True, text=True,
                          env={**os.environ, "PATH": path, "HOME": os.getcwd()})
    return {row.split("\t")[0] for row in done.stdout.splitlines()}


def fish_completes():
    name = os.path.basename(TRIM3R)
    if name != "trim3r":
        return
    for line, found in {"bu": {"build"}, "help bu": {"build"}, "plan --sv": {"--svg"}, "build --poses given": {"given"},
                        "info scen": {"scene.ply", "scene.spz"}, "import --pointmaps scen": {"scene.npz"},
                        "build --gaussians sc": set(), "build --head s": {"small", "s.t3w", "scans/"},
                        "eval --heads s": {"small", "s.t3w", "scans/"}, "eval --heads none,t": {"none,tiny"},
                        "eval --heads none,s": {"none,small", "none,s.t3w", "none,scans/"},
                        "build --importance a,sco": {"a,scores.csv"}}.items():
        check(in_fish(f"trim3r {line}") == found, f"fish, {line}: {in_fish('trim3r ' + line)}")


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
    if shutil.which("fish") and shutil.which("bash"):
        fish_completes()
    nearly()
    check(os.path.exists("script.zsh"), "no script")


in_scratch(completion)
