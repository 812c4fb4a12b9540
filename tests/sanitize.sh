#!/bin/sh
# All tests under the address, leak and undefined behaviour sanitizers (preset `sanitize`), whole runs of the program among
# them.  Left out: the ten million steps, whose freed memory the quarantine keeps, the limit of memory of the checkpoints'
# test, and what looks at sources or other builds.
# usage: sanitize.sh     (builds them; an hour or two on two cores)
set -eu
cd "$(dirname "$(readlink -f "$0")")/.."
mkdir -p build
{ cmake --preset sanitize && cmake --build build/sanitize; } >build/sanitize.log 2>&1 || {
  tail -n 40 build/sanitize.log
  exit 1
}
ctest --test-dir build/sanitize --output-on-failure --parallel "$(nproc)" --timeout 3000 \
  -E '^(ManySteps|headers|dependencies|install|format|bootstrap)'
