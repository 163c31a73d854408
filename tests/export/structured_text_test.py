"""structured_text_test.py THERMFIT MODEL: exported function blocks do what `thermfit run` does, and notice when not."""

import json
import subprocess
import sys
import tempfile

import numpy

import readings
import structured_text

thermfit, model = sys.argv[1:]

def export(*options):
    return subprocess.run([thermfit, "export", model, "--target", "st", *options], capture_output=True, text=True,
                          check=True).stdout


def self_test(blocks):
    """Runs the test block; 0 or the number of the first vector that went wrong, and how many cycles it took."""
    tester = blocks["thermal_test"]()
    cycles = 0
    with numpy.errstate(over="ignore", under="ignore"):
        while not tester.done:
            tester()
            cycles += 1
    return tester.failed, cycles


def differences(block, rows, expected):
    device = block()
    wrong = 0
    for row, (offsets, status) in zip(rows, expected):
        device(Enable=True, **{"Temperature_" + name: value for name, value in zip(readings.SENSORS, row)})
        wrong += [device.offset_x_um, device.offset_z_um] != offsets or device.status != status
    return wrong


options = ["--domain", "shrink", "--hold-timeout", "40"]
compensator, tester = (export(*options).replace("FUNCTION_BLOCK thermal_test", "\0FUNCTION_BLOCK thermal_test").split("\0"))
blocks = structured_text.load(compensator)
block = blocks["thermal"]
blocks = structured_text.load(tester, blocks)  # blark takes time: each text is read once
failed, cycles = self_test(blocks)
print("double: test block failed at vector %d after %d cycles" % (failed, cycles))
assert failed == 0 and cycles > 500

rows = readings.readings(3000)
wrong = differences(block, rows, readings.run(thermfit, model, rows, *options))
print("3000 rows with faults: %d differ in a bit of offset or status" % wrong)
assert wrong == 0

free = ["--slew", "1e6", "--clamp", "1e5", "--domain", "ignore"]
batch = readings.readings(500, seed=4, faults=False)
with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
    file.write(readings.as_csv(batch))
    file.flush()
    answer = subprocess.run([thermfit, "predict", model, file.name, "--json"], capture_output=True, text=True, check=True)
predicted = json.loads(answer.stdout)["batches"][0]["predicted_um"]
device = structured_text.load(export(*free).split("FUNCTION_BLOCK thermal_test")[0])["thermal"]()
worst = 0
for row, expected in zip(batch, predicted):
    device(Enable=True, **{"Temperature_" + name: value for name, value in zip(readings.SENSORS, row)})
    worst = max(worst, abs(device.offset_x_um + expected[0]), abs(device.offset_z_um + expected[1]))
print("500 rows against thermfit predict: largest difference %.1e um" % worst)
assert worst < 1e-12

broken = compensator.replace("demand2 := demand2 + 2.0 * s1_value", "demand2 := demand2 + 2.001 * s1_value", 1)
assert broken != compensator
block.__call__ = structured_text.load(broken)["thermal"].__call__
failed, _ = self_test(blocks)
print("a coefficient changed by 0.05 %%: test block failed at vector %d" % failed)
assert failed > 0

failed, _ = self_test(structured_text.load(export("--scalar", "float", *options)))
print("float: test block failed at vector %d" % failed)
assert failed == 0
