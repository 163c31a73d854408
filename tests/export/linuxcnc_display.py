#!/usr/bin/python3
"""The DISPLAY of the simulated control: drives it, sets temperatures, prints where the Z motor is told to go (mm)."""

import subprocess
import sys
import time

import linuxcnc

sys.stdout = open("motor.txt", "w")  # linuxcnc keeps stdout for itself
command, status = linuxcnc.command(), linuxcnc.stat()
component = "thermfittest"


def hal(*words):
    return subprocess.run(["halcmd", "-s", *words], capture_output=True, text=True, check=True).stdout.strip()


def wait(condition, what):
    for _ in range(600):
        status.poll()
        if condition():
            return
        time.sleep(0.05)
    print("gave up waiting for", what, flush=True)
    sys.exit(1)


def report(what):
    time.sleep(1)
    print("%s %.6f state %s status %s" % (what, float(hal("getp", "joint.2.motor-pos-cmd")),
                                          hal("getp", component + ".state"), hal("getp", component + ".status")), flush=True)


def temperatures(*values):
    for name, value in zip(["t1", "t2", "t3"], values):
        hal("setp", "%s.temperature-%s" % (component, name), str(value))


temperatures(20, 20, 20)
command.state(linuxcnc.STATE_ESTOP_RESET)
wait(lambda: status.task_state >= linuxcnc.STATE_ESTOP_RESET, "emergency stop reset")
command.state(linuxcnc.STATE_ON)
wait(lambda: status.task_state == linuxcnc.STATE_ON, "machine on")
command.mode(linuxcnc.MODE_MANUAL)
command.wait_complete()
command.teleop_enable(0)
for joint in range(3):
    command.home(joint)
wait(lambda: all(status.homed[:3]), "homing")
command.mode(linuxcnc.MODE_MDI)
command.wait_complete()
command.mdi("G21 G53 G0 Z-10")
wait(lambda: status.inpos and abs(status.position[2] + 10) < 1e-6, "the move")
report("off")
hal("setp", component + ".enable", "1")
report("cold")
temperatures(30, 20, 20)
report("warm")
temperatures(30, 20, 200)
report("bad")
temperatures(35, 20, 200)
report("still-bad")
temperatures(30, 20, 20)
report("good")
temperatures(45, 20, 20)
report("hot")
hal("setp", component + ".enable", "0")
report("stopped")
