"""derived_channels_test.py THERMFIT TRANSFER_MODEL COMPENSATOR_ANSWERS: a model on derived channels with a probe answers
the same through `thermfit run` and the LinuxCNC component as the C++ compensator, to the last bit, over faulty readings,
datums, late lines and a restart in the middle, whose lags go on if the time off is known and else leave no zero."""

import json
import os
import random
import subprocess
import sys
import tempfile

import hal_component
import readings

thermfit, model, truth = sys.argv[1:]
work = tempfile.mkdtemp()
OPTIONS = ["--domain", "shrink", "--hold-timeout", "40", "--slew", "0.5", "--probe-age", "2"]
OFF = 300

source = random.Random(5)
rows = readings.readings(1600, seed=11)
course = []  # (periods, datum, readings, probe of X, probe of Z)
for n, row in enumerate(rows):
    probe = [source.uniform(-4, 4) if n > 20 and source.random() < .02 else None for _ in "XZ"]
    course.append((source.choice([1] * 20 + [2, 9]), n in (5, 500, 1200), row, probe))
for first in (0, 800):
    course[first] = (1,) + course[first][1:]
parts = [course[:800], course[800:]]


def by_cpp(off):
    lines = []
    for number, part in enumerate(parts):
        if number:
            lines.append("power" if off is None else "off %d" % off)
        for periods, datum, row, probe in part:
            lines.append("1 %d 0 %d %s" % (datum, periods, " ".join(map(repr, row))))
            lines += ["probe %d %r" % (j, um) for j, um in enumerate(probe) if um is not None]
    out = subprocess.run([truth, "double", model, *OPTIONS], input="\n".join(lines) + "\n", text=True, capture_output=True,
                         check=True).stdout.splitlines()
    return [([float(w) + 0. for w in line.split()[:-1]], int(line.split()[-1])) for line in out]


def by_run(off, clock_goes_on=True):
    state = os.path.join(work, "state.json")
    if os.path.exists(state):
        os.unlink(state)
    clock, answers, told = 0, [], ""
    for number, part in enumerate(parts):
        if number:
            clock = clock + OFF if clock_goes_on else 0
        lines = ["time_s,T1,T2,T3,probe_X,probe_Z [mm]"]
        for n, (periods, datum, row, probe) in enumerate(part):
            if datum:
                lines.append("datum")
            clock += periods
            cells = ["" if x != x else repr(x) for x in row]
            mm = "" if probe[1] is None else repr(probe[1] / 1000)
            lines.append(",".join([repr(clock)] + cells + ["" if probe[0] is None else repr(probe[0]), mm]))
        more = ["--off", str(off)] if number and off is not None and not clock_goes_on else []
        done = subprocess.run([thermfit, "run", model, "--state", state, *OPTIONS, *more], text=True, check=True,
                              input="\n".join(lines) + "\n", capture_output=True)
        told += done.stderr
        offsets = [line.split(",") for line in done.stdout.splitlines()[1:]]
        answers += [([float(c[1]), float(c[2])], int(c[4])) for c, line in zip(offsets, lines[1:]) if line != "datum"]
    return answers, told


MAIN = """
static void run(double periods) { component(&hal, (long)(periods * 1e9)); pin_applied_x = pin_offset_x, pin_applied_z = pin_offset_z; }
static double next_number(void) { char word[40]; return scanf("%39s", word) == 1 && strcmp(word, "-") != 0 ? atof(word) : NAN; }
int main(void) {
  char word[20];
  pin_machine_on = pin_homed = pin_eoffset_enabled = true;
  pin_set_off = NAN;
  pin_temperature_t1 = pin_temperature_t2 = pin_temperature_t3 = NAN;
  run(1);
  pin_enable = true;
  while (scanf("%19s", word) == 1) {
    if (strcmp(word, "datum") == 0) pin_datum = true, run(0), pin_datum = false;
    if (strcmp(word, "x") == 0) pin_probe_x = next_number(), pin_probe_x_now = true, run(0), pin_probe_x_now = false;
    if (strcmp(word, "z") == 0) pin_probe_z = next_number(), pin_probe_z_now = true, run(0), pin_probe_z_now = false;
    if (strcmp(word, "resume") == 0) {
      pin_set_zero_t1 = next_number(), pin_set_zero_t2 = next_number(), pin_set_zero_t3 = next_number();
      pin_set_zero_through = next_number() > 0, pin_set_zero_digest = (uint32_t)next_number();
      pin_set_lag_1 = next_number(), pin_set_lag_2 = next_number(), pin_set_lag_3 = next_number(), pin_set_lag_4 = next_number();
      pin_set_lag_zero_1 = next_number(), pin_set_lag_zero_2 = next_number(), pin_set_lag_zero_3 = next_number();
      pin_set_lag_zero_4 = next_number(), pin_set_climate = next_number(), pin_set_off = next_number();
      pin_restore = true;
    }
    if (strcmp(word, "step") == 0) {
      const double periods = next_number();
      pin_temperature_t1 = next_number(), pin_temperature_t2 = next_number(), pin_temperature_t3 = next_number();
      run(periods);
      printf("%.17g %.17g %u %.1f\\n", pin_offset_x + 0., pin_offset_z + 0., pin_status, 0.);
    }
  }
  printf("%.17g %.17g %.17g %d %u", pin_zero_t1, pin_zero_t2, pin_zero_t3, pin_zero_through, pin_zero_digest);
  printf(" %.17g %.17g %.17g %.17g", pin_lag_1, pin_lag_2, pin_lag_3, pin_lag_4);
  printf(" %.17g %.17g %.17g %.17g %.17g\\n", pin_lag_zero_1, pin_lag_zero_2, pin_lag_zero_3, pin_lag_zero_4, pin_climate);
  return 0;
}
"""


