"""A fault of writing is planted, what the diagnosis says to write is written, and the diagnosis is the clean one.

usage: remedies_test.py FOLDER_OF_THERMFIT SOURCE_TREE
"""
import csv
import json
import math
import os
import re
import shlex
import subprocess
import sys
import tempfile

program, source = os.path.join(sys.argv[1], "thermfit"), sys.argv[2]
case = os.path.join(source, "data/withheld/case-05")
batches = ["K01", "K02", "K03"]
failures = []


def write(folder, side, change):
    os.makedirs(folder, exist_ok=True)
    for batch in batches:
        with open(f"{case}/{side}/{batch}.csv", newline="") as file:
            rows = list(csv.reader(file))
        names, values = rows[0], [[float(cell) for cell in row] for row in rows[1:]]
        names = change(names, values) or names
        with open(f"{folder}/{batch}.csv", "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(names)
            writer.writerows([[repr(value) for value in row] for row in values])


def scaled(columns, factor, shift=0.0):
    def change(names, values):
        for row in values:
            for k, name in enumerate(names):
                if re.fullmatch(columns, name):
                    row[k] = row[k] * factor + shift

    return change


def nothing(names, values):
    pass


def untitled(names, values):
    """A clock whose title names no unit: minutes."""
    return ["Time" if name == "time_min" else name for name in names]


def both(first, second):
    def change(names, values):
        first(names, values)
        return second(names, values)

    return change


def exchanged(names, values):
    other = list(names)
    a, b = names.index("T1"), names.index("T10")
    other[a], other[b] = names[b], names[a]
    return other


def diagnose(words):
    done = subprocess.run([program, "diagnose", "--json", "--effects", "speed-shift,sensor-offset"] + words,
                          capture_output=True, text=True, timeout=300)
    if done.returncode == 2:
        raise SystemExit(f"{words}: {done.stderr}")
    return json.loads(done.stdout)


def differs(one, other, where=""):
    """Where two documents differ by more than writing numbers down costs."""
    if isinstance(one, dict) and isinstance(other, dict):
        keys = [key for key in set(one) | set(other)]
        return [text for key in keys for text in differs(one.get(key), other.get(key), f"{where}.{key}")]
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return [text for k in range(len(one)) for text in differs(one[k], other[k], f"{where}[{k}]")]
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return [] if math.isclose(one, other, rel_tol=2e-3, abs_tol=2e-3) else [f"{where}: {one} and {other}"]
    return [] if one == other else [f"{where}: {one} and {other}"]


def options_in(remedy):
    """The options of the first way that a remedy names."""
    return shlex.split(" ".join(re.findall(r"--[a-z-]+ (?:'[^']*'|[^ ,;]+)", remedy)))


def check(what, words, clean, kind, way=0, titles=None, header=None):
    found = diagnose(words)
    certain = [one for one in found["data_problems"] if one.get("certain")]
    if not certain:
        failures.append(f"{what}: not found")
        return
    remedy = certain[0]["remedy"]
    if header:
        if header not in remedy:
            failures.append(f"{what}: {remedy}")
        return
    part = re.split(r", or |[,;] where |; else ", remedy)[way]
    options = [word.replace("TITLE", titles or "") for word in options_in(part)]
    if not options:
        failures.append(f"{what}: no option in '{part}' of '{remedy}'")
        return
    mended = diagnose(words + options)
    for text in differs(clean, mended)[:3]:
        failures.append(f"{what} with {' '.join(options)}: {text}")


with tempfile.TemporaryDirectory() as folder:
    def laid(name, side, change):
        write(f"{folder}/{name}", side, change)
        return f"{folder}/{name}"

    real, sim, machine = laid("real", "real", nothing), laid("sim", "sim", nothing), f"{case}/machine.json"
    late, early = laid("later/real", "real", untitled), laid("later/sim", "sim", untitled)
    by_outputs, by_network = diagnose(["--sim", sim, real]), diagnose([machine, real])
    mm, kelvin, turned, tenths = scaled("Z", 1e-3), scaled("T\\d+", 1, 273.15), scaled("Z", -1), scaled("T3", 10)
    fahrenheit, seconds = scaled("T7", 1.8, 32), scaled("time_min", 60)
    for name, change, way in [("mm", mm, 0), ("kelvin", kelvin, 0), ("tenths", tenths, 0), ("degF", fahrenheit, 0)]:
        wrong = laid(f"{name}/real", "real", change)
        check(f"{name} in the batches, outputs", ["--sim", sim, wrong], by_outputs, "unit", way)
        check(f"{name} in the batches, network", [machine, wrong], by_network, "unit", way)
        check(f"{name} in the simulator", ["--sim", laid(f"{name}/sim", "sim", change), real], by_outputs, "unit", way)
    wrong = laid("turned/real", "real", turned)
    check("sign of the batches, network", [machine, wrong], by_network, "sign")
    check("sign of the batches, outputs", ["--sim", sim, wrong], by_outputs, "sign", 0)
    check("sign of the simulator", ["--sim", laid("turned/sim", "sim", turned), real], by_outputs, "sign", 1)
    wrong = laid("seconds/real", "real", seconds)
    check("titled clock of the batches, network", [machine, wrong], by_network, "clock", 1, "time_min")
    check("titled clock of the batches, outputs", ["--sim", sim, wrong], by_outputs, "clock", 1, "time_min")
    check("clock of the batches, network", [machine, laid("s/real", "real", both(seconds, untitled))], by_network, "clock")
    check("clock of the simulator", ["--sim", laid("s/sim", "sim", both(seconds, untitled)), late], by_outputs, "clock")
    check("another start of the simulator", ["--sim", laid("start/sim", "sim", scaled("time_min", 1, 28e6)), real],
          by_outputs, "clock")
    wrong = laid("exchanged/real", "real", exchanged)
    for words in (["--sim", sim, wrong], [machine, wrong]):
        check("exchanged columns", words, None, "swapped", header="exchange the names T10 and T1 in the header")

if failures:
    sys.exit("\n".join(failures))
print("what the diagnosis says to write mends it")
