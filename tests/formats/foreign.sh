#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Scene files both ways with readers and writers that are not ours.   foreign.sh TRIM3R BUILD_FOLDER PYTHON
set -eu
trim3r=$1
build=$2/foreign
python=$3
root=$(cd "$(dirname "$0")/../.." && pwd)
sources=$root/tools/study/formats
. "$root/tests/recordings/npm.sh"

node "$build/node_modules/@playcanvas/splat-transform/bin/cli.mjs" --version >/dev/null 2>&1 ||
    skip "splat-transform does not start with node $(node --version)"
"$python" -B "$root/tools/study/scripts/formats" --check --program "$trim3r" --packages "$build"
