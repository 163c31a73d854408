"""c_header_test.py THERMFIT MODEL: the C export compiles without a warning, passes its own vectors to the last bit, and
has no finding of cppcheck with the MISRA addon but those listed here."""

import os
import re
import shutil
import subprocess
import sys
import tempfile

thermfit, model = sys.argv[1:]
work = tempfile.mkdtemp()
DEVIATIONS = {
    "misra-c2012-2.5": "macros for the caller to take the status apart; this program does not use them all",
    "misra-c2012-8.9": "the model's constants stand together at the top, not in the one function that reads each",
}
USER = """#include "thermal.h"
static thermal_compensator device;
static thermal_retained kept;
int main(void) {
  const thermal_real readings[THERMAL_SENSORS] = {20.0F, 20.0F, 20.0F};
  thermal_real offset[THERMAL_ERRORS];
  thermal_initialise(&device);
  thermal_resume(&device, &kept, NULL);
  (void)thermal_step(&device, readings, offset);
  thermal_datum(&device);
  (void)thermal_step_after(&device, readings, 2U, 1U, offset);
  thermal_retain(&device, &kept);
  thermal_stop(&device);
  return 0;
}
"""
SELF_TEST = """#define THERMAL_SELF_TEST
#define THERMAL_SELF_TEST_TOLERANCE %s
#include "thermal.h"
int main(void) { return (int)thermal_self_test(); }
"""


def write(name, text):
    path = os.path.join(work, name)
    open(path, "w").write(text)
    return path


def compiled(text, *flags):
    program = os.path.join(work, "program")
    subprocess.run(["cc", "-std=c99", "-Wall", "-Wextra", "-Wdouble-promotion", "-pedantic", "-Wconversion", "-Werror", "-O2",
                    *flags, write("program.c", text), "-o", program, "-lm"], check=True)
    return subprocess.run([program]).returncode


for scalar in ["float", "double"]:
    tolerance = "1e-3F" if scalar == "float" else "1e-9"
    for options in [[], ["--domain", "hold", "--sign", "error", "--zero", "first"],
                    ["--domain", "shrink", "--hold-timeout", "0", "--unit", "mm", "--zero", "first", "--through-zero"],
                    ["--domain", "ignore", "--stale-after", "1"]]:
        header = subprocess.run([thermfit, "export", model, "--target", "c", "--scalar", scalar, *options], check=True,
                                capture_output=True, text=True).stdout
        write("thermal.h", header)
        assert compiled(SELF_TEST % "0", "-ffp-contract=off") == 0
        assert compiled(SELF_TEST % tolerance, "-march=native") == 0
    broken = re.sub(r"(_slew_um_per_step\[.*\{)(\d)", r"\g<1>1\2", header)
    assert broken != header
    write("thermal.h", broken)
    assert compiled(SELF_TEST % tolerance) != 0, "the self-test does not see a slew limit that was changed"
    write("thermal.h", header)
    print("with -ffast-math:")
    try:
        compiled(USER, "-ffast-math")
        raise SystemExit("compiled with -ffast-math")
    except subprocess.CalledProcessError:
        pass
    print(scalar, len(header), "bytes: no warning, self-test passed, -ffast-math refused")

if not shutil.which("cppcheck"):
    print("skipped: no cppcheck")
    sys.exit(0)
report = subprocess.run(["cppcheck", "--std=c99", "--addon=misra", "--enable=all", "--suppress=missingIncludeSystem",
                         "--template={id}:{file}:{line}: {message}", write("user.c", USER)], capture_output=True, text=True).stderr
found = [line for line in report.splitlines() if re.match(r"[\w.-]+:.*:\d+: ", line)]
for rule, reason in DEVIATIONS.items():
    count = sum(line.startswith(rule + ":") for line in found)
    print("%s: %d times, %s" % (rule, count, reason))
    assert count > 0, "a deviation that is no longer needed"
others = [line for line in found if line.split(":")[0] not in DEVIATIONS]
print("other findings:", others)
assert not others
