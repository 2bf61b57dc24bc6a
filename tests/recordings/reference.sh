#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Both ways with MCAP's reference reader and writer (npm: @mcap/core).   reference.sh RECORDING_TOOL BUILD_FOLDER
set -eu
tool=$1
build=$2/reference
sources=$(cd "$(dirname "$0")" && pwd)
. "$sources/npm.sh"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for encoding in rgb8 bgr8 mono8 yuv422_yuy2 yuv422 nv12; do
    for storage in none zstd lz4 unchunked; do
        "$tool" sample $storage $encoding "$scratch/ours.mcap"
        node "$build/read_ours.mjs" $storage $encoding "$scratch/ours.mcap"
    done
done
for packing in none lz4 zstd unchunked; do
    for encoding in rgb8 nv12; do
        echo "theirs, $packing:"
        node "$build/write_theirs.mjs" $packing $encoding "$scratch/theirs.mcap"
        "$tool" dump "$scratch/theirs.mcap" >"$scratch/dump.json"
        node "$build/check_dump.mjs" $encoding <"$scratch/dump.json"
    done
done
