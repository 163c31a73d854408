"""The exported LinuxCNC component as a plain C program: HAL's pins are variables."""

import re
import subprocess

SHIM = """#include <stdbool.h>
#include <math.h>
#include <float.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
typedef volatile double hal_float_t;
typedef volatile int32_t hal_s32_t;
typedef volatile uint32_t hal_u32_t;
typedef volatile bool hal_bit_t;
struct __comp_state {
%s};
"""

PINS = """
#define PIN(type, name) static hal_##type##_t pin_##name;
%s
static struct __comp_state hal = {%s};
"""


def build(component, main, path):
    """Compiles `component`, the text of a .comp, with `main` in C, which calls component(&hal, period_ns) and knows each
    pin as pin_<name>; returns the program's path."""
    pins = [(kind, name.replace("-", "_")) for kind, name in re.findall(r"^pin \w+ (\w+) ([\w-]+)(?: = \w+)? ", component, re.M)]
    body = component.split("\n;;\n", 1)[1].replace(
        "FUNCTION(_) {", "static void component(struct __comp_state *__comp_inst, long period) {")
    body = re.sub(r"#define FUNCTION.*\n", "", body)
    members = "".join("  hal_%s_t *%s;\n" % pin for pin in pins) + "  double counts_scale;\n"
    variables = PINS % ("\n".join("PIN(%s, %s)" % pin for pin in pins),
                        ", ".join("&pin_" + name for _, name in pins) + ", 1e-4")
    with open(path + ".c", "w") as file:
        file.write(SHIM % members + body + variables + main)
    subprocess.run(["cc", "-std=gnu99", "-O2", "-Wall", "-Wextra", "-Wno-unused-function", "-Werror", path + ".c", "-o", path,
                    "-lm"], check=True)
    return path
