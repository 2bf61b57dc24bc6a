# SPDX-License-Identifier: Apache-2.0
"""A virtual machine with Debian's kernel, some of its drivers, and one program to run. Needs no root; uses KVM if it
works."""
import glob
import gzip
import lzma
import os
import re
import shutil
import subprocess
import tarfile

from checks import skip

# drivers for insmod, in the order of their dependencies
CAPTURE = [f"media/{name}" for name in (
    "mc/mc v4l2-core/videodev common/videobuf2/videobuf2-common common/videobuf2/videobuf2-memops "
    "common/videobuf2/videobuf2-v4l2 common/videobuf2/videobuf2-vmalloc").split()]
PATTERNS = [f"media/{name}" for name in (
    "common/videobuf2/videobuf2-dma-contig common/v4l2-tpg/v4l2-tpg v4l2-core/v4l2-dv-timings rc/rc-core "
    "cec/core/cec").split()]
MODULES = {
    "vivid": [*CAPTURE, *PATTERNS, "media/test-drivers/vivid/vivid"],
    "vimc": [*CAPTURE, *PATTERNS],  # and vimc itself, which is built
    "uvcvideo": [*CAPTURE, "usb/common/usb-common", "usb/core/usbcore", "usb/usbip/usbip-core", "usb/usbip/vhci-hcd",
                 "media/usb/uvc/uvcvideo"],
}

INIT = """#!/bin/busybox sh
/bin/busybox --install -s /bin
export PATH=/bin LD_LIBRARY_PATH=/lib
mount -t proc p /proc; mount -t sysfs s /sys; mount -t devtmpfs d /dev; mount -t tmpfs t /tmp
ip link set lo up
for m in $(cat /mod/list); do
    case $m in
    vivid.ko) insmod /mod/$m n_devs=2 node_types=0x1,0x1 num_inputs=1,1 input_types=0,0 ;;
    *) insmod /mod/$m ;;
    esac
done
mkdir /run
cd /tmp
mkdir out
: > out/log
echo BOOTED
tail -f out/log & # no pipe, which would last as long as the last of the job's programs
sh -x /job.sh > out/log 2>&1
stty -F /dev/ttyS1 raw
tar -cf - -C out . > /dev/ttyS1
sync
reboot -f
"""


def need(*commands):
    for command in commands:
        if shutil.which(command) is None:
            skip(f"{command} is not there (tools/setup --cameras)")


def kernel_version():
    listed = subprocess.run(["apt-cache", "depends", "linux-image-amd64"], capture_output=True, text=True)
    found = re.search(r"Depends: linux-image-(\S+)", listed.stdout)
    return found.group(1) if found else skip("apt knows no linux-image-amd64")


def package(folder, name):
    """Returns the path of a package, downloaded once and not installed."""
    need("dpkg-deb", "apt-get")
    os.makedirs(folder, exist_ok=True)
    if not glob.glob(f"{folder}/{name}_*.deb"):
        subprocess.run(["apt-get", "download", "-q", name], cwd=folder, capture_output=True, timeout=300)
    found = glob.glob(f"{folder}/{name}_*.deb")
    return found[0] if found else skip(f"{name} cannot be downloaded")


def unpack_kernel(folder):
    """Returns (vmlinux, folder of drivers)."""
    version = kernel_version()
    image = package(folder, f"linux-image-{version}")
    vmlinux, drivers = f"{folder}/vmlinux-{version}", f"{folder}/lib/modules/{version}/kernel/drivers"
    modules = sorted({module for wanted in MODULES.values() for module in wanted})
    if not all(map(os.path.exists, [vmlinux, *(f"{drivers}/{m}.ko" for m in modules)])):
        wanted = [f"./boot/vmlinuz-{version}"]
        wanted += [f"./lib/modules/{version}/kernel/drivers/{m}.ko" for m in modules]
        with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", image], stdout=subprocess.PIPE) as files:
            subprocess.run(["tar", "-x", "-C", folder, *wanted], stdin=files.stdout, check=True)
        with open(f"{folder}/boot/vmlinuz-{version}", "rb") as file:
            packed = file.read()
        # an ELF booted by PVH, because decompressing in an emulated processor would be slow
        with open(vmlinux + ".part", "wb") as file:
            file.write(lzma.LZMADecompressor().decompress(packed[packed.find(b"\xfd7zXZ\0"):]))
        os.rename(vmlinux + ".part", vmlinux)
    return vmlinux, drivers


def unpack_udev(folder):
    """Returns the program of udevd, from which libcamera learns of cameras."""
    program = f"{folder}/udev/bin/udevadm"
    if not os.path.exists(program):
        subprocess.run(["dpkg-deb", "-x", package(folder, "udev"), f"{folder}/udev"], check=True)
    if "not found" in linked(program):
        skip("udevd's libraries are not there (tools/setup --tests --cameras)")
    return program


def linked(program):
    return subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout


def libraries(program):
    return re.findall(r"(/\S+)", linked(program))


