#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""structure.py [LIBRARY...]: the picture of the house holds. Every area includes only what stands below it, and no
two source files of a library call each other, be it through others. Nor do folders of the tools include each other,
and none is a heap. Who opens a runtime chooses its inner loops.

MAY is the whole picture: what each area may include. An area that is not in it is a finding, so a new one is entered
here with its arrows.
"""
import collections
import pathlib
import re
import sys

import proof

MOST_SOURCES = 30 # in a folder

# Rooms of the runtime from the foundation up: each may include those before it.
ROOMS = ("include", "core", "pixels", "kernels", "state", "depth", "image", "pointmap", "stereo", "wavelet", "superclusters", "budget",
         "raster", "head", "refine", "stage_hash", "stages", "pipeline", "loss", "stream", "layout", "api", "errors")
MAY = {"runtime/" + room: {"runtime/" + below for below in ROOMS[:at]} for at, room in enumerate(ROOMS)}
RUNTIME = set(MAY)
MAY["quant"] = RUNTIME
# Rooms of the platform, in the same way; `platform` itself has the headers that are installed.
PLATFORM = ("platform", *(f"platform/{room}" for room in ("host", "mcap", "messages", "recording", "capture")))
for at, room in enumerate(PLATFORM):
    MAY[room] = RUNTIME | set(PLATFORM[:at])
PLATFORM = set(PLATFORM)
MAY["platform/baremetal"] = RUNTIME | PLATFORM | {"quant"}


def tool(name, *uses, base=PLATFORM):
    """Enters an area of tools/: the areas it uses directly, and theirs."""
    MAY["tools/" + name] = RUNTIME | set(base)
    for used in uses:
        MAY["tools/" + name] |= {"tools/" + used} | MAY["tools/" + used]


tool("cli")
tool("geometry")
tool("room")
tool("pictures", "cli")
tool("posing", "cli", "geometry")
tool("import", "pictures", "posing")
tool("scene", "cli", "geometry")
tool("reconstruction", "import", "scene", base=PLATFORM | {"quant"})
tool("capture", "reconstruction")
tool("viewer", "reconstruction")
tool("ros", "reconstruction")
tool("study/boards")
tool("planning", "reconstruction", "room", base=PLATFORM | {"quant"})
tool("bench", "planning", base=PLATFORM | {"quant"})
tool("evaluation", "reconstruction")
tool("trim3r", "capture", "viewer", "bench", "evaluation")
tool("study/peers")
tool("study/chart", "pictures")
tool("study/rivals", "reconstruction")
tool("study/ablation", "evaluation")
tool("study/stress", "evaluation", "study/rivals")
tool("study/troubles")
tool("study/commands", "trim3r", "study/chart", "study/ablation", "study/stress", "study/troubles")
tool("study/train", "study/rivals")
tool("study", "study/commands")
tool("python", "geometry", "room", "pictures", "scene", base=PLATFORM | {"quant"})
tool("examples", base=PLATFORM | {"quant", "platform/baremetal"})

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
OPENS = re.compile(r"\bt3r_(init|attach)\([^)]") # a call, not its name in a comment
SYMBOL = re.compile(r"^.*\[([^\]]+)\]: (\S+) (\w)")


def area_of(path):
    """Returns the area of a source file, by its path from the root of the tree."""
    folder, stem = path.parent.as_posix(), path.with_suffix("").as_posix()
    if folder.startswith("runtime"):
        return "/".join(stem.split("/")[:2])
    if folder.startswith("tools/study"):
        return "/".join(folder.split("/")[:3])
    if folder.startswith("tools"):
        return "/".join(folder.split("/")[:2])
    if folder.startswith("platform"):
        return "/".join(folder.split("/")[:2])
    return folder.split("/")[0]


def resolve(root, path, name):
    """Returns the file of the tree that an #include names, by the include paths that its area is built with."""
    for base in (path.parent, pathlib.Path("runtime/include"), pathlib.Path("runtime"), pathlib.Path("quant"),
                 pathlib.Path("quant/heads"), pathlib.Path("platform"), pathlib.Path("tools")):
        if (root / base / name).is_file():
            return pathlib.Path((root / base / name).resolve().relative_to(root.resolve()))
    return None


def sources(root):
    for part in ("runtime", "quant", "platform", "tools"):
        for path in sorted((root / part).rglob("*")):
            if path.suffix in (".c", ".h", ".cpp", ".hpp"):
                yield path.relative_to(root)


def check_rooms(paths):
    """Folders with too many sources."""
    counts = collections.Counter(path.parent for path in paths)
    return [f"{folder}: {count} sources, more than {MOST_SOURCES}" for folder, count in counts.items() if count > MOST_SOURCES]


def check_includes(root):
    """Returns includes that MAY does not allow."""
    findings = []
    for path in sources(root):
        area = area_of(path)
        if area not in MAY:
            findings.append(f"{path}: its area {area} is not in the picture")
            continue
        for name in INCLUDE.findall((root / path).read_text()):
            target = resolve(root, path, name)
            if target is not None and area_of(target) not in MAY[area] | {area}:
                findings.append(f"{path} includes {target}: {area} may not use {area_of(target)}")
    return findings


