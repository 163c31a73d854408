"""fault_matrix_test.py THERMFIT MODEL SOURCE [st]: what the compensator does at its edges, in every target.

With `st` Structured Text too, interpreted (needs blark). Each course of events has one right offset, state and fault, written down here from the model's numbers: error Z =
1 + 2 T1 + T2 - T3 um of the rise in K, relative to the datum without the 1. Every target that can express the course
must answer so, and README's table must say so.
"""

import json
import os
import subprocess
import sys
import tempfile

import hal_component

thermfit, model, source = sys.argv[1:4]
here = os.path.dirname(os.path.abspath(__file__))
work = tempfile.mkdtemp()
STATES = ["off", "starting", "tracking", "substituting", "holding", "fallback", "stopping", "no datum"]
FAULTS = ["", "not finite", "range", "rate", "stuck", "recovering", "no reference", "stale", "disagrees"]
OPTIONS = ["--slew", "100", "--clamp", "100", "--domain", "hold"]


def z(a, b, c, lost=None):
    """Offset relative to the datum at these rises, K; with a substitute for the lost sensor."""
    if lost == 0:
        return -(1.75 * b - c)
    return -(2 * a + b - c)


class Course:
    """Commands, and what must come out of them."""

    def __init__(self, name, offset, state, fault="", only=None, bits=0):
        self.name, self.offset, self.state, self.fault, self.only, self.bits = name, offset, state, fault, only, bits
        self.commands = []

    def do(self, *commands):
        self.commands += commands
        return self

    def step(self, readings, times=1, periods=1, beat=0):
        text = " ".join("-" if r is None else repr(float(r)) for r in readings)
        self.commands += ["step %d %d %s" % (periods, beat, text)] * times
        return self

    def shaking(self, readings, times, still=()):
        """Readings that shake by .02 K, as real ones do, but for those of `still`."""
        for k in range(times):
            self.step([r if i in still else r + .02 * (k % 2) for i, r in enumerate(readings)])
        return self

    def strays(self, lost):
        """T3 runs away from the others, which shake."""
        for k in range(400):
            self.step([None if lost == 0 else 22 + .02 * (k % 2), 22 + .02 * (k % 3), 22 + .05 * k])
        return self

    def probed(self, degC=20):
        """Started, and the work offset probed at this temperature."""
        return self.do("start").step([degC] * 3).do("datum").step([degC] * 3, 8)

    def warm(self, to=22, lost=None):
        for k in range(100):
            self.step([None if i == lost else 20 + (to - 20) * (k + 1) / 100 for i in range(3)])
        return self.step([None if i == lost else to for i in range(3)], 20)


cold, warm = [20] * 3, [22] * 3
courses = [
    Course("switched on, no zero", 0, "no datum").do("start").step(warm, 100),
    Course("datum, cold", 0, "tracking").probed(),
    Course("datum, warm machine", 0, "tracking").probed(24),
    Course("warmed up by 2 K since the datum", z(2, 2, 2), "tracking").probed().warm(),
    Course("datum again, while warm", 0, "tracking").probed().warm().do("datum").step(warm, 8),
    Course("power cycle, cold", 0, "tracking").probed().do("power whole", "resume").step(cold, 100),
    Course("power cycle, warm", z(2, 2, 2), "tracking").probed().warm().do("power whole", "resume").step(warm, 100),
    Course("power cycle, warm, zero never stored", 0, "no datum").probed().warm().do("power none", "resume").step(warm, 100),
    Course("power cycle, warm, stored zero cut", 0, "no datum").probed().warm().do("power cut", "resume").step(warm, 100),
    Course("power cycle, warm, zero of another model", 0, "no datum").probed().warm().do("power foreign", "resume")
    .step(warm, 100),
    Course("power cycle, warm, a sensor dead", z(None, 2, 2, 0), "substituting", "not finite").probed().warm()
    .do("power whole", "resume").step([None, 22, 22], 100),
    Course("switched off and on (E-stop, enable)", z(2, 2, 2), "tracking", only={"C", "C++", "ST", "LinuxCNC"}).probed()
    .warm().do("stop").step(warm, 100).do("start").step(warm, 100),
    Course("datum while switched off", 0, "no datum", only={"C", "C++", "ST", "LinuxCNC"}).probed().warm().do("stop")
    .step(warm, 100).do("datum", "start").step(warm, 100),
    Course("datum, switched off before it was taken", 0, "no datum", only={"C", "C++", "ST", "LinuxCNC"}).probed().warm()
    .do("datum").step(warm, 2).do("stop").step(warm, 100).do("start").step(warm, 100),
    Course("default of 0 in the first samples", z(0, 0, 0), "tracking").do("start", "datum").step([0, 0, 0], 3)
    .step(cold, 120),
    Course("one sensor off in the first sample", z(0, 0, 0), "tracking").do("start", "datum").step([20.9, 20, 20])
    .step(cold, 60),
    Course("one sensor late", z(0, 0, 0), "tracking").do("start", "datum").step([20, None, 20], 100).step(cold, 60),
    Course("a sensor lost", z(None, 2, 2, 0), "substituting", "not finite").probed().warm().step([None, 22, 22], 100),
    Course("lost, and back where it was", z(2, 2, 2), "tracking").probed().warm().step([None, 22, 22], 100).step(warm, 60),
    Course("stepped by 30 K", z(None, 2, 2, 0), "substituting", "disagrees").probed().warm().step([52, 22, 22], 400),
    Course("stepped by 30 K, and a datum", 0, "tracking").probed().warm().step([52, 22, 22], 400).do("datum")
    .step([52, 22, 22], 8),
    Course("two sensors lost", z(2, 2, 2), "holding", "not finite").probed().warm().step([None, None, 22], 100),
    Course("two sensors lost for long", 0, "fallback", "not finite").probed().warm().step([None, None, 22], 800),
    Course("one sensor frozen", z(None, 2, 2, 0), "substituting", "stuck").probed().warm()
    .shaking(warm, 2100, still=[0]).step(warm),
    Course("all frozen", z(2, 2, 2), "holding", "stuck").probed().warm().step(warm, 2100),
    Course("all frozen for long", 0, "fallback", "stuck").probed().warm().step(warm, 2900),
    Course("the heartbeat stops", z(2, 2, 2), "holding", "stale", only={"C", "C++", "ST", "LinuxCNC"}).probed().warm()
    .step(warm, 200, beat=7),
    Course("out of the training domain", None, "holding", bits=0x10).probed().warm().strays(lost=None),
    Course("out of the domain with a sensor lost", None, "holding", "not finite", bits=0x10).probed().warm()
    .step([None, 22, 22], 20).strays(lost=0),
    Course("a burst of calls in no time", z(2, 2, 2), "tracking").probed().warm().step([23] * 3, 500, periods=0),
    Course("a call 100 periods late", z(3, 3, 3), "tracking").probed().warm().step([23] * 3, 1, periods=100),
    Course("the clock back by an hour", z(2, 2, 2), "tracking", only={"run"}).probed().warm().do("back 3600")
    .step(warm, 5),
]


