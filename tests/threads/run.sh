#!/bin/sh
# The tests with several threads under the thread sanitizer (preset `tsan`).  Clang's OpenMP runtime tells the sanitizer
# through Archer what it orders; without Archer every parallel region would look like a race.
set -eu
cd "$(dirname "$(readlink -f "$0")")/../.."
export OMP_TOOL_LIBRARIES=/usr/lib/llvm-14/lib/libarcher.so
export TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1 $*"
DENSIFY_PRESET=tsan exec ./densify test -R 'Thread|ForcePass|NearList|ContactList|Checkpoint|Recording|Realisation|same_result'
