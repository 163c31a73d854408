"""linuxcnc_test.py THERMFIT MODEL: the exported HAL component in LinuxCNC, compiled by halcompile.

Replays a table through the component in a HAL thread and compares each row with `thermfit run`; keeps its zero from one
session to the next; then starts the simulated control without a screen and takes it through emergency stops, machine
off, unhoming, joint mode, switched offsets and data in every order of three: the Z motor is where it is commanded plus
the offset, and never on its way faster than the slew limit. Needs to be root: halcompile installs the component, an
ordinary user then runs it.
"""

import fcntl
import json
import math
import os
import pwd
import shutil
import subprocess
import sys
import tempfile

import readings

thermfit, model = sys.argv[1:]
if os.getuid() != 0:
    print("skipped: installing a component for LinuxCNC needs root")
    sys.exit(77)
alone = open(os.path.join(tempfile.gettempdir(), "thermfit_linuxcnc_test.lock"), "w")
fcntl.flock(alone, fcntl.LOCK_EX)  # a machine has one HAL
work = tempfile.mkdtemp()
NAME = "thermfittest"
MODULE = "/usr/lib/linuxcnc/modules/%s.so" % NAME
USER = "nobody"
COUNT = 1e-4  # mm
SLEW = 100.0  # um/s in the simulated control
OPTIONS = ["--period", "0.001", "--lost-after", "0.005", "--recover-after", "0.03", "--hold-timeout", "0.04", "--clamp", "30",
           "--slew", "2000", "--domain", "shrink", "--zero", "first"]


def path(name):
    return os.path.join(work, name)


def write(name, text):
    open(path(name), "w").write(text)