def export(target, name):
    path = os.path.join(work, name)
    subprocess.run([thermfit, "export", model, "--target", target, "--name", "course", "-o", path, *OPTIONS], check=True,
                   capture_output=True)
    return path


def driver(name, *flags):
    path = os.path.join(work, name)
    subprocess.run(["g++", "-std=c++17", "-O1", "-Wall", "-I", work, "-I", os.path.join(source, "include"), *flags,
                    os.path.join(here, "fault_course.cpp"), "-o", path], check=True)
    return lambda course: [float(w) if "." in w or "e" in w else int(w) for w in subprocess.run(
        [path], input="\n".join(course.commands + ["tell"]) + "\n", text=True, check=True,
        capture_output=True).stdout.split()]


def by_run(course):
    """Through pipes: a power cycle is another process; the clock tells the periods."""
    state = os.path.join(work, "zero.json")
    if os.path.exists(state):
        os.unlink(state)
    clock, lines = 0, ["time_s,T1,T2,T3"]
    for command in course.commands + ["end"]:
        word, *rest = command.split()
        if word in ("power", "end"):
            answers = subprocess.run([thermfit, "run", model, "--state", state, *OPTIONS], text=True, check=True,
                                     input="\n".join(lines) + "\n", capture_output=True).stdout.splitlines()
            lines = lines[:1]
            if rest == ["none"]:
                os.unlink(state)
            elif rest in (["cut"], ["foreign"]):
                document = json.load(open(state))
                if rest == ["cut"]:
                    document["zero_degC"]["T1"] += 5
                else:
                    document["model"] += 1
                json.dump(document, open(state, "w"))
        elif word == "datum":
            lines.append("datum")
        elif word == "back":
            clock -= float(rest[0])
        elif word == "step":
            clock += int(rest[0])
            lines.append(",".join([repr(clock)] + ["" if r == "-" else r for r in rest[2:]]))
    cells = dict(zip(answers[0].split(","), answers[-1].split(",")))
    return [float(cells["offset_Z_um"]), int(cells["status"])]