def check_kernels(root):
    """Returns sources that open a runtime and leave its inner loops in plain C."""
    return [f"{path}: opens a runtime without t3r_set_cpu()" for path in sources(root)
            if path.parts[0] != "runtime" and OPENS.search(text := (root / path).read_text()) and "t3r_set_cpu(" not in text]


def circles(arrows):
    """Returns the sets of nodes that reach each other (Tarjan)."""
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for after in sorted(arrows.get(node, ())):
            if after not in index:
                visit(after)
                low[node] = min(low[node], low[after])
            elif after in stack:
                low[node] = min(low[node], index[after])
        if low[node] == index[node]:
            circle = []
            while not circle or circle[-1] != node:
                circle.append(stack.pop())
            if len(circle) > 1:
                found.append(sorted(circle))

    for node in sorted(arrows):
        if node not in index:
            visit(node)
    return found


def check_folders(root):
    """Returns folders of the tools whose files include each other's, also within an area."""
    arrows = collections.defaultdict(set)
    for path in sources(root):
        for name in INCLUDE.findall((root / path).read_text()):
            target = resolve(root, path, name)
            if path.parts[0] == "tools" and target is not None and target.parent != path.parent:
                arrows[str(path.parent)].add(str(target.parent))
    return [f"folders include each other: {', '.join(circle)}" for circle in circles(arrows)]


def is_study(area):
    return area.split("/")[:2] == ["tools", "study"]


def check_picture(may):
    """Checks that MAY has no cycle, and no arrow from the product to the study."""
    findings = [f"the picture has a circle: {', '.join(circle)}" for circle in circles(may)]
    return findings + [f"{area} of the product may use {used}" for area, uses in may.items() for used in sorted(uses)
                       if is_study(used) and not is_study(area)]


def check_calls(libraries):
    """Returns source files that call each other or use each other's data, as the linker sees it."""
    findings = []
    for library in libraries:
        defines, needs = {}, {}
        for line in proof.run(["nm", "--print-file-name", "--extern-only", "--format=posix", library],
                              check=True).stdout.splitlines():
            found = SYMBOL.match(line)
            if found is None:
                continue
            member, symbol, kind = found.groups()
            if kind in "Uvw":
                needs.setdefault(member, set()).add(symbol)
            else:
                defines[symbol] = member
        arrows = {member: {defines[s] for s in symbols if defines.get(s, member) != member}
                  for member, symbols in needs.items()}
        findings += [f"{pathlib.Path(library).name}: call each other: {', '.join(circle)}"
                     for circle in circles(arrows)]
    return findings


def planted_findings():
    """Checks planted offenders: a small tree in planted/house, and two files that call each other."""
    house = proof.PLANTED / "house"
    findings = check_includes(house)
    for offence in ("runtime/core/outward.c includes platform/capture/planted_replay.h",
                    "runtime/core/upward.c includes runtime/stream/planted_stream.h",
                    "tools/cli/back.c includes tools/scene/planted_scene.h",
                    "tools/scene/study.c includes tools/study/rivals/planted_rival.h",
                    "tools/attic/new.c: its area tools/attic is not in the picture"):
        proof.must_find(findings, offence, "house")
    if len(findings) != 5:
        proof.broken("the planted house has five offences, no more", findings)
    proof.must_find(check_folders(house), "folders include each other: tools/cli, tools/scene, tools/study/rivals", "house")
    proof.must_find(check_kernels(house), "tools/cli/plain.c: opens a runtime", "house")
    proof.must_find(check_picture({"a": {"b"}, "b": {"c"}, "c": {"a"}}), "a, b, c", "a picture of three")
    proof.must_find(check_picture({"tools/trim3r": {"tools/study/rivals"}}), "of the product", "an arrow to the study")
    proof.must_find(check_rooms([pathlib.Path("heap", f"{i}.c") for i in range(MOST_SOURCES + 1)]), "heap: 31", "a heap")
    with proof.scratch() as folder:
        objects = proof.compile_each(proof.TARGETS["x86_64"], sorted((house / "calls").glob("*.c")), folder)
        library = folder / "calls.a"
        proof.run(["ar", "rcs", library, *objects], check=True)
        proof.must_find(check_calls([library]), "call each other", "house/calls")


def main():
    planted_findings()
    libraries = sys.argv[1:]
    tests = (path for path in (proof.ROOT / "tests").rglob("*") if path.suffix in (".c", ".h", ".py"))
    proof.verdict("no area includes what stands above it; no folders of the tools include each other; no two files of a library call each "
                  "other; no folder is a heap; no embedder runs plain C", check_picture(MAY) + check_includes(proof.ROOT) + check_folders(proof.ROOT) + check_calls(libraries) + check_kernels(proof.ROOT) +
                  check_rooms([*sources(proof.ROOT), *tests]))


if __name__ == "__main__":
    main()
