#!/usr/bin/env bash
# compare_code_blocks.sh README SOURCE: each ```cpp block of README follows a line `<!-- FILE -->` and equals that file.
set -u
awk -v source="$2" '
  /^<!-- .* -->$/ { file = $2 }
  /^```cpp$/ { inside = 1; text = ""; at = NR; next }
  /^```$/ && inside {
    inside = 0; ++blocks; whole = ""
    if (file == "") { print FILENAME ":" at ": a C++ block that names no file"; wrong = 1; next }
    while ((getline line < (source "/" file)) > 0) whole = whole line "\n"
    if (index(whole, text) == 0 || text == "") { print FILENAME ":" at ": differs from " file; wrong = 1 }
    file = ""
  }
  inside { text = text $0 "\n" }
  END { print blocks + 0 " C++ blocks of README compared"; exit wrong || !blocks }' "$1"
