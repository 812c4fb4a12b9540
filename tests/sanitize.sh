#!/bin/sh
# The test programs of single parts and of the extremes under the address and undefined behaviour sanitizers (preset
# `sanitize`).
# usage: sanitize.sh     (builds them; half an hour on two cores)
set -eu
cd "$(dirname "$(readlink -f "$0")")/.."
programs="test_base test_dem test_input test_invariance test_extremes"
mkdir -p build
{ cmake --preset sanitize && cmake --build build/sanitize --target $programs; } >build/sanitize.log 2>&1 || {
  tail -n 40 build/sanitize.log
  exit 1
}
for program in $programs; do
  # Freed memory stays in the sanitizer's quarantine: what ten million steps keep is for the other build to tell.
  "build/sanitize/bin/$program" --gtest_brief=1 --gtest_filter='-ManySteps.*'
done
