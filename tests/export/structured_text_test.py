"""structured_text_test.py THERMFIT MODEL ABSOLUTE_MODEL TRANSFER_MODEL COMPENSATOR_ANSWERS: exported function blocks do what the C++
compensator does, over power cycles too, and notice when not."""

import json
import math
import random
import subprocess
import sys
import tempfile

import numpy

import readings
import structured_text

thermfit, model, absolute, transfer, truth = sys.argv[1:]
numpy.seterr(all="ignore")
STATES = "off,starting,tracking,substituting,holding,fallback,stopping,no datum".split(",")
OFF, STARTING, TRACKING, SUBSTITUTING, HOLDING, FALLBACK, STOPPING, NO_DATUM = range(8)
NONE, FIRST, DATUM, RETAINED = range(4)


def export(model, *options):
    """The function block and its test, apart."""
    text = subprocess.run([thermfit, "export", model, "--target", "st", *options], capture_output=True, text=True,
                          check=True).stdout
    compensator, tester = text.split("FUNCTION_BLOCK thermal_test")
    return compensator, "FUNCTION_BLOCK thermal_test" + tester


def self_test(blocks, zero_left_behind=False):
    """Runs the test block; 0 or the number of the first vector that went wrong, and how many cycles it took. There may
    be a zero that a test before has retained, broken off by a power cut."""
    tester = blocks["thermal_test"]()
    if zero_left_behind:
        for _ in range(40):
            tester()
        assert tester.device.zero_mark > 0
        tester = structured_text.after_power_cycle(tester)
    cycles = 0
    while not tester.done:
        tester()
        cycles += 1
    return tester.failed, cycles


class Machine:
    """A block on a controller: calls it, cuts its power, and writes down the same for the C++ compensator."""

    def __init__(self, block, scalar=float):
        self.device, self.scalar = block(), scalar
        self.lines, self.answers = [], []
        self.enable, self.heartbeat, self.off = True, 0, {}

    def call(self, row, datum=False, periods=1, probed=None):
        """`probed`: an error, by number, and what a probe reads of it."""
        probe = {}
        if probed is not None:
            self.lines.append("probe %d %r" % probed)
            name = "XZ"[probed[0]]
            probe = {"Probe_" + name: self.scalar(probed[1]), "Probe_%s_new" % name: True}
            other = "ZX"[probed[0]]
            probe["Probe_%s_new" % other] = False
        elif hasattr(self.device, "probe_x_new"):
            probe = {"Probe_X_new": False, "Probe_Z_new": False}
        self.lines.append("%d %d %d %d %s" % (self.enable, datum, self.heartbeat, periods, " ".join(map(repr, row))))
        self.device(Enable=self.enable, Datum=datum, Heartbeat=self.heartbeat, Periods=periods, **probe, **self.off,
                    **{"Temperature_" + name: self.scalar(value) for name, value in zip(readings.SENSORS, row)})
        self.answers.append([float(self.device.offset_x_um), float(self.device.offset_z_um), self.device.status])

    def power_cycle(self, torn=None, foreign=False, off=None):
        if hasattr(self.device, "off_periods"):
            self.off = {"Off_periods": 4294967295 if off is None else off}
        self.device = structured_text.after_power_cycle(self.device)
        self.lines.append("foreign" if foreign else "cut %d %r" % torn if torn else "power" if off is None else "off %d" % off)
        if torn:
            self.device.set(self.device, "s%d_zero" % (torn[0] + 1), self.scalar(torn[1]))
        if foreign:
            self.device.zero_model ^= 1

    def wrong(self, model, *options):
        """How many answers differ from those of the C++ compensator in a bit; the first one is shown."""
        out = subprocess.run([truth, "double" if self.scalar is float else "float", model, *options], text=True,
                             input="\n".join(self.lines) + "\n", capture_output=True, check=True).stdout.splitlines()
        expected = [[float(x) for x in line.split()[:-1]] + [int(line.split()[-1])] for line in out]
        assert len(expected) == len(self.answers)
        differ = [k for k, pair in enumerate(zip(self.answers, expected)) if pair[0] != pair[1]]
        if differ:
            calls = [line for line in self.lines if line[0] in "01" and line[:3] != "off"]
            print("call", differ[0], calls[differ[0]], self.answers[differ[0]], "C++:", expected[differ[0]])
        return len(differ)


