"""arrows_test.py SOURCE: includes follow the arrows that README draws, and no folders include each other in a circle.

README's table of arrows has a line a room, `room -> rooms it stands on | what it holds`, the highest first. A room may
include what it names and what those stand on. `library` is every room below the line.
"""
import pathlib

from tree import INCLUDE, SOURCE, finish, includes

wrong, names = [], {}
for line in (SOURCE / "README.md").read_text().split("```text\n"):
    if "->" not in line.split("\n")[0]:
        continue
    for row in line.split("```")[0].strip().split("\n"):
        room, _, rest = row.partition("->")
        names[room.strip()] = rest.split("|")[0].split()
order = list(names)
if not names:
    wrong.append("README draws no arrows")

# Arrows go down only, so there are no circles of rooms.
may = {}
for room in reversed(order):
    may[room] = set()
    for below in names[room]:
        if below == "library":
            may[room] |= {other for other in may if not other.startswith("src/")}
        elif below not in may:
            wrong.append(f"README: {room} -> {below} does not go down")
        else:
            may[room] |= {below} | may[below]


def room_of(folder, prefix):
    return prefix + folder.parts[0] if folder.parts else ""


def look(root, prefix, strip):
    """Adds what is wrong below root, whose rooms are called prefix + folder and included as strip + folder."""
    circles = {}
    folders = {prefix + path.name for path in root.iterdir() if path.is_dir() and any(path.rglob("*.?pp"))}
    for room in sorted(folders - set(order)):
        wrong.append(f"{room}/ is not in README's table of arrows")
    for path in sorted([*root.rglob("*.hpp"), *root.rglob("*.cpp")]):
        at = path.relative_to(root)
        room = room_of(at.parent, prefix)
        if not room:
            continue  # doors and what stands below every room
        for name in includes(path):
            to = pathlib.PurePath(name)
            own = prefix == "" or to.parts[0] != "thermfit"
            target = room_of(pathlib.PurePath(*to.parts[1:-1]), "") if to.parts[0] == "thermfit" else prefix + to.parts[0]
            if target and target != room and target not in may.get(room, set()):
                wrong.append(f"{path.relative_to(SOURCE)} includes {name}: no arrow from {room} to {target}")
            if own and target == room:
                inside = to.parts[len(strip):-1]
                circles.setdefault(at.parent.parts, {}).setdefault(inside, f"{at} includes {name}")
        if not prefix and room != "io":
            for foreign in ("iostream", "cstdio", "fstream", "nlohmann/json.hpp"):
                if f"#include <{foreign}>" in path.read_text():
                    wrong.append(f"{at} includes <{foreign}>: only io/ reads, writes or prints")
    # Folders inside a room: none reaches itself by way of another. What stands in the room itself is its door or its
    # ground, and impl/ belongs to the folder that holds it.
    def inner(parts):
        return tuple(part for part in parts if part != "impl")
    graph = {}
    for a, targets in circles.items():
        for b, why in targets.items():
            if inner(a) != inner(b) and len(inner(a)) > 1 and len(inner(b)) > 1:
                graph.setdefault(inner(a), {})[inner(b)] = why

    def walk(start, here, trail):
        for to, why in graph.get(here, {}).items():
            if to == start:
                wrong.append("a circle of folders: " + "; ".join(trail + [why]))
            elif len(trail) < 8 and to > start:
                walk(start, to, trail + [why])

    for start in sorted(graph):
        walk(start, start, [])


look(INCLUDE / "thermfit", "", ("thermfit",))
look(SOURCE / "src", "src/", ())
finish(wrong, f"{len(order)} rooms, arrows go down only")
