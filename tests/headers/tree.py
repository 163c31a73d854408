"""The tree as the tests of this folder read it: headers, and what a file includes."""
import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1]).resolve()
INCLUDE = SOURCE / "include"
DOORS = ("thermfit", "regression", "study", "simulation", "diagnosis", "controller")


def headers():
    """Every header of the library, as it is included: thermfit/<room>/<name>.hpp."""
    return sorted(str(path.relative_to(INCLUDE)) for path in INCLUDE.rglob("*.hpp"))


def includes(path):
    """What a file includes in quotes."""
    return re.findall(r'^#include "([^"]+)"', path.read_text(), re.MULTILINE)


def reached(path):
    """Every header of the library that a file includes, directly or by others."""
    seen, waiting = set(), [path]
    while waiting:
        for name in includes(waiting.pop()):
            for folder in (INCLUDE, SOURCE / "src", SOURCE / "tests"):
                if (folder / name).is_file() and name not in seen:
                    seen.add(name)
                    waiting.append(folder / name)
    return seen


def finish(wrong, right):
    """Ends the test: the faults and 1, or what is right and 0."""
    print("\n".join(wrong) if wrong else right)
    sys.exit(bool(wrong))
