"""What the ports of the firmware share: its sources, its build, and what it prints."""
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
BAREMETAL = ROOT / "platform" / "baremetal"
BOARDS = {path.parent.name: json.loads(path.read_text()) for path in sorted(BAREMETAL.glob("boards/*/board.json"))}
STAGES = ("image", "depth", "pointmap", "wavelet", "superclusters", "budget", "head", "refine", "raster")
# What the firmware takes of the platform: the reader of recordings without a heap.
READER = ("cdr", "fixed_camera", "fixed_double", "fixed_text", "frame_reader", "message_frame", "pixel_layout",
          "ros_messages", "ros_schemas", "text")
INCLUDES = (ROOT / "runtime" / "include", ROOT / "runtime", ROOT / "platform", BAREMETAL, ROOT / "quant" / "heads")
FLAGS = ("-std=c11", "-ffunction-sections", "-fdata-sections", "-nostartfiles", "-Wall", "-Wextra", "-Werror",
         "-Wl,--gc-sections")
SECONDS_MOST = 600


def run(*command, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)
    if done.returncode != 0:
        sys.exit(f"tools/boards: {' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def build(board, suffix, compiler, link, options):
    """The board's firmware, by this compiler with these words for the linker."""
    ram = f"-{options.ram}" if options.ram else ""
    made = options.out / f"{board}-{options.head}{options.optimize}{ram}{suffix}"
    port = BAREMETAL / BOARDS[board]["port"]
    runtime = sorted(path for path in (ROOT / "runtime").rglob("*.c") if path.parent.name != "x86")
    weights = [] if options.head == "analytic" else [ROOT / "quant" / "heads" / f"{options.head}.c"]
    sources = [*sorted(BAREMETAL.glob("*.c")), *sorted(port.glob("*.c")), *runtime, *weights,
               *(ROOT / "platform" / f"{name}.c" for name in READER)]
    given = [*sources, *(path for folder in INCLUDES for path in folder.rglob("*.h")), *BAREMETAL.rglob("*.ld"),
             *BAREMETAL.rglob("*.json")]
    if made.exists() and made.stat().st_mtime > max(path.stat().st_mtime for path in given):
        return made
    head = [] if options.head == "analytic" else [f"-DHEAD=t3r_head_{options.head}",
                                                  f"-DHEAD_BYTES=t3r_head_{options.head}_bytes"]
    include = [word for folder in INCLUDES for word in ("-I", folder)]
    run(*compiler, *FLAGS, options.optimize, *BOARDS[board]["flags"], *include, *head, *sources, *link, "-o", made)
    return made


def words(path, options):
    """The firmware's command line, but for hashes and the view."""
    width, height = options.size
    return [f"frames={path}", f"width={width}", f"height={height}", f"views={options.views}",
            f"gaussians={options.gaussians}", f"clusters={options.clusters}", f"refinements={options.refine}",
            f"learned={int(options.head != 'analytic')}"]


def said_by(board, *command):
    """What the firmware prints, as {name: text}."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=SECONDS_MOST)
    if done.returncode != 0:
        sys.exit(f"tools/boards: {board}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return dict(line.rsplit(" ", 1) for line in done.stdout.splitlines())


def row(board, said, flash_bytes, view):
    """What each port tells of a run with hashes."""
    hashes = {name[5:]: text for name, text in said.items() if name.startswith("hash ")}
    return {
        "board": board,
        "name": BOARDS[board]["name"],
        "hash": hashes.pop("final"),
        "hashes": hashes,
        "flash_bytes": flash_bytes,
        "ram_bytes": sum(int(said[f"{part}_bytes"]) for part in ("data", "memory", "stack")),
        **{name: int(said[name]) for name in ("gaussians", "arena_bytes", "arena_min_bytes", "stack_bytes")},
        "view": str(view),
    }
