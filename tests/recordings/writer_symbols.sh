#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# What the recorder needs from a C library: memcpy, memset, memcmp (clang: bcmp), memmove and strlen, so neither
# heap nor files.
#   writer_symbols.sh COMPILER SOURCE_FOLDER
set -eu
compiler=$1
source=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
files="host/fixed_text host/text mcap/crc32 mcap/mcap_chunk_writer mcap/mcap_records mcap/mcap_writer messages/cdr
    messages/fixed_camera messages/fixed_double messages/ros_messages messages/ros_schemas messages/pixel_layout
    recording/recorder_chunk recording/recorder_messages recording/recorder_summary recording/recording_writer"
for file in $files; do
    "$compiler" -std=gnu11 -O2 -fno-stack-protector -I "$source/platform" -I "$source/runtime" -I "$source/runtime/include" \
        -c "$source/platform/$file.c" -o "$scratch/$(basename "$file").o"
done
ld -r -o "$scratch/recorder.o" "$scratch"/*.o
allowed='memcpy|memset|memcmp|bcmp|memmove|strlen|_GLOBAL_OFFSET_TABLE_'
needed=$(nm -u "$scratch/recorder.o" | awk '{print $2}' | grep -vxE "$allowed" || true)
if [ -n "$needed" ]; then
    echo "the recorder needs: $needed"
    exit 1
fi
echo "the recorder needs no heap and no files"
