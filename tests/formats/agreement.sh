#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The numbers of scene files, with readers and writers that are not ours.   agreement.sh TRIM3R BUILD_FOLDER PYTHON
set -eu
trim3r=$1
build=$2/foreign
python=$3
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../..
sources=$root/tools/study/formats
. "$root/tests/recordings/npm.sh"

"$python" -B "$here/agreement.py" "$trim3r" "$build"
