"""cost_on.py THERMFIT SOURCE_DIR CORE…: what a step of a model of the method transfer costs, as a ratio to a plain one on
the same sensors. CORE is host, cortex-m0, cortex-m4 or cortex-m7; instructions by qemu's -icount, nanoseconds on the host."""

import os
import re
import subprocess
import sys
import tempfile

thermfit, source = sys.argv[1:3]
here = os.path.join(source, "tests", "embedded")
work = tempfile.mkdtemp()
MOST_RATIO = 10  # features and their domain are two to three times as many columns, each squared in the domain
CORES = {
    "cortex-m0": (["-mcpu=cortex-m0", "-mfloat-abi=soft"], "mps2-an385"),  # its code, on a board with this timer
    "cortex-m4": (["-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"], "mps2-an386"),
    "cortex-m7": (["-mcpu=cortex-m7", "-mfpu=fpv5-d16", "-mfloat-abi=hard"], "mps2-an500"),
}


def call(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, **options).stdout


data = os.path.join(source, "data", "vcenter55")
for name, options in [("plain", ["--points", "all"]), ("transfer", ["--method", "transfer"])]:
    model = os.path.join(work, name + ".json")
    call(thermfit, "fit", data, "--error-reference", "start", *options, "-o", model)
    call(thermfit, "export", model, "--target", "cpp", "--scalar", "float", "--name", "cost_" + name, "-o",
         os.path.join(work, "cost_%s.hpp" % name))
    print(name, re.search(r"thermfit::Compensator<(.*)>;", open(os.path.join(work, "cost_%s.hpp" % name)).read()).group(1),
          "(sensors, errors, components, features, lags, probes)")

for core in sys.argv[3:]:
    host = core == "host"
    prefix, flags = ("", []) if host else ("arm-none-eabi-", ["-mthumb"] + CORES[core][0])
    program = os.path.join(work, core)
    link = [] if host else ["-nostartfiles", "-T", os.path.join(here, "cortex_m.ld"), "--specs=nosys.specs", "-Wl,--gc-sections"]
    call(prefix + "g++", "-std=c++17", "-O2", "-Wall", "-Wextra", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics",
         "-ffunction-sections", "-I", work, "-I", os.path.join(source, "include"), *flags, os.path.join(here, "cost.cpp"),
         os.path.join(here, "host.cpp" if host else "startup.cpp"), *link, "-lm", "-o", program)
    out = call(program) if host else call(
        "qemu-system-arm", "-M", CORES[core][1], "-display", "none", "-serial", "none", "-monitor", "none", "-icount",
        "shift=0", "-chardev", "stdio,id=out", "-semihosting-config", "enable=on,target=native,chardev=out", "-kernel", program,
        timeout=300, stdin=subprocess.DEVNULL)
    cost = {name: min(int(line.split()[1]) for line in out.splitlines() if line.startswith(name + " "))
            for name in ("plain", "transfer")}
    ratio = cost["transfer"] / cost["plain"]
    print("%-9s a step: plain %5d, transfer %5d %s, ratio %.1f" %
          (core, cost["plain"], cost["transfer"], "ns" if host else "instructions", ratio))
    assert ratio < MOST_RATIO