COMPONENT_MAIN = """
/* Reads a course from stdin, one power-up; at its end tells what a script would store, then offset and status. */
static double number(const char *text) { return strcmp(text, "-") == 0 ? NAN : atof(text); }
static void run(double periods) { component(&hal, (long)(periods * 1e9)); pin_applied_x = pin_offset_x, pin_applied_z = pin_offset_z; }

int main(void) {
  char word[20], t1[40], t2[40], t3[40];
  unsigned beat;
  double periods;
  pin_machine_on = pin_homed = pin_eoffset_enabled = true;
  pin_temperature_t1 = pin_temperature_t2 = pin_temperature_t3 = NAN;
  run(1);
  while (scanf("%19s", word) == 1) {
    if (strcmp(word, "start") == 0) pin_enable = true;
    if (strcmp(word, "stop") == 0) pin_enable = false;
    if (strcmp(word, "datum") == 0) pin_datum = true, run(0), pin_datum = false;
    if (strcmp(word, "resume") == 0) {
      int through;
      uint32_t digest;
      if (scanf("%39s %39s %39s %d %u", t1, t2, t3, &through, &digest) != 5) return 1;
      pin_set_zero_t1 = number(t1), pin_set_zero_t2 = number(t2), pin_set_zero_t3 = number(t3);
      pin_set_zero_through = through, pin_set_zero_digest = digest;
      pin_enable = pin_restore = true;
    }
    if (strcmp(word, "step") == 0) {
      if (scanf("%lf %u %39s %39s %39s", &periods, &beat, t1, t2, t3) != 5) return 1;
      pin_temperature_t1 = number(t1), pin_temperature_t2 = number(t2), pin_temperature_t3 = number(t3);
      pin_heartbeat = beat;
      run(periods);
    }
  }
  printf("%.17g %.17g %.17g %d %u\\n%.9g %u\\n", pin_zero_t1, pin_zero_t2, pin_zero_t3, pin_zero_through, pin_zero_digest,
         pin_offset_z * 1000, pin_status);
  return 0;
}
"""


def by_component():
    """Through the HAL component compiled with a stand-in for HAL; a power cycle loads it anew, and a script has stored
    what its zero pins showed."""
    program = hal_component.build(open(export("linuxcnc", "course.comp")).read(), COMPONENT_MAIN, os.path.join(work, "comp"))

    def answer(course):
        part = []
        for command in course.commands + ["end"]:
            word, *rest = command.split()
            if word in ("power", "end"):
                stored, told = subprocess.run([program], input="\n".join(part) + "\n", text=True, check=True,
                                              capture_output=True).stdout.splitlines()
                zeros = stored.replace("nan", "-").split()
                if rest == ["none"]:
                    zeros = ["-", "-", "-", "0", "0"]
                if rest == ["cut"]:
                    zeros[0] = repr(float(zeros[0]) + 5)
                if rest == ["foreign"]:
                    zeros[4] = str(int(zeros[4]) ^ 1)
                part = []
            elif word == "resume":
                part.append("resume " + " ".join(zeros))
            else:
                part.append(command)
        return [float(told.split()[0]), int(told.split()[1])]
    return answer


def by_structured_text():
    """Through the function block, interpreted; a power cycle keeps what is RETAIN."""
    import structured_text
    text = open(export("st", "course.st")).read().split("FUNCTION_BLOCK course_test")[0]
    block = structured_text.load(text)["course"]

    def answer(course):
        device, enable, datum, row = block(), False, False, ["20.0"] * 3

        def call(periods, beat):
            device(Enable=enable, Datum=datum, Periods=periods, Heartbeat=beat, **{
                "Temperature_T%d" % (i + 1): float("nan" if r == "-" else r) for i, r in enumerate(row)})
        for command in course.commands:
            word, *rest = command.split()
            if word in ("start", "resume", "stop"):
                enable = word != "stop"
            elif word == "datum":
                datum = True
                if not enable:
                    call(1, 0)
                    datum = False
            elif word == "power":
                device = block() if rest == ["none"] else structured_text.after_power_cycle(device)
                enable = False
                if rest == ["cut"]:
                    device.s1_zero += 5
                if rest == ["foreign"]:
                    device.zero_model ^= 1
            elif word == "step":
                row = rest[2:]
                call(int(rest[0]), int(rest[1]))
                datum = False
        return [float(device.offset_z_um), device.status]
    return answer


export("cpp", "course.hpp")
export("c", "course.h")
targets = {"C++": driver("cpp"), "C": driver("c", "-DCOURSE_IN_C"), "LinuxCNC": by_component(), "run": by_run}
if "st" in sys.argv[4:]:
    targets["ST"] = by_structured_text()

wrong = 0
readme = open(os.path.join(source, "README.md")).read().splitlines()
print("| what happens | offset | state, fault | %s |" % " | ".join(targets))
print("|---|---|---|%s" % ("---|" * len(targets)))
for course in courses:
    answers = {}
    for name, answer in targets.items():
        if course.only is None or name in course.only:
            answers[name] = answer(course)
    cells, want = [], course.offset
    for name in targets:
        if name not in answers:
            cells.append("–")
            continue
        offset, status = answers[name]
        state, fault = STATES[status & 15], FAULTS[status >> 16 & 15]
        if want is None:
            want = offset
        right = abs(offset - want) <= 1e-6 and state == course.state and fault == course.fault and status & 0x30 == course.bits
        wrong += not right
        cells.append("as it must" if right else "WRONG: %g, %s, %s, %08x" % (offset, state, fault, status))
    row = "| %s | %.2f um | %s |" % (course.name, want + 0., ", ".join(filter(None, [course.state, course.fault])))
    print(row, " | ".join(cells), "|")
    if row not in readme:
        wrong += 1
        print("README has no such row")
print("%d courses, %d wrong" % (len(courses), wrong))
sys.exit(wrong > 0)