class Cases:
    """What can happen at and after power-up, told in one line each."""

    def __init__(self, machine):
        self.machine = machine
        self.rows = readings.readings(20000, seed=2, faults=False)
        self.now = 0

    def run(self, calls, first_datum=False, dead=(), **how):
        for n in range(calls):
            row = self.rows[self.now]
            self.now += 1
            self.machine.call([math.nan if i in dead else x for i, x in enumerate(row)], first_datum and n == 0, **how)

    def tell(self, name, state, source, fault=0):
        d = self.machine.device
        print("  %-46s X %9.4f um, Z %9.4f um, %-12s status 0x%08x" % (name + ":", d.offset_x_um, d.offset_z_um,
                                                                      STATES[d.state_now], d.status))
        assert (d.state_now, d.zero_source, d.fault) == (state, source, fault), (d.state_now, d.zero_source, d.fault)
        assert d.status % 16 == state and d.status >> 28 & 3 == source and d.status >> 30 == d.zero_pending
        assert not d.ok or state == TRACKING
        return d.offset_x_um, d.offset_z_um

    def all(self):
        m = self.machine
        self.run(10)
        assert self.tell("cold, no zero was ever taken", NO_DATUM, NONE) == (0, 0)
        self.run(1, first_datum=True)
        assert m.device.zero_pending
        self.run(10)
        self.tell("datum", TRACKING, DATUM)
        self.run(900)
        warm = self.tell("900 s later", TRACKING, DATUM)
        m.power_cycle()
        self.run(60)
        again = self.tell("warm, power cycle", TRACKING, RETAINED)
        assert all(abs(a - b) < 1 for a, b in zip(warm, again))
        m.power_cycle()
        self.run(3)
        self.tell("and one more", TRACKING, RETAINED)
        m.enable = False
        self.run(100)
        assert self.tell("Enable off", OFF, NONE) == (0, 0)
        m.enable = True
        self.run(60)
        self.tell("Enable on", TRACKING, RETAINED)
        m.power_cycle()
        self.run(60, dead=[0])
        self.tell("warm, sensor 1 dead at power-up", SUBSTITUTING, RETAINED, 1)
        m.power_cycle()
        self.run(10, dead=[2])
        self.tell("warm, sensor 3 dead, no substitute", STARTING, RETAINED, 1)
        self.run(60)
        self.tell("it reads again", TRACKING, RETAINED)
        m.power_cycle(torn=(1, 25.0))
        self.run(10)
        assert self.tell("warm, a retained value changed", NO_DATUM, NONE) == (0, 0)
        self.run(10, first_datum=True)
        m.power_cycle(foreign=True)
        self.run(10)
        self.tell("warm, another model's zero", NO_DATUM, NONE)
        self.run(10, first_datum=True)
        self.tell("datum", TRACKING, DATUM)
        m.enable = False
        self.run(60)
        self.run(2, first_datum=True)
        m.enable = True
        self.run(10)
        self.tell("datum while off forgets", NO_DATUM, NONE)
        self.run(70, first_datum=True, dead=[0])
        self.tell("datum without sensor 1", SUBSTITUTING, DATUM, 1)
        self.run(60)
        self.tell("sensor 1 is back, has no zero", SUBSTITUTING, DATUM, 6)
        m.power_cycle()
        self.run(60)
        self.tell("nor after a power cycle", SUBSTITUTING, RETAINED, 6)
        self.run(60, first_datum=True)
        self.tell("datum with all", TRACKING, DATUM)
        before = m.answers[-1]
        self.run(5, periods=0)
        assert m.answers[-1] == before
        self.tell("burst: Periods 0, nothing moves", TRACKING, DATUM)
        self.run(20, dead=[0])
        self.run(1, periods=100)
        self.tell("late call: Periods 100", TRACKING, DATUM)
        self.run(3, periods=4000000000)
        self.tell("very late calls: Periods 4e9", TRACKING, DATUM)
        for m.heartbeat in range(1, 20):
            self.run(1)
        self.tell("heartbeat", TRACKING, DATUM)
        self.run(10)
        self.tell("heartbeat stopped", HOLDING, DATUM, 7)
        self.run(60)
        self.tell("for longer than the hold time-out", FALLBACK, DATUM, 7)
        for m.heartbeat in range(20, 80):
            self.run(1)
        self.tell("heartbeat again", TRACKING, DATUM)
        for m.heartbeat in range(80, 2200):
            m.call(self.rows[self.now])
        self.tell("all frozen", FALLBACK, DATUM, 4)


def random_course(machine, rows, seed):
    """Faulty readings, and now and then a datum, a switch, a power cycle, a call that is late or too many."""
    source = random.Random(seed)
    datum, beats, probed = False, False, None
    for row in rows:
        luck = source.random()
        if luck < 0.003:
            machine.power_cycle(*source.choice([[], [], [], [(0, 25.0)], [None, True]]) if not machine.off else
                                source.choice([[], [(0, 25.0)], [None, False, 0], [None, False, 40], [None, False, 20000]]))
            machine.heartbeat, beats = 0, source.random() < 0.5
        elif luck < 0.006 or not machine.enable and luck < 0.1:
            machine.enable = not machine.enable
        datum = source.random() < (0.5 if datum else 0.01)
        machine.heartbeat += 1 if beats and source.random() < 0.7 else 0
        probed, read_before = None, probed
        if hasattr(machine.device, "probe_x_new") and read_before is None and source.random() < 0.05:
            wild = source.choice([1, 1, 1, 5, 1e300])
            probed = (source.randrange(2), source.uniform(-3, 3) * wild - float(machine.device.offset_z_um))
            if source.random() < 0.05:
                probed = (probed[0], math.nan)
        machine.call(row, datum, source.choice([1] * 60 + [0, 0, 2, 7, 100]), probed)