def by_component(off):
    component = subprocess.run([thermfit, "export", model, "--target", "linuxcnc", "--unit", "um", "--probe", *OPTIONS],
                               check=True, capture_output=True, text=True).stdout
    program = hal_component.build(component, MAIN, os.path.join(work, "component"))
    answers, stored = [], None
    for part in parts:
        lines = ["resume %s %s" % (stored.replace("nan", "-"), "-" if off is None else off)] if stored else []
        for periods, datum, row, probe in part:
            lines += ["datum"] if datum else []
            lines.append("step %d %s" % (periods, " ".join("-" if x != x else repr(x) for x in row)))
            lines += ["%s %r" % (name, um) for name, um in zip("xz", probe) if um is not None]
        out = subprocess.run([program], input="\n".join(lines) + "\n", text=True, check=True, capture_output=True).stdout.splitlines()
        stored = out[-1]
        answers += [([float(w) for w in line.split()[:2]], int(line.split()[2])) for line in out[:-1]]
    return answers


expected = by_cpp(OFF)
assert {word & 15 for _, word in expected} >= {2, 3, 4, 7} and sum(word >> 31 for _, word in expected) > 100
assert any(word >> 28 & 3 == 3 for _, word in expected[800:]), "resumed"
got, told = by_run(None)  # the clock goes on
different = [n for n, (a, b) in enumerate(zip(got, expected)) if a != b]
print("run, the clock goes on over the restart: %d of %d answers differ" % (len(different), len(got)), different[:3],
      [got[n] for n in different[:1]])
assert not different and "was off for" in told, told
got, told = by_run(None, clock_goes_on=False)
unknown = by_cpp(None)
different = [n for n, (a, b) in enumerate(zip(got, unknown)) if a != b]
print("run, the time off is not known: %d differ; no datum until there is one: %s" %
      (len(different), all(word & 15 == 7 for _, word in got[800:900])))
assert not different and "how long it was off is not known" in told and got[850][1] & 15 == 7
got, _ = by_run(OFF, clock_goes_on=False)
assert got == by_cpp(OFF - 1), "--off"
document = json.load(open(os.path.join(work, "state.json")))
document["lag_degC"][1] += 1
json.dump(document, open(os.path.join(work, "torn.json"), "w"))
torn = subprocess.run([thermfit, "run", model, "--state", os.path.join(work, "torn.json"), "--off", "5"], input="T1,T2,T3\n20,20,20\n",
                      text=True, capture_output=True, check=True)
assert "the digest does not fit" in torn.stderr and ",no datum," in torn.stdout
clean = readings.readings(600, seed=4, faults=False)
clean = clean[:1] * 5 + clean  # predict counts from the first row, a zero is the median of five
times, free = [0], ["--slew", "1e6", "--clamp", "1e5", "--domain", "ignore", "--zero", "first", "--sign", "error"]
for n in range(1, len(clean)):
    times.append(times[-1] + (1 if n < 6 else source.choice([1, 1, 3, 60])))
text = "time_s,T1,T2,T3\n" + "".join("%d,%s\n" % (t, ",".join(map(repr, row))) for t, row in zip(times, clean))
batch = os.path.join(work, "batch.csv")
open(batch, "w").write(text)
predicted = json.loads(subprocess.run([thermfit, "predict", model, batch, "--json"], capture_output=True, text=True,
                                      check=True).stdout)["batches"][0]["predicted_um"]
ran = subprocess.run([thermfit, "run", model, *free], input=text, capture_output=True, text=True, check=True).stdout.splitlines()[1:]
worst = max(abs(float(cell) - um) for line, row in list(zip(ran, predicted))[5:] for cell, um in zip(line.split(",")[1:3], row))
print("run against predict, irregular times: %.1e um at most, of %.1f" % (worst, max(abs(um) for row in predicted for um in row)))
assert worst < 1e-10
got = by_component(OFF)
different = [n for n, (a, b) in enumerate(zip(got[:800], expected)) if a != b]
print("LinuxCNC component: %d of %d answers before the restart differ" % (len(different), 800), different[:3],
      [(got[n], expected[n]) for n in different[:1]])
assert not different
stored_late = max(abs(a - b) for (x, _), (y, _) in zip(got[800:], expected[800:]) for a, b in zip(x, y))
words = sum(a[1] & 15 != b[1] & 15 for a, b in zip(got[800:], expected[800:]))
print("after it, from pins of a minute ago, rounded: %.3f um at most, %d states differ" % (stored_late, words))
assert stored_late < .5 and words <= 5
assert all(word & 15 == 7 for _, word in by_component(None)[801:900])
