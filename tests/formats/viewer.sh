#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# An own folder to a scene in a viewer that is not ours.   viewer.sh TRIM3R BUILD_FOLDER PYTHON [PICTURES]
set -eu
trim3r=$1
build=$2/foreign
python=$3
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../..
sources=$root/tools/study/formats
. "$root/tests/recordings/npm.sh"

"$python" -B "$here/viewer.py" "$trim3r" "$build/node_modules/@playcanvas/supersplat-viewer/public" ${4+"$4"}
