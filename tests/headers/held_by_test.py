"""held_by_test.py SOURCE: every header is held by a test, and every test of a room holds a header.

tests/ mirrors include/thermfit: <room>/<name>_test.cpp holds <room>/<name>.hpp. What is held otherwise stands in
tests/held_by.txt, `header or folder/: tests`; the longest folder decides. A header is included by one of its tests,
unless golden cases or a script hold it.
"""
from tree import DOORS, INCLUDE, SOURCE, finish, headers, reached

TESTS = SOURCE / "tests"
wrong, lines = [], {}
for line in (TESTS / "held_by.txt").read_text().split("\n"):
    what, colon, by = line.partition(":")
    if colon and not line.startswith("#"):
        if what in lines:
            wrong.append(f"held_by.txt: {what} stands there twice")
        lines[what] = by.split()
names = {header.removeprefix("thermfit/"): header for header in headers()}
tests = {str(path.relative_to(TESTS)) for path in TESTS.rglob("*_test.cpp")}
used, mirroring = set(), set()
reach = {}

for what, by in lines.items():
    for test in by:
        if not (TESTS / test).exists():
            wrong.append(f"held_by.txt: no tests/{test}")
        elif test.endswith(".cpp"):
            reach[test] = reached(TESTS / test)
for name, header in names.items():
    own = {name[:-4] + "_test.cpp", name[:-4] + "_slow_test.cpp"} & tests
    mirroring |= own
    if own:
        if name in lines:
            wrong.append(f"held_by.txt: {name} has its own test")
        continue
    lines_for_it = [what for what in lines if what == name or what.endswith("/") and name.startswith(what)]
    if not lines_for_it:
        wrong.append(f"{header}: no tests/{name[:-4]}_test.cpp, and no line in tests/held_by.txt")
        continue
    line = max(lines_for_it, key=len)
    used.add(line)
    if not any(not test.endswith(".cpp") or header in reach.get(test, ()) for test in lines[line]):
        wrong.append(f"held_by.txt, {line}: {' '.join(lines[line])} does not include {header}")
wrong += [f"held_by.txt: nothing is held by the line of {what}" for what in lines if what not in used]

rooms = {path.name for path in (INCLUDE / "thermfit").iterdir() if path.is_dir()}
named = {test for by in lines.values() for test in by}
for test in sorted(tests - mirroring - named):
    if test.split("/")[0] in rooms:
        wrong.append(f"tests/{test} mirrors no header and is not named in held_by.txt")
finish(wrong, f"{len(names)} headers are held by {len(mirroring | named)} tests")
