"""compiled_test.py SOURCE: what a header says that thermfit::compiled holds, a source of src/compiled/ holds.

A line THERMFIT_COMPILED_TEMPLATE(…) declares an instance to everybody who links the library; where no source defines it,
programs fail to link.
"""

import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1]).resolve()
include = source / "include"
INCLUDES = re.compile(r'^#include "(thermfit/[^"]+)"', re.M)


def reached(names, known):
    """The headers that `names` include, themselves among them, beyond those already `known`."""
    found, waiting = set(), list(names)
    while waiting:
        name = waiting.pop()
        if name not in found and name not in known:
            found.add(name)
            waiting += INCLUDES.findall((include / name).read_text())
    return found


promised = {
    path.relative_to(include).as_posix()
    for path in include.rglob("*.hpp")
    if path.name != "compiled.hpp" and re.search(r"^THERMFIT_COMPILED_TEMPLATE\(", path.read_text(), re.M)
}
sources = sorted((source / "src/compiled").glob("*.cpp"))
holders = {name: [] for name in promised}
for one in sources:
    declared, defined = one.read_text().split("#define THERMFIT_COMPILED_ELSEWHERE")
    before = reached(INCLUDES.findall(declared), set())
    for name in promised & reached(INCLUDES.findall(defined), before):
        holders[name].append(one.name)
wrong = [
    f"{name} promises an instance that {len(by)} sources define {by}, not one" for name, by in holders.items() if len(by) != 1
]
print(f"{len(sources)} sources hold the instances of {len(promised)} headers")
sys.exit("\n".join(sorted(wrong)) if wrong and sources else 0)
