"""linuxcnc_test.py THERMFIT MODEL: the exported HAL component in LinuxCNC, compiled by halcompile.

Replays a table through the component in a HAL thread and compares each row with `thermfit run`; then starts the
simulated control without a screen and watches the command of its Z motor. Needs to be root: halcompile installs the
component, an ordinary user then runs it.
"""

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
work = tempfile.mkdtemp()
NAME = "thermfittest"
MODULE = "/usr/lib/linuxcnc/modules/%s.so" % NAME
USER = "nobody"
OPTIONS = ["--period", "0.001", "--lost-after", "0.005", "--recover-after", "0.03", "--hold-timeout", "0.04", "--clamp", "30",
           "--slew", "2000", "--domain", "shrink"]


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


def replay(options, rows):
    """The component's offsets and status words for `rows`, one servo cycle each."""
    install("--unit", "um", *options)
    write("readings.txt", "".join(" ".join(repr(x) for x in row) + "\n" for row in rows))
    write("replay.hal", """
loadrt threads name1=servo period1=1000000
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
""".replace("NAME", NAME).replace("ROWS", str(len(rows))))
    as_user("halrun", "-f", "replay.hal")
    answers = [line.split() for line in open(path("answers.txt"))]
    return [([float(x) for x in row[-3:-1]], int(row[-1])) for row in answers]


def compare(what, options, rows, expected):
    got = replay(options, rows)
    assert len(got) == len(rows), (len(got), len(rows))
    worst = max(abs(g - e) for (gs, _), (es, _) in zip(got, expected) for g, e in zip(gs, es))
    words = sum(g != e for (_, g), (_, e) in zip(got, expected) if e is not None)
    print("%s: %d rows, largest difference %.1e um (halsampler prints 1e-6), %d status words differ" % (what, len(rows), worst, words))
    assert worst <= 1e-6 and words == 0


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
    """Z motor command in mm at each stage of linuxcnc_display.py."""
    install("--period", "0.001", "--clamp", "40", "--slew", "1000", "--domain", "ignore")
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
setp axis.z.eoffset-scale 0.0001
setp axis.z.eoffset-enable 1
""".replace("NAME", NAME))
    as_user("linuxcnc", "sim.ini")
    out = open(path("motor.txt")).read()
    print(out.strip())
    return {line.split()[0]: (float(line.split()[1]), int(line.split()[5])) for line in out.splitlines() if " state " in line}


try:
    rows = readings.readings(2000, seed=3)
    compare("replay with faults against thermfit run", OPTIONS, rows, readings.run(thermfit, model, rows, *OPTIONS))
    rows = readings.readings(2000, seed=4, faults=False)
    free = ["--period", "0.001", "--slew", "1e6", "--clamp", "1e5", "--domain", "ignore", "--sign", "correction"]
    compare("replay of a batch against thermfit predict", free, rows, predict(rows))
    motor = simulate()
    expected = {"off": -10, "cold": -10.001, "warm": -10.021, "bad": -10.021, "still-bad": -10.021, "good": -10.021,
                "hot": -10.040, "stopped": -10}
    for stage, z in expected.items():
        assert math.isclose(motor[stage][0], z, abs_tol=5e-6), (stage, motor[stage], z)
    assert motor["bad"][1] >> 8 & 255 == 3 and motor["bad"][1] >> 16 & 15 == 2, "sensor 3, range"
    assert motor["hot"][1] & 0x20, "clamped"
finally:
    for file in [MODULE, MODULE.replace(".so", ".o")]:
        if os.path.exists(file):
            os.remove(file)