def as_user(*command, timeout=120):
    ids = pwd.getpwnam(USER)
    for folder, _, files in os.walk(work):
        for name in [folder] + [os.path.join(folder, f) for f in files]:
            os.chown(name, ids.pw_uid, ids.pw_gid)
    done = subprocess.run(["runuser", "-u", USER, "--", "env", "HOME=" + work, "DISPLAY=", *command], cwd=work, timeout=timeout,
                          capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        print(done.stdout[-3000:], done.stderr[-3000:])
        raise SystemExit("%s: exit %d" % (command[0], done.returncode))
    return done.stdout


def install(*options):
    subprocess.run([thermfit, "export", model, "--target", "linuxcnc", "--name", NAME, *options, "-o", path(NAME + ".comp")],
                   check=True)
    done = subprocess.run(["halcompile", "--install", NAME + ".comp"], cwd=work, capture_output=True, text=True)
    assert done.returncode == 0 and "warning" not in done.stderr + done.stdout, done.stdout + done.stderr


def replay(rows, cycle_ms=1):
    """The component's offsets and status words for `rows`, one cycle each."""
    write("readings.txt", "".join(" ".join(repr(x) for x in row) + "\n" for row in rows))
    write("replay.hal", """
loadrt threads name1=servo period1=PERIOD
loadrt streamer depth=4000 cfg=fff
loadrt sampler depth=4000 cfg=ffu
loadrt NAME
addf streamer.0 servo
addf NAME servo
addf sampler.0 servo
setp NAME.enable 1
net a streamer.0.pin.0 NAME.temperature-t1
net b streamer.0.pin.1 NAME.temperature-t2
net c streamer.0.pin.2 NAME.temperature-t3
net x NAME.offset-x sampler.0.pin.0
net z NAME.offset-z sampler.0.pin.1
net s NAME.status sampler.0.pin.2
loadusr -w halstreamer readings.txt
start
loadusr -w halsampler -n ROWS answers.txt
""".replace("NAME", NAME).replace("ROWS", str(len(rows))).replace("PERIOD", str(cycle_ms * 1000000)))
    as_user("halrun", "-f", "replay.hal")
    answers = [line.split() for line in open(path("answers.txt"))]
    return [([float(x) for x in row[-3:-1]], int(row[-1])) for row in answers]


def compare(what, options, rows, expected):
    install("--unit", "um", *options)
    got = replay(rows)
    assert len(got) == len(rows), (len(got), len(rows))
    worst = max(abs(g - e) for (gs, _), (es, _) in zip(got, expected) if es for g, e in zip(gs, es))
    words = sum(g != e for (_, g), (_, e) in zip(got, expected) if e is not None)
    print("%s: %d rows, largest difference %.1e um (halsampler prints 1e-6), %d status words differ" % (what, len(rows), worst, words))
    assert worst <= 1e-6 and words == 0 and sum(word & 15 == 2 for _, word in got) > len(rows) / 10, "a good part of it tracks"


def predict(rows):
    """What `thermfit predict` says about the rows, as corrections."""
    write("batch.csv", readings.as_csv(rows))
    answer = subprocess.run([thermfit, "predict", model, path("batch.csv"), "--json"], capture_output=True, text=True,
                            check=True).stdout
    return [([-x for x in row], None) for row in json.loads(answer)["batches"][0]["predicted_um"]]


def machine(joint):
    limits = "MAX_VELOCITY = 50\nMAX_ACCELERATION = 500\nMIN_LIMIT = -100\nMAX_LIMIT = 100\n"
    axis = "XYZ"[joint]
    offsets = "OFFSET_AV_RATIO = 0.2\n" if axis == "Z" else ""
    return ("[AXIS_%s]\n%s%s[JOINT_%d]\nTYPE = LINEAR\nHOME = 0\nHOME_OFFSET = 0\nHOME_SEARCH_VEL = 0\nHOME_LATCH_VEL = 0\n"
            "HOME_SEQUENCE = %d\nFERROR = 1\nMIN_FERROR = 1\n%s" % (axis, limits, offsets, joint, joint, limits))


def simulate():
    """The table of linuxcnc_display.py: for each step what was read, by column."""
    install("--period", "0.001", "--clamp", "40", "--slew", "%g" % SLEW, "--domain", "ignore", "--stale-after", "0.5")
    shutil.copy(os.path.join(os.path.dirname(__file__), "linuxcnc_display.py"), path("display.py"))
    os.chmod(path("display.py"), 0o755)
    write("tools.tbl", "")
    write("sim.ini", """[EMC]
MACHINE = sim
VERSION = 1.1
DEBUG = 0
[DISPLAY]
DISPLAY = %s
[TASK]
TASK = milltask
CYCLE_TIME = 0.01
[RS274NGC]
PARAMETER_FILE = sim.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 1
BASE_PERIOD = 0
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.1
TOOL_TABLE = tools.tbl
[HAL]
HALFILE = sim.hal
[TRAJ]
COORDINATES = X Y Z
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = 20
MAX_LINEAR_VELOCITY = 50
[KINS]
KINEMATICS = trivkins
JOINTS = 3
%s""" % (path("display.py"), "".join(machine(joint) for joint in range(3))))
    write("sim.hal", """loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS
loadrt NAME
addf motion-command-handler servo-thread
addf NAME servo-thread
addf motion-controller servo-thread
net x joint.0.motor-pos-cmd joint.0.motor-pos-fb
net y joint.1.motor-pos-cmd joint.1.motor-pos-fb
net z joint.2.motor-pos-cmd joint.2.motor-pos-fb
net stop iocontrol.0.user-enable-out iocontrol.0.emc-enable-in
net tool iocontrol.0.tool-prepare iocontrol.0.tool-prepared
net change iocontrol.0.tool-change iocontrol.0.tool-changed
net counts NAME.offset-z-counts axis.z.eoffset-counts
net applied axis.z.eoffset NAME.applied-z
net no-x NAME.offset-x NAME.applied-x
net machine-on motion.motion-enabled NAME.machine-on
net homed motion.is-all-homed NAME.homed
net enabled axis.z.eoffset-enable NAME.eoffset-enabled
sets enabled 1
setp axis.z.eoffset-scale 0.0001
loadrt sampler depth=20000 cfg=f
addf sampler.0 servo-thread
setp sampler.0.enable 0
net z sampler.0.pin.0
""".replace("NAME", NAME))
    as_user("linuxcnc", "sim.ini", timeout=180)
    out = open(path("motor.txt")).read()
    print(out.strip())
    table = {}
    for line in out.splitlines():
        if " expected " in line:
            what, numbers = line[:34].strip(), line[34:].split()
            table.setdefault(what, []).append(dict(zip(numbers[::2], numbers[1::2])))
    return table


def check(table):
    """What each line of the simulation's table must say; lines with `ok` 1 by the same rule for all."""
    unlike = {"not netted": (0, "17"), "no datum": (0, "7"), "off": (0, "2"), "on": (0, "2"), "bad": (-0.020, "4"),
              "still-bad": (-0.020, "4"), "hot": (-0.040, "2"), "soft limit": (None, "2"), "soft limit, wanted more": (None, "2"),
              "cleared": (0, "2"), "silent": (None, "4"), "stopped": (0, "0")}
    lines = 0
    for what, said in ((what, said) for what, all_said in table.items() for said in all_said):
        away = float(said["motor"]) - float(said["at"])
        wanted, states = unlike.get(what, (float(said["expected"]), "2"))
        assert wanted is None or abs(away - wanted) <= COUNT + 1e-5, (what, said)
        assert abs(away - float(said["applied"])) <= 1e-5 and said["state"] in states, (what, said)
        assert said["ok"] == ("0" if what in unlike else "1"), (what, said)
        assert said["ok"] == "0" or said["delivery"] == "1", (what, said)
        assert what in unlike or abs(float(said["offset"]) - float(said["expected"])) <= 2e-5, (what, said)
        lines += 1
    for what in ["not netted", "no datum", "off", "on"]:
        assert table[what][0]["counts"] == "0" and table[what][0]["delivery"] == "0", "the counts rest until the joints are homed"
    bad = int(table["bad"][0]["status"], 16)
    assert bad >> 8 & 255 == 3 and bad >> 16 & 15 == 2, "sensor 3, range"
    assert int(table["hot"][0]["status"], 16) & 0x20, "clamped"
    assert int(table["silent"][0]["status"], 16) >> 16 & 15 == 7, "stale"
    print("%d lines, motor = commanded position + offset within a count of %g mm" % (lines, COUNT))


def check_trace(window_s=0.02, burst_s=0.05):
    """The motor at 1 kHz throughout the course of events: never faster than the slew limit, but for what may go at once."""
    rows = [line.split() for line in open(path("trace.txt"))]
    motor = {int(row[0]): float(row[1]) for row in rows if len(row) == 2}
    window = round(window_s * 1000)
    way = max(abs(motor[n + window] - z) for n, z in motor.items() if n + window in motor)
    most = SLEW * 1e-3 * (window_s + burst_s) + COUNT
    print("%d ms of the motor: at most %.4f mm in %g s; the slew limit of %g mm/s allows %.4f" %
          (len(motor), way, window_s, SLEW * 1e-3, most))
    assert len(motor) > 10000 and way <= most


def power_cycle():
    """A zero that was read with halcmd and set again in the next session is the same zero; a torn one is none."""
    install("--unit", "um", "--slew", "1e6", "--period", "0.001")
    start = "loadrt threads name1=servo period1=1000000\nloadrt NAME\naddf NAME servo\n"
    read = "".join("getp NAME.%s\n" % pin for pin in ["zero-t1", "zero-t2", "zero-t3", "zero-through", "zero-digest",
                                                     "zero-source", "state", "offset-z"])
    temperatures = "".join("setp NAME.temperature-t%d %r\n" % (i + 1, t) for i, t in enumerate([23.45678, 24.1, 22.98765]))

    def session(name, words):
        write(name, (start + words).replace("NAME", NAME))
        return as_user("halrun", "-s", "-f", name).split()

    before = session("first.hal", temperatures + "setp NAME.enable 1\nsetp NAME.datum 1\nstart\nloadusr -w sleep 0.2\n" + read)
    restore = "".join("setp NAME.set-%s %s\n" % (pin, value) for pin, value in
                      zip(["zero-t1", "zero-t2", "zero-t3", "zero-through"], before)) + "setp NAME.set-zero-digest %s\n"
    again = temperatures.replace("23.45678", "25.45678") + "setp NAME.enable 1\nsetp NAME.restore 1\nstart\nloadusr -w sleep 0.2\n" + read
    after = session("second.hal", restore % before[4] + again)
    torn = session("third.hal", restore % (int(before[4]) ^ 1) + again)
    print("a zero over a power cycle:", before, after, torn)
    assert before[3] == "TRUE" and before[5:7] == ["2", "2"] and abs(float(before[7])) <= 1e-4
    assert after[:5] == before[:5] and after[5:7] == ["3", "2"] and abs(float(after[7]) + 4) <= 1e-3, "2 um/K, 2 K warmer"
    assert torn[4:] == ["0", "0", "7", "0"]


def slow_thread():
    """In a thread slower than the compensation the offset keeps its speed: 3 ms a cycle, 1 ms a period, 1000 um/s."""
    install("--unit", "um", "--slew", "1000", "--period", "0.001", "--clamp", "1000", "--domain", "ignore", "--zero", "first")
    cold, warm = [20.0] * 3, [40.0, 20.0, 20.0]
    z = [offsets[1] for offsets, _ in replay([cold] * 15 + [warm] * 40, cycle_ms=3)]
    moves = [round(b - a, 3) for a, b in zip(z, z[1:])]
    print("thread of 3 ms, period of 1 ms, 1 um a period:", sorted(set(moves)), "um a cycle")
    assert moves.count(-3.0) == 13, moves  # and the rest of 40 um


try:
    rows = readings.readings(2000, seed=3)
    rows = rows[:1] * 9 + rows  # the samples of its zero
    compare("replay with faults against thermfit run", OPTIONS, rows, readings.run(thermfit, model, rows, *OPTIONS))
    rows = readings.readings(2000, seed=4, faults=False)
    rows = rows[:1] * 9 + rows
    free = ["--period", "0.001", "--slew", "1e6", "--clamp", "1e5", "--domain", "ignore", "--sign", "correction", "--zero", "first"]
    compare("replay of a batch against thermfit predict", free, rows, [(None, None)] * 8 + predict(rows)[8:])
    power_cycle()
    slow_thread()
    check(simulate())
    check_trace()
finally:
    for file in [MODULE, MODULE.replace(".so", ".o")]:
        if os.path.exists(file):
            os.remove(file)
