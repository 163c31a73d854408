"""documented_test.py SOURCE: Doxygen finds no public name of include/thermfit without a docstring, and no other fault."""

import pathlib
import re
import subprocess
import sys
import tempfile

source = pathlib.Path(sys.argv[1]).resolve()
library = source / "include/thermfit"
with tempfile.TemporaryDirectory() as output:
    config = (source / ".github/Doxyfile").read_text()
    config += f'\nOUTPUT_DIRECTORY = "{output}"\nGENERATE_HTML = NO\nGENERATE_XML = YES\n'
    told = subprocess.run(["doxygen", "-"], cwd=source, input=config, capture_output=True, text=True)
    documents = len(list(pathlib.Path(output).glob("xml/*.xml")))
if told.returncode != 0 or documents < 100:
    sys.exit(f"doxygen read next to nothing ({documents} documents):\n{told.stderr}")

warnings = sorted(set(line for line in told.stderr.splitlines() if line))
by_folder = {}
for warning in warnings:
    place = re.match(r"(\S+?):\d+: ", warning)
    inside = place and library in pathlib.Path(place.group(1)).parents
    folder = pathlib.Path(place.group(1)).parent.relative_to(library).as_posix() if inside else "Doxyfile"
    by_folder.setdefault(folder, []).append(warning)
for folder, lines in sorted(by_folder.items()):
    print(f"{folder}: {len(lines)}")
sys.exit("\n".join(warnings) if warnings else 0)
