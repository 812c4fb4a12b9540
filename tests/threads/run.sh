#!/bin/sh
# The tests with several threads under the thread sanitizer (preset `tsan`).  Clang's OpenMP runtime tells the sanitizer
# through Archer what it orders; without Archer every parallel region would look like a race.
# usage: run.sh     (builds the test programs it needs)
set -eu
cd "$(dirname "$(readlink -f "$0")")/../.."
mkdir -p build
{ cmake --preset tsan && cmake --build build/tsan --target test_dem test_invariance test_verification; } >build/tsan.log 2>&1 || {
  tail -n 40 build/tsan.log
  exit 1
}
export OMP_TOOL_LIBRARIES=/usr/lib/llvm-14/lib/libarcher.so
export TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1"
clang++-14 -g -O1 -fopenmp -fsanitize=thread tests/threads/planted_race.cc -o build/tsan/planted_race
if build/tsan/planted_race >build/tsan/planted_race.log 2>&1 || ! grep -q 'data race' build/tsan/planted_race.log; then
  echo "the thread sanitizer does not see a planted race" >&2
  exit 1
fi
build/tsan/bin/test_dem --gtest_brief=1 --gtest_filter='Kernels.*Threads*:ForcePass*:NearList*:ContactList*:Checkpoint*'
build/tsan/bin/test_invariance --gtest_brief=1 --gtest_filter='Invariance.Threads:Recording*'
build/tsan/bin/test_verification --gtest_brief=1 \
  --gtest_filter='EqualisedInertia.SameStateForThreads*:CellDrive.ThreadsAndRestart'