def check(title, model, *options, scalar=float, cases=False):
    compensator, tester = export(model, *options)
    numbers = ["--scalar", "float"] if scalar is numpy.float32 else []
    course = [o for o in options if o not in numbers + ["--probe"]]
    blocks = structured_text.load(compensator)  # blark takes time: each text is read once
    blocks = structured_text.load(tester, blocks)
    failed, cycles = self_test(blocks, zero_left_behind=cases)
    print("%s: test block failed at vector %d after %d cycles" % (title, failed, cycles))
    assert failed == 0 and cycles > 500
    if cases:
        machine = Machine(blocks["thermal"], scalar)
        Cases(machine).all()
        wrong = machine.wrong(model, *course)
        print("%s: %d of these %d answers differ from the C++ compensator's" % (title, wrong, len(machine.answers)))
        assert wrong == 0
    machine = Machine(blocks["thermal"], scalar)
    if hasattr(machine.device, "off_periods"):
        machine.off = {"Off_periods": 4294967295}
    random_course(machine, readings.readings(4000, seed=7), seed=3)
    wrong = machine.wrong(model, *course)
    met = {a[-1] % 16 for a in machine.answers}
    faults = {a[-1] >> 16 & 15 for a in machine.answers}
    print("%s: %d of %d answers of a random course differ; states %s, faults %s, %d power cycles" %
          (title, wrong, len(machine.answers), sorted(met), sorted(faults), sum(line[:3] in ("pow", "off", "cut", "for") for line in machine.lines)))
    assert wrong == 0 and len(met) > 5
    return compensator, blocks


options = ["--domain", "shrink", "--hold-timeout", "40"]
compensator, blocks = check("double", model, *options, cases=True)

broken = compensator.replace("demand2 := demand2 + 2.0 * s1_value", "demand2 := demand2 + 2.001 * s1_value")
assert broken != compensator
blocks["thermal"].__call__ = structured_text.load(broken)["thermal"].__call__
failed, _ = self_test(blocks)
print("a coefficient changed by 0.05 %%: test block failed at vector %d" % failed)
assert failed > 0

first = ["--zero", "first", "--domain", "hold", "--hold-timeout", "20"]
_, blocks = check("a first zero", model, *first)
rows = readings.readings(3000)
device, wrong = blocks["thermal"](), 0
for row, (offsets, status) in zip(rows, readings.run(thermfit, model, rows, *first)):
    device(Enable=True, **{"Temperature_" + name: value for name, value in zip(readings.SENSORS, row)})
    wrong += [device.offset_x_um, device.offset_z_um] != offsets or device.status != status
print("3000 rows with faults: %d differ from thermfit run in a bit of offset or status" % wrong)
assert wrong == 0

free = ["--slew", "1e6", "--clamp", "1e5", "--domain", "ignore", "--zero", "first"]
batch = readings.readings(500, seed=4, faults=False)
batch = batch[:1] * 5 + batch  # predict counts from the first sample, a zero is the median of five
with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
    file.write(readings.as_csv(batch))
    file.flush()
    answer = subprocess.run([thermfit, "predict", model, file.name, "--json"], capture_output=True, text=True, check=True)
predicted = json.loads(answer.stdout)["batches"][0]["predicted_um"]
device = structured_text.load(export(model, *free)[0])["thermal"]()
worst = 0
for n, (row, expected) in enumerate(zip(batch, predicted)):
    device(Enable=True, **{"Temperature_" + name: value for name, value in zip(readings.SENSORS, row)})
    if n >= 5:
        worst = max(worst, abs(device.offset_x_um + expected[0]), abs(device.offset_z_um + expected[1]))
print("500 rows against thermfit predict: largest difference %.1e um" % worst)
assert worst < 1e-12

check("absolute temperatures", absolute, "--domain", "shrink", "--sign", "error", "--hold-timeout", "40")
derived = ["--domain", "shrink", "--hold-timeout", "40", "--probe", "--probe-age", "3"]
check("derived channels and a probe", transfer, *derived)
check("the same in float", transfer, "--scalar", "float", *derived, scalar=numpy.float32)
check("float", model, "--scalar", "float", *options, scalar=numpy.float32)
