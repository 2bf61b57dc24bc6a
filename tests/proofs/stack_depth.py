#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stack_depth.py TARGET [--markdown]: the deepest stack of each public function, from the compiler's own call graph.

Fails on recursion, frames of unknown size, a depth over the limit, and calls through pointers that pointers.txt does
not declare. Stack of the caller's callbacks comes on top.
"""
import re
import sys

import proof
from proof import objects

LIMIT_BYTES = 12 * 1024
UNOPTIMISED_LIMIT_BYTES = 14 * 1024
NODE = re.compile(r'^node: \{ title: "([^"]+)" label: "([^"]*)"')
EDGE = re.compile(r'^edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
SOURCE = re.compile(r'^graph: \{ title: "(?:.*/)?([^"/]+)"')
FRAME = re.compile(r"(\d+) bytes \(([^)]*)\)")
INDIRECT = "__indirect_call"


def plain(title):
    """Returns draw_tile for raster.c:draw_tile.constprop.0."""
    return title.split(":")[-1].split(".")[0]


class Graph:
    def __init__(self, files):
        self.bytes, self.kind, self.calls, self.source = {}, {}, {}, {}
        for path in files:
            text = path.read_text()
            source = SOURCE.match(text)[1]
            for line in text.splitlines():
                node, edge = NODE.match(line), EDGE.match(line)
                frame = node and FRAME.search(node.group(2))
                if frame:
                    self.bytes[node.group(1)] = int(frame.group(1))
                    self.kind[node.group(1)] = frame.group(2)
                    self.source[node.group(1)] = source
                if edge:
                    self.calls.setdefault(edge.group(1), set()).add(edge.group(2))
        called = set().union(*self.calls.values()) if self.calls else set()
        self.uncalled = {title for title in self.bytes if title not in called}


class Depths:
    def __init__(self, graph, pointers):
        self.graph, self.findings, self.memo, self.pointers = graph, [], {}, pointers

    def row_of(self, title, caller):
        """Returns the row of pointers.txt for a function: the one for calls from its caller's file if there is one."""
        source = self.graph.source[title]
        own = f"{source} {plain(title)}"
        keys = ([f"{own} from {self.graph.source[caller]}"] if caller else []) + [own, source]
        return next((key for key in keys if key in self.pointers), source)

    def behind_pointer(self, title, key):
        """Returns the runtime's functions that a call through a pointer in this function may reach, by its row."""
        source = self.graph.source[title]
        if key not in self.pointers:
            self.findings.append(f"calls through a pointer, not declared in pointers.txt: {plain(title)} in {source}")
        return [t for t in self.graph.bytes if plain(t) in self.pointers.get(key, ())]

    def of(self, title, path=()):
        """Returns (bytes, deepest path) of the function and its callees."""
        if title in path:
            self.findings.append("recursion: " + " > ".join(plain(t) for t in (*path[path.index(title):], title)))
            return 0, ()
        if title not in self.graph.bytes:
            return 0, ()
        row = self.row_of(title, path[-1] if path else None)
        if (title, row) not in self.memo:
            # "dynamic,bounded" is realignment, which the reported bytes include
            if self.graph.kind[title] not in ("static", "dynamic,bounded"):
                self.findings.append(f"frame of unknown size: {plain(title)} ({self.graph.kind[title]})")
            below = (0, ())
            for callee in sorted(self.graph.calls.get(title, ())):
                for reached in self.behind_pointer(title, row) if callee == INDIRECT else [callee]:
                    below = max(below, self.of(reached, (*path, title)), key=lambda depth: depth[0])
            self.memo[title, row] = (self.graph.bytes[title] + below[0], (title, *below[1]))
        return self.memo[title, row]


def limit_of(target):
    return UNOPTIMISED_LIMIT_BYTES if "-O0" in target.flags else LIMIT_BYTES


def check(graph, roots, pointers, limit):
    depths = Depths(graph, pointers)
    table = []
    for root in sorted(roots):
        if root not in graph.bytes:
            depths.findings.append(f"{root} is declared but not defined")
            continue
        size, path = depths.of(root)
        table.append((root, size, path))
        if size > limit:
            depths.findings.append(f"deeper than {limit} bytes: {root} {size}: "
                                   + " > ".join(f"{plain(t)}({graph.bytes[t]})" for t in path))
    # A static function that nothing calls can only be reached through a pointer.
    declared = {name for names in pointers.values() for name in names}
    for name in sorted({plain(title) for title in graph.uncalled if ":" in title} - declared):
        depths.findings.append(f"reached through a pointer, not declared in pointers.txt: {name}")
    return sorted(set(depths.findings)), table


def declared_pointers():
    """Reads pointers.txt: source file, file and function, or these and the caller's file -> names of functions, each
    of which must exist."""
    text = re.sub(r"#.*", "", (proof.HERE / "pointers.txt").read_text())
    pointers = {source.strip(): names.split() for source, names in re.findall(r"^(.+?):(.*)$", text, flags=re.M)}
    runtime = {path.name: path.read_text() for path in proof.runtime_sources()}
    code = "".join([*runtime.values(), *(path.read_text() for path in proof.RUNTIME.rglob("*.h"))])
    stale = [f"{source} is not in the runtime" for key in pointers for source in key.split() if source.endswith(".c")
             and source not in runtime]
    stale += [f"{name} is not in the runtime" for names in pointers.values() for name in names
              if not re.search(rf"\b{name}\b", code)]
    stale += misplaced(pointers, runtime)
    if stale:
        proof.broken("pointers.txt is out of date", stale)
    return pointers


def misplaced(pointers, runtime):
    """Yields rows for a caller's file whose tasks differ from the tasks of the whole list that the file names."""
    for key in pointers:
        function, _, caller = key.partition(" from ")
        if caller in runtime:
            named = {name for name in pointers[function.split()[0]] if re.search(rf"\b{name}\b", runtime[caller])}
            if named != set(pointers[key]):
                yield f"{key}: that file names {' '.join(sorted(named))}"


def planted_graph(target, name, folder):
    made = proof.compile_each(target, [proof.PLANTED / name], folder, objects.GRAPH_FLAGS)
    return Graph(objects.call_graphs(made))


def main():
    target = proof.TARGETS[sys.argv[1]]
    pointers, limit = declared_pointers(), limit_of(target)
    with proof.scratch() as folder:
        for name, offence in [("recursion.c", "recursion: "), ("dynamic_frame.c", "frame of unknown size"),
                              ("deep.c", "deeper than"), ("task.c", "not declared in pointers.txt: planted_task"),
                              ("task.c", "calls through a pointer")]:
            graph = planted_graph(target, name, folder)
            proof.must_find(check(graph, ["t3r_planted"], {}, limit)[0], offence, name)
    graph = Graph(objects.call_graphs(proof.runtime_objects(target)))
    findings, table = check(graph, proof.public_functions(), pointers, limit)
    if "--markdown" in sys.argv:
        print("| function | stack, bytes |\n|---|---|")
        for name, size, _ in table:
            print(f"| `{name}` | {size} |")
    else:
        for name, size, path in sorted(table, key=lambda row: -row[1]):
            print(f"{name:24} {size:6} bytes  {' > '.join(f'{plain(t)}({graph.bytes[t]})' for t in path)}")
    proof.verdict(f"{target.name}: no recursion, no frame of unknown size, at most {limit} bytes of stack", findings)


if __name__ == "__main__":
    sys.exit(main())
