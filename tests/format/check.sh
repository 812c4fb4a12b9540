#!/bin/sh
# check.sh [CLANG_FORMAT]: every source file is as clang-format 14 with the .clang-format of the project writes it.
set -eu
cd "$(dirname "$(readlink -f "$0")")/../.."
find base dem app tests -name '*.h' -o -name '*.cc' | sort | xargs "${1:-clang-format-14}" --dry-run -Werror
