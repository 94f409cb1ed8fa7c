#!/usr/bin/env bash
# tools/check_style.sh [ROOT]: the C++ is as .clang-format says. Exits 77 (skipped) where there is no clang-format.
set -euo pipefail
root=${1-$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)}
command -v clang-format >/dev/null || { echo "skipped: clang-format is not installed"; exit 77; }
cd "$root"
find host tests tools \( -name '*.cpp' -o -name '*.h' \) -print0 | xargs -0 --no-run-if-empty clang-format --dry-run --Werror