def build_vimc(folder):
    """Builds the driver vimc, which Debian's kernel lacks, from its source against Debian's headers."""
    need("make", "cc", "xz")
    module = f"{folder}/vimc/vimc.ko"
    if os.path.exists(module):
        return module
    version = kernel_version()
    series = ".".join(version.split(".")[:2])
    root = os.path.abspath(f"{folder}/headers")
    for name in (f"linux-headers-{version}", f"linux-headers-{version.removesuffix('-amd64')}-common",
                 f"linux-kbuild-{series}"):
        subprocess.run(["dpkg-deb", "-x", package(folder, name), root], check=True)
    headers = f"{root}/usr/src/linux-headers-{version}"
    with open(f"{headers}/Makefile", encoding="utf-8") as file:
        text = file.read()
    with open(f"{headers}/Makefile", "w", encoding="utf-8") as file:
        file.write(text.replace("include /usr/src/", f"include {root}/usr/src/"))
    source = f"linux-source-{series}"
    subprocess.run(f"dpkg-deb --fsys-tarfile {package(folder, source)} | tar -xO ./usr/src/{source}.tar.xz | xz -dc | "
                   f"tar -x -C {folder} --strip-components=4 --wildcards "
                   f"'{source}/drivers/media/test-drivers/vimc/*'", shell=True, check=True)
    done = subprocess.run(["make", "-s", "-C", headers, f"M={os.path.abspath(folder)}/vimc", "CONFIG_VIDEO_VIMC=m",
                           "modules"], capture_output=True, text=True)
    if done.returncode != 0:
        skip(f"vimc does not build: {done.stderr[-500:]}")
    return module


def initramfs(folder, modules, programs, job, files=(), data=None):
    """Packs the root file system: `programs` with their libraries in /bin, `files` at their own paths, `data` as
    {path: bytes}."""
    root = f"{folder}/root"
    shutil.rmtree(root, ignore_errors=True)
    for name in ("bin", "mod", "proc", "sys", "dev", "tmp", "lib", "lib64"):
        os.makedirs(f"{root}/{name}")
    shutil.copy(shutil.which("busybox"), f"{root}/bin/busybox")
    for program in programs:
        shutil.copy(program, f"{root}/bin/")
        for library in libraries(program):
            target = "lib64" if os.path.basename(library).startswith("ld-linux") else "lib"
            shutil.copy(library, f"{root}/{target}/")
    for file in files:
        os.makedirs(root + os.path.dirname(file), exist_ok=True)
        shutil.copy(file, root + file)
    for path, content in (data or {}).items():
        os.makedirs(root + os.path.dirname(path), exist_ok=True)
        with open(root + path, "wb") as file:
            file.write(content)
    for module in modules:
        shutil.copy(module, f"{root}/mod/")
    for path, text, mode in (("mod/list", "".join(os.path.basename(m) + "\n" for m in modules), 0o644),
                             ("init", INIT, 0o755), ("job.sh", job, 0o755)):
        with open(f"{root}/{path}", "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(f"{root}/{path}", mode)
    names = subprocess.run(["find", ".", "-print0"], cwd=root, capture_output=True, check=True).stdout
    packed = subprocess.run(["cpio", "-o", "-0", "-H", "newc", "--quiet"], cwd=root, input=names, capture_output=True,
                            check=True).stdout
    with gzip.open(f"{folder}/initramfs.gz", "wb", compresslevel=1) as file:
        file.write(packed)
    return f"{folder}/initramfs.gz"


def boot(folder, vmlinux, image, accelerator, seconds, megabytes=768):
    """Boots the machine; returns the console's text and the path of the second serial port's output."""
    out = f"{folder}/out.tar"
    machine = ["-accel", "kvm", "-cpu", "host"] if accelerator == "kvm" else ["-accel", "tcg", "-cpu", "max"]
    command = ["qemu-system-x86_64", "-M", "q35", *machine, "-smp", "1", "-m", str(megabytes), "-nodefaults",
               "-display", "none", "-serial", "stdio", "-serial", f"file:{out}", "-no-reboot", "-kernel", vmlinux,
               "-initrd", image, "-append", "console=ttyS0 quiet loglevel=0 panic=-1 rdinit=/init"]
    with open(f"{folder}/console", "wb") as console:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=console, stderr=subprocess.STDOUT)
    late = ""
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        process.kill()
        late = "\ntime is over"
        try:
            process.wait(5)
        except subprocess.TimeoutExpired:
            late += ", and the machine cannot be ended"  # a faulty KVM may block it
    with open(f"{folder}/console", "rb") as console:
        return console.read().decode(errors="replace") + late, out


def kvm_works(folder, vmlinux, modules):
    """Whether KVM works, tried once and stored: a machine with a faulty KVM hangs before its first output."""
    if not os.access("/dev/kvm", os.R_OK | os.W_OK):
        return False
    answer = f"{folder}/kvm-works"
    if not os.path.exists(answer):
        with open(answer, "w", encoding="ascii") as file:
            file.write("no")  # in case this trial hangs
        said, _ = boot(folder, vmlinux, initramfs(folder, modules, [], "true\n"), "kvm", 20)
        with open(answer, "w", encoding="ascii") as file:
            file.write("yes" if "BOOTED" in said else "no")
    with open(answer, encoding="ascii") as file:
        return file.read() == "yes"


def run(folder, programs, job, seconds, driver, files=(), data=None, megabytes=768):
    """Runs the shell script `job` with that driver. Returns {file name: bytes} of its folder out, the accelerator,
    and the console's text. `programs`, `files` and `data` are those of initramfs()."""
    need("qemu-system-x86_64", "busybox", "cpio")
    vmlinux, drivers = unpack_kernel(folder)
    modules = [f"{drivers}/{m}.ko" for m in MODULES[driver]]
    if driver == "vimc":
        modules.append(build_vimc(folder))
    accelerator = os.environ.get("T3R_VM_ACCEL") or ("kvm" if kvm_works(folder, vmlinux, modules) else "tcg")
    image = initramfs(folder, modules, programs, job, files, data)
    said, out = boot(folder, vmlinux, image, accelerator, seconds, megabytes)
    left = {}
    try:
        with tarfile.open(out) as tar:
            left = {os.path.basename(m.name): tar.extractfile(m).read() for m in tar if m.isfile()}
    except (OSError, tarfile.TarError):
        pass
    return left, accelerator, said
