#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Bags of a foreign writer to recordings (bags.py), in the folder where the packages are.   bags.sh TRIM3R BUILD PYTHON
set -eu
build=$2/reference
sources=$(cd "$(dirname "$0")" && pwd)
. "$sources/npm.sh"
exec "$3" "$sources/bags.py" "$1" "$build"
