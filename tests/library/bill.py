#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""bill.py BUILD PACKAGE=FILE...: the bill of materials of each package has what SPDX 2.3 asks for, and names the libraries
that its files load, those and no others, with the versions that are here. Heads are those of the tree. The same input
gives the same bill."""
import copy
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import zlib

from library import HEADS, ROOT, SERIES, there

from checks import check, done, run

REQUIRED = {"": ("spdxVersion", "dataLicense", "SPDXID", "name", "documentNamespace", "creationInfo", "packages",
                 "relationships"),
            "creationInfo": ("created", "creators"), "packages": ("SPDXID", "name", "downloadLocation"),
            "relationships": ("spdxElementId", "relationshipType", "relatedSpdxElement")}
APART = ("trim3r-cameras", "trim3r-poses", "libtrim3r-host-dev", f"libtrim3r-host{SERIES}") # without the runtime
WEIGHTS_HEADER = 16 # bytes that the CRC-32 of a weight file leaves out
WRITER = ROOT / "tools" / "packaging" / "write_bill.cmake"


def lacks(bill):
    """Returns the fields required by SPDX 2.3 that the bill lacks."""
    parts = {"": [bill], "creationInfo": [bill.get("creationInfo", {})],
             **{name: bill.get(name, []) for name in ("packages", "relationships")}}
    found = [f"{name} without {field}" for name, fields in REQUIRED.items() for part in parts[name] for field in fields
             if not part.get(field)]
    ids = ["SPDXRef-DOCUMENT", *(part.get("SPDXID", "") for part in parts["packages"])]
    found += [f"the id {name}" for name in ids if ids.count(name) > 1 or not re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", name)]
    ends = [part.get(end) for part in parts["relationships"] for end in ("spdxElementId", "relatedSpdxElement")]
    found += [f"{end}, which is nothing" for end in ends if end not in (*ids, "NONE")]
    if not re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", parts["creationInfo"][0].get("created", "")):
        found.append("a date that is none")
    return found


def related(bill, kind, of="SPDXRef-Package"):
    """Returns the packages at the other end of a package's relations of that kind; NONE unchanged."""
    packages = {part["SPDXID"]: part for part in bill["packages"]}
    return [packages.get(part["relatedSpdxElement"], "NONE") for part in bill["relationships"]
            if part["relationshipType"] == kind and part["spdxElementId"] == of]


def loaded(*paths):
    """Returns the libraries that files load directly."""
    said = [run("readelf", "--dynamic", "--wide", path).stdout for path in paths if path.suffix != ".a"]
    return set(re.findall(r"\(NEEDED\).*\[(.*)\]", "".join(said)))


def listed(bill):
    return {part["packageFileName"] for part in related(bill, "DEPENDS_ON") if part != "NONE" and "packageFileName" in part}


def version_here(name):
    """Returns pkg-config's version, if it knows the package."""
    said = subprocess.run(["pkg-config", "--modversion", name], capture_output=True, text=True, check=False)
    return said.stdout.strip() if said.returncode == 0 else None


def check_heads(name, bill):
    for part in related(bill, "CONTAINS"):
        if "checksums" not in part:
            continue
        source = ROOT / part["packageFileName"]
        check(source.parent == HEADS, f"{name}: a head in {source}")
        check(part["checksums"][0]["checksumValue"] == hashlib.sha256(source.read_bytes()).hexdigest(),
              f"{name}: the SHA-256 of {source.name}")
        numbers = re.search(r"\[\] = \{\n(.*?)\}", source.read_text(), re.S)[1]
        weights = bytes(map(int, re.findall(r"\d+", numbers)))
        check(part["versionInfo"] == f"{zlib.crc32(weights[WEIGHTS_HEADER:]):08x}", f"{name}: the CRC of {source.name}")


