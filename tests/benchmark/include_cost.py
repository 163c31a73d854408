"""include_cost.py SOURCE [COMPILER] [--require DOOR=RATIO …]: what it costs to come in.

Prints the parse time of each door as a ratio to that of Eigen/Dense (user time, the best of three, the same run), the
compilation of README's program at -O2, and that of the dear files of the command. With --require only the doors named
are measured, and a ratio above the one given is a failure.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

LIMITS = {"thermfit": 4, "regression": 2, "study": None, "simulation": None, "diagnosis": None, "controller": .2}


def cost(command, times=1):
    """User seconds (the best of several) and peak MB of a command and what it starts."""
    seconds = []
    for _ in range(times):
        child = subprocess.Popen(command)
        _, status, usage = os.wait4(child.pid, 0)
        if status:
            sys.exit("failed: " + " ".join(command))
        seconds.append(usage.ru_utime)
    return min(seconds), usage.ru_maxrss / 1024


arguments = sys.argv[1:]
required = {}
if "--require" in arguments:
    at = arguments.index("--require")
    required = {name: float(limit) for name, limit in (one.split("=") for one in arguments[at + 1:])}
    arguments = arguments[:at]
source = pathlib.Path(arguments[0]).resolve()
compiler = arguments[1] if len(arguments) > 1 else "g++"
eigen = subprocess.run(["pkg-config", "--cflags", "eigen3"], capture_output=True, text=True).stdout.split()
common = [compiler, "-std=c++17", f"-I{source}/include", f"-I{source}/src", *eigen]

wrong = []
with tempfile.TemporaryDirectory() as scratch:
    def parse(header):
        file = pathlib.Path(scratch) / "one.cpp"
        file.write_text(f'#include "{header}"\n')
        return cost([*common, "-fsyntax-only", str(file)], 3)

    base, megabytes = parse("Eigen/Dense")
    print(f"{'Eigen/Dense':40}{base:7.2f} s {megabytes:6.0f} MB")
    for door, limit in LIMITS.items():
        if required and door not in required:
            continue
        seconds, megabytes = parse(f"thermfit/{door}.hpp")
        wanted = "" if limit is None else f"  wanted: {limit}"
        print(f"{'thermfit/' + door + '.hpp':40}{seconds:7.2f} s {megabytes:6.0f} MB {seconds / base:5.2f} x{wanted}")
        if seconds / base > required.get(door, 1e9):
            wrong.append(f"thermfit/{door}.hpp costs {seconds / base:.2f} x Eigen/Dense, allowed {required[door]}")
    if not required:
        output = ["-c", "-o", f"{scratch}/one.o"]
        dear = sorted(str(file.relative_to(source)) for file in source.glob("src/compiled/*.cpp"))
        largest = 0, ""
        for name, options, wanted in [("apps/examples/quick_start.cpp", ["-O2"], "  wanted: 6 s, 500 MB"),
                                      *((file, ["-O3", "-DTHERMFIT_COMPILED=1", "-DNDEBUG"], "")
                                        for file in [*dear, "src/commands/diagnose.cpp", "src/commands/study.cpp"])]:
            seconds, megabytes = cost([*common, *options, str(source / name), *output])
            print(f"{name:40}{seconds:7.2f} s {megabytes:6.0f} MB {options[0]}{wanted}")
            if wanted == "":
                largest = max(largest, (megabytes, name))
        print(f"the largest compilation of the command: {largest[0]:.0f} MB, {largest[1]}")
print("\n".join(wrong), end="")
sys.exit(bool(wrong))
