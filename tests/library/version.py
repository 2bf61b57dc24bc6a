#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""version.py: the version and the bits epoch of trim3r.h equal those of every file that states them."""
import re

from library import ROOT, SERIES, VERSION

from checks import check, done

EPOCH = re.search(r"#define T3R_BITS_EPOCH (\d+)", (ROOT / "runtime/include/trim3r.h").read_text())[1]
STATED = (  # file, text around the version, the version
    ("CHANGELOG.md", r"\A(?s:.*?)^## (\d\S*) \(bits epoch \d+\) - \d{4}-\d\d-\d\d$", VERSION),
    ("CHANGELOG.md", r"\A(?s:.*?)^## .*\(bits epoch (\d+)\)", EPOCH),
    ("docs/library.md", r"find_package\(trim3r (\S+) ", SERIES),
    ("docs/library.md", r"`libtrim3r(?:-host)?(?:\.so\.)?(\d.*?)`", SERIES),
    ("tools/examples/CMakeLists.txt", r"find_package\(trim3r (\S+) ", SERIES),
    ("docs/python.md", r"^(\d\S* \d+)$", f"{VERSION} {EPOCH}"),
    ("docs/python.md", r"^trim3r (\d\S*):", VERSION),
    ("tools/packaging/conan/conanfile.py", r'^    version = "(.*)"$', VERSION),
    ("tools/packaging/vcpkg/trim3r/vcpkg.json", r'^  "version": "(.*)",$', VERSION),
    ("tools/python/pyproject.toml", r'^version = "(.*)"$', VERSION),
    ("tools/ros/package.xml", r"<version>(.*)</version>", VERSION),
)


def findings(name, text, pattern, wanted):
    """Returns a finding if a file states no version or another one."""
    stated = re.findall(pattern, text, re.M)
    if set(stated) != {wanted}:
        yield f"{name} states {stated}, not {wanted}"


def main():
    for name, pattern, wanted in STATED:
        text = (ROOT / name).read_text()
        check(list(findings(name, text.replace(wanted, "9.9"), pattern, wanted)), f"blind: another version in {name}")
        for finding in findings(name, text, pattern, wanted):
            check(False, finding)
    recipes = [path.name for path in (ROOT / "tools/packaging/yocto").glob("*.bb")]
    check(recipes == [f"trim3r_{VERSION}.bb"], f"Yocto's recipe is {recipes}, not of {VERSION}")
    done()


if __name__ == "__main__":
    main()
