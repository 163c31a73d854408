"""workflow_test.py SOURCE: .github/workflows is what GitHub takes, and every command in it is one the tree has."""

import json
import pathlib
import re
import subprocess
import sys

import yaml

source = pathlib.Path(sys.argv[1]).resolve()
tools = pathlib.Path(sys.executable).parent
workflows = sorted((source / ".github/workflows").glob("*.yml"))
wrong = []


def lint(*command):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if result.returncode != 0:
        wrong.append(result.stdout + result.stderr)


def cells(matrix):
    """The combinations of a matrix with axes and `exclude`."""
    axes = {key: values for key, values in matrix.items() if key not in ("include", "exclude")}
    combinations = [{}]
    for key, values in axes.items():
        combinations = [{**one, key: value} for one in combinations for value in values]
    excluded = matrix.get("exclude", [])
    return [one for one in combinations if not any(all(one[k] == v for k, v in e.items()) for e in excluded)]


lint(tools / "yamllint", "-s", "-c", source / ".github/yamllint.yml", source / ".github")
lint(tools / "check-jsonschema", "--builtin-schema", "vendor.github-workflows", *workflows)

presets = json.loads((source / "CMakePresets.json").read_text())
known = {kind: {one["name"] for one in presets[kind]} for kind in ("configurePresets", "buildPresets", "testPresets")}
sections = set(re.findall(r"^\[(\w+)\]", (source / "apps/packages.txt").read_text(), re.M))
commands = 0
for workflow in workflows:
    for job_name, job in yaml.safe_load(workflow.read_text())["jobs"].items():
        matrix = job.get("strategy", {}).get("matrix", {})
        for cell in cells(matrix):
            for step in job["steps"]:
                line = step.get("run", "")
                for expression in re.findall(r"\${{\s*matrix\.(\w+)\s*}}", line):
                    if expression not in cell:
                        wrong.append(f"{job_name}: '{line}' names matrix.{expression}")
                line = re.sub(r"\${{\s*matrix\.(\w+)\s*}}", lambda m: str(cell.get(m.group(1))), line)
                kind = {"cmake --preset": "configurePresets", "cmake --build": "buildPresets", "ctest": "testPresets"}
                for start, presets_of in kind.items():
                    preset = re.search(r"--preset (\S+)", line)
                    if line.startswith(start) and (not preset or preset.group(1) not in known[presets_of]):
                        wrong.append(f"{job_name}: no preset for '{line}'")
                for word in re.findall(r"(?<![\w/.-])(?:apps|tests)/[\w/.-]+", line):
                    if not (source / word).is_file():
                        wrong.append(f"{job_name}: '{word}' is not in the tree")
                if "install_packages.sh" in line:
                    for section in line.split("install_packages.sh")[1].split():
                        if section not in sections:
                            wrong.append(f"{job_name}: apps/packages.txt has no section [{section}]")
                commands += bool(line)

print(f"{len(workflows)} workflow, {commands} commands, {len(wrong)} wrong")
if not commands:
    wrong.append("no commands were found")
sys.exit("\n".join(wrong) if wrong else 0)
