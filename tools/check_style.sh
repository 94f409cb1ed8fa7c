#!/usr/bin/env bash
# tools/check_style.sh [ROOT]: the C++ is as .clang-format says. Exits 77 (skipped) without the version that it names:
# each version lays some lines out differently, so that only one can say what is right.
set -euo pipefail
root=${1-$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)}
wanted=$(sed -n 's/^# clang-format \([0-9]*\).*/\1/p' "$root/.clang-format")
for formatter in "clang-format-$wanted" clang-format ''; do
    [ -n "$formatter" ] || { echo "skipped: the style is that of clang-format $wanted, which is not installed"; exit 77; }
    "$formatter" --version 2>/dev/null | grep -q "version $wanted\." && break
done
cd "$root"
find host tests tools \( -name '*.cpp' -o -name '*.h' \) -print0 | xargs -0 --no-run-if-empty "$formatter" --dry-run --Werror
