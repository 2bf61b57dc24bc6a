# SPDX-License-Identifier: Apache-2.0
"""Cortex-M boards in QEMU: instructions are counted one by one."""
import pathlib

from firmware import BAREMETAL, BOARDS, STAGES, build, is_small, row, run, said_by, words

CLANG = ("clang", "--target=arm-none-eabi")
COMPILER, EMULATOR = "arm-none-eabi-gcc", "qemu-system-arm"
PLUGIN_SOURCE = pathlib.Path(__file__).resolve().parent / "instructions.c"
PLAIN = "plain C"
TOOLS = (COMPILER, EMULATOR, "cc")


def lacks():
    """Returns a missing tool, or None."""
    return None


def plugin(options):
    library = options.out / "libinstructions.so"
    if not library.exists() or library.stat().st_mtime < PLUGIN_SOURCE.stat().st_mtime:
        run("cc", "-std=c11", "-O2", "-shared", "-fPIC", PLUGIN_SOURCE, "-o", library)
    return library


def start(board, elf, line, *more):
    config = ",".join(["enable=on,target=native,arg=trim3r", *(f"arg={word}" for word in line)])
    return said_by(board, EMULATOR, "-M", BOARDS[board]["machine"], "-nographic", "-monitor", "none", "-serial", "none",
                   "-semihosting-config", config, *more, "-kernel", elf)


def flash_of(elf):
    text, data, _ = map(int, run("arm-none-eabi-size", elf).splitlines()[1].split()[:3])
    return text + data


def marks_of(elf):
    symbols = (line.split() for line in run("arm-none-eabi-nm", elf).splitlines())
    places = {parts[-1]: parts[0] for parts in symbols if len(parts) == 3}
    return "".join(f",mark={stage}:0x{places[f'mark_{stage}']}" for stage in (*STAGES, "other"))


def count(board, elf, line, options):
    """Returns {stage: instructions}, and the longest stretch without a call of progress."""
    table = options.out / f"{elf.stem}.counts"
    start(board, elf, [*line, "hashes=0"], "-plugin", f"{plugin(options)}{marks_of(elf)}", "-d", "plugin", "-D", table)
    rows = [parts for parts in map(str.split, table.read_text().splitlines()) if parts[0] in STAGES]
    return {parts[0]: int(parts[1]) for parts in rows}, max(int(parts[2]) for parts in rows)


def prepare(options):
    """Prepares the part that all boards share."""
    plugin(options)


def measured_with(board, kernels, elf, line, options):
    """Measures a row: the firmware with plain C, or with the kernels for its core."""
    line = [*line, f"plain={int(kernels == PLAIN)}"]
    view = elf.with_name(f"{elf.stem}-{kernels.replace(' ', '-')}.ppm")
    said = start(board, elf, [*line, "hashes=1", f"view={view}"])
    instructions, longest = count(board, elf, line, options)
    name = BOARDS[board]["name"] + (f", {kernels}" if "kernels" in BOARDS[board] else "")
    return {**row(board, said, flash_of(elf), view), "name": name, "kernels": kernels,
            "instructions": sum(instructions.values()), "instructions_of": instructions, "longest_stretch": longest}


def firmware_of(board, options):
    link = ["-nostartfiles", "-L", BAREMETAL / "cortex_m", "-T", BAREMETAL / "boards" / board / "board.ld",
            *([f"-Wl,--defsym=RAM_BYTES={options.ram}"] if options.ram else [])]
    return build(board, ".elf", [COMPILER], link, options, CLANG if options.clang else None)


def measure(board, path, options):
    elf = firmware_of(board, options)
    ways = [PLAIN, *([BOARDS[board]["kernels"]] if "kernels" in BOARDS[board] and not is_small(options) else [])]
    return [measured_with(board, kernels, elf, words(path, options), options) for kernels in ways]
