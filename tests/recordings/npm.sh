# SPDX-License-Identifier: Apache-2.0
# Sourced by the tests that need node: installs the packages of package-lock.json in $build once, and copies the modules
# of $sources there.
skip() {
    echo "SKIPPED: $1"
    exit 77
}
command -v node >/dev/null || skip "no node"
command -v npm >/dev/null || skip "no npm"

mkdir -p "$build"
cp "$sources"/*.json "$sources"/*.mjs "$build"
if ! cmp -s "$build/package-lock.json" "$build/installed"; then
    (cd "$build" && npm ci --no-audit --no-fund --ignore-scripts >npm.log 2>&1) ||
        skip "npm ci failed (offline?): $(tail -n 1 "$build/npm.log")"
    cp "$build/package-lock.json" "$build/installed"
fi
