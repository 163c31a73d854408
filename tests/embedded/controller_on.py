"""controller_on.py THERMFIT MODEL SOURCE_DIR CORE…: builds the controller for each core and judges it.

CORE is host, cortex-m0, cortex-m4 or cortex-m7. The object must not ask for heap, exceptions or run-time types; the
random walk must give the same bits everywhere. Prints sizes, stack and hashes.
"""

import json
import os
import re
import subprocess
import sys
import tempfile

thermfit, model, source = sys.argv[1:4]
here = os.path.join(source, "tests", "embedded")
work = tempfile.mkdtemp()
STEPS = 100000
COMMON = ["-O2", "-Wall", "-Wextra", "-pedantic", "-ffp-contract=off", "-ffunction-sections", "-I", work, "-I",
          os.path.join(source, "include"), "-I", os.path.join(source, "tests"), "-DWALK_STEPS=%d" % STEPS]
CPP = ["-std=c++17", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics", "-Wdouble-promotion"]
C = ["-std=c99", "-Wdouble-promotion"]
CORES = {
    "cortex-m0": (["-mcpu=cortex-m0", "-mfloat-abi=soft"], "microbit"),
    "cortex-m4": (["-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"], "mps2-an386"),
    "cortex-m7": (["-mcpu=cortex-m7", "-mfpu=fpv5-d16", "-mfloat-abi=hard"], "mps2-an500"),
}
TRANSFER = json.load(open(model))["method"] == "transfer"
COMMON += ["-DWALK_TRANSFER"] if TRANSFER else []
FORBIDDEN = re.compile(r"malloc|calloc|realloc|free|_Zn[wa]|_Zd[la]|__cxa|_Unwind|__gxx|_ZTI|_ZTS|_ZTV|__dynamic_cast|"
                       r"terminate|_ZSt\d+__throw|abort|_sbrk")


def call(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, **options).stdout


for scalar, zero in [("float", ["--zero", "first"]), ("double", [])]:
    for target, suffix in [("cpp", "hpp"), ("c", "h")]:
        call(thermfit, "export", model, "--target", target, "--scalar", scalar, "--name", "walk_" + scalar, "--clamp", 14,
             "--slew", 0.7, "--hold-timeout", 15, "--domain", "shrink", *zero, *(["--probe"] if TRANSFER else []), "-o", os.path.join(work, "walk_%s.%s" % (scalar, suffix)))


def build(core):
    prefix, flags = ("", []) if core == "host" else ("arm-none-eabi-", ["-mthumb"] + CORES[core][0])
    made = lambda name: os.path.join(work, core + "-" + name)
    compile_cpp = [prefix + "g++"] + CPP + COMMON + flags
    call(*compile_cpp, "-fstack-usage", "-c", os.path.join(here, "unit.cpp"), "-o", made("unit.o"))
    undefined = call(prefix + "nm", "-u", made("unit.o")).split()[1::2]
    bad = [symbol for symbol in undefined if FORBIDDEN.search(symbol)]
    assert not bad, "%s: the object asks for %s" % (core, bad)
    sizes = call(prefix + "size", made("unit.o")).splitlines()[1].split()
    stack = max(int(line.split("\t")[1]) for line in open(made("unit.su")))
    print("%-9s C++ .text %5s  .data+.bss %4d  stack %4d bytes  undefined: %s" %
          (core, sizes[0], int(sizes[1]) + int(sizes[2]), stack, " ".join(undefined)))
    call(prefix + "gcc", *C, *COMMON, *flags, "-fstack-usage", "-c", os.path.join(here, "walk_c.c"), "-o", made("walk_c.o"))
    assert not [s for s in call(prefix + "nm", "-u", made("walk_c.o")).split()[1::2] if FORBIDDEN.search(s)]
    sizes = call(prefix + "size", "-A", made("walk_c.o"))
    float_text = sum(int(n) for n in re.findall(r"^\.text\.walk_float(?!\w*self_test)\S* +(\d+)", sizes, re.M))
    stack = max(int(line.split("\t")[1]) for line in open(made("walk_c.su")) if "float" in line and "self_test" not in line)
    print("%-9s C   .text %5d                   stack %4d bytes" % (core, float_text, stack))
    sources = [os.path.join(here, "walk.cpp"), os.path.join(here, "host.cpp" if core == "host" else "startup.cpp")]
    link = [] if core == "host" else ["-nostartfiles", "-T", os.path.join(here, "cortex_m.ld"), "--specs=nosys.specs",
                                      "-Wl,--gc-sections"]
    call(*compile_cpp, *sources, made("walk_c.o"), *link, "-lm", "-o", made("walk"))
    if core == "host":
        return call(made("walk"))
    return call("qemu-system-arm", "-M", CORES[core][1], "-display", "none", "-serial", "none", "-monitor", "none",
                "-chardev", "stdio,id=out", "-semihosting-config", "enable=on,target=native,chardev=out", "-kernel",
                made("walk"), timeout=600, stdin=subprocess.DEVNULL)


expected = build("host")
print(expected, end="")
lines = expected.splitlines()
assert lines[0].split()[-1] == lines[1].split()[-1], "C and C++ differ in float"
assert lines[2].split()[-1] == lines[3].split()[-1], "C and C++ differ in double"
assert lines[-1] == "self tests passed"
for core in sys.argv[4:]:
    if core == "host":
        continue
    got = build(core)
    print("%s: %s" % (core, "same bits over %d steps, self tests passed" % STEPS if got == expected else got))
    assert got == expected