def check_bill(name, bill, paths):
    needed = loaded(*paths)
    check(not lacks(bill), f"{name}: {lacks(bill)}")
    check(bill["packages"][0]["name"] == name and bill["packages"][0]["licenseDeclared"] == "Apache-2.0", f"{name}: itself")
    check(needed <= listed(bill), f"{name} loads {needed - listed(bill)}, which its bill leaves out")
    check(listed(bill) <= needed, f"{name} does not load {listed(bill) - needed}")
    check((related(bill, "DEPENDS_ON") == ["NONE"]) == (needed == set()), f"{name}: what it depends on")
    if name not in APART:
        check(related(bill, "DEPENDS_ON", "SPDXRef-runtime") == ["NONE"], f"{name}: the runtime depends on nothing")
    for part in related(bill, "DEPENDS_ON"):
        if part != "NONE" and "packageFileName" in part:
            check("versionInfo" in part, f"{name}: no version of {part['packageFileName']}")
            here = version_here(part["name"])
            check(here in (None, part["versionInfo"]), f"{name}: {part['name']} {part['versionInfo']}, and here is {here}")
    check_heads(name, bill)


def find_what_is_planted(bill, path):
    """A removed field, an omitted library and an extra one."""
    for name, fields in REQUIRED.items():
        for field in fields:
            planted = copy.deepcopy(bill)
            part = planted[name] if name else planted
            del (part[-1] if isinstance(part, list) else part)[field]
            check(lacks(planted), f"blind: {name} without {field}")
    planted = copy.deepcopy(bill)
    one = next(part for part in planted["packages"] if "externalRefs" in part)
    gone = one["packageFileName"]
    one["packageFileName"] = "libplanted.so.1"
    check(loaded(path) - listed(planted) == {gone}, "blind: a library that is left out")
    check(listed(planted) - loaded(path) == {"libplanted.so.1"}, "blind: a library too many")


def written(folder, file, heads, **environment):
    """Returns the script's output for one file and heads."""
    output = folder / "planted.spdx.json"
    words = {"OUTPUT": output, "PACKAGE": "planted", "COMPONENT": "program", "VERSION": "1.0", "FILES": file,
             "HEADS": heads, "NEEDS": "", "KNOWN": "libz|zlib|9.9", "READELF": "readelf"}
    words = [f"-D{name}={value}" for name, value in words.items()]
    kept = {name: value for name, value in os.environ.items() if name != "SOURCE_DATE_EPOCH"}
    subprocess.run(["cmake", *words, "-P", WRITER], check=True, env={**kept, **environment})
    return output.read_text()


def check_writer(folder):
    """Checks the bill of a program that loads a library: it is reproducible, except for a requested date."""
    source, program, head = folder / "main.c", folder / "program", folder / "zero.c"
    source.write_text("int main(void) { return 0; }\n")
    head.write_text("one[] = {\n" + ",".join("0" * 12) + ",1,2,0,0,9,\n};\n") # a CRC that begins with zeros
    run("cc", source, "-Wl,--no-as-needed", "-lz", "-o", program)
    first = written(folder, program, head)
    check(first == written(folder, program, head), "the same input gives another bill")
    bill = json.loads(first)
    check(not lacks(bill) and listed(bill) == loaded(program) >= {"libz.so.1"}, f"a program with zlib: {first}")
    check([part.get("versionInfo") for part in bill["packages"] if part["name"] == "zlib"] == ["9.9"], "its version")
    check([part["versionInfo"] for part in bill["packages"] if part["name"] == "trim3r-head-zero"] == ["00000201"], "zeros")
    check(bill["creationInfo"]["created"] == "1970-01-01T00:00:00Z", "the date of no date")
    dated = json.loads(written(folder, program, head, SOURCE_DATE_EPOCH="86400"))
    check(dated["creationInfo"]["created"] == "1970-01-02T00:00:00Z", "the date that is asked for")
    check(dated["documentNamespace"] != bill["documentNamespace"], "another bill has another name")


def main():
    if not there("cc", "cmake", "pkg-config", "readelf"):
        sys.exit(77)
    files = {}
    for word in sys.argv[2:]:
        name, path = word.split("=", 1)
        files.setdefault(name, []).append(pathlib.Path(path))
    bills = {path.name.removesuffix(".spdx.json"): json.loads(path.read_text())
             for path in (pathlib.Path(sys.argv[1]) / "tools" / "packaging").glob("*.spdx.json")}
    check(set(files) <= set(bills), f"no bill of {set(files) - set(bills)}")
    one = next(name for name, paths in files.items() if loaded(*paths))
    find_what_is_planted(bills[one], files[one][0])
    for name, paths in files.items():
        check_bill(name, bills[name], paths)
    with tempfile.TemporaryDirectory(prefix="trim3r-bill-") as folder:
        check_writer(pathlib.Path(folder))
    done()


if __name__ == "__main__":
    main()
