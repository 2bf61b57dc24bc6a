# SPDX-License-Identifier: Apache-2.0
"""The input of every board, and this machine's results for it."""
import json

from firmware import run


def recording(options):
    if options.recording is not None:
        return options.recording.resolve()
    path = options.out / f"room-{options.size[0]}x{options.size[1]}.mcap"
    run(options.program, "room", "--size", f"{options.size[0]}x{options.size[1]}", "--frames", options.views + 1, "-o", path)
    return path


def host(path, options):
    """Returns this machine's hash and {stage: hash}. A firmware without the feature has no rim."""
    rim = "on" if "backdrop" in options.features else "off"
    context = ",".join(map(str, range(options.views)))
    said = json.loads(run(options.program, "replay", path, "--context", context, "--head",
                          options.head, "--gaussians", options.gaussians, "--clusters", options.clusters, "--refine",
                          options.refine, "--fit-passes", "off", "--fit-widths", "off", "--align", "off",
                          "--rim", rim, "--json"))
    return said["hash"], said["stages"]
