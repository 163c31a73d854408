"""pages_test.py SOURCE: every path and room that the pages of .github name is in the tree."""

import pathlib
import re
import sys

# Named as they will be; each leaves the list when it is there.
COMING = set()

source = pathlib.Path(sys.argv[1]).resolve()
top = "include|src|apps|tests|data"
wrong, count = [], 0
for page in sorted((source / ".github").rglob("*.md")):
    for path in re.findall(rf"(?<![\w/])((?:{top})/[\w./<>-]+)", page.read_text()):
        path = path.rstrip("./")
        count += 1
        there = list(source.glob(re.sub(r"<\w+>", "*", path))) if "<" in path else (source / path).exists()
        if path in COMING and there:
            wrong.append(f"{path} is there now: take it off the list COMING in tests/house/pages_test.py")
        if not there and path not in COMING:
            wrong.append(f"{page.relative_to(source)} names {path}, which is not there")
    for folder in re.findall(r"(?<![\w/])`(\w+)/`", page.read_text()):
        rooms = [*source.glob(f"include/thermfit/**/{folder}"), *source.glob(f"src/{folder}"), source / folder]
        if not any(room.is_dir() for room in rooms) and f"src/{folder}" not in COMING:
            wrong.append(f"{page.relative_to(source)} names a room {folder}/, which is not there")
        count += 1
if count < 40:
    wrong.append(f"only {count} paths were found")
print(f"{count} paths, {len(wrong)} wrong")
sys.exit("\n".join(sorted(set(wrong))) if wrong else 0)
