#!/usr/bin/python3
"""The DISPLAY of the simulated control: drives it, sets temperatures, writes a table of where the Z motor is told to go.

Each line: what happened; in mm the commanded position, the offset that the temperatures ask for, the offset pin, the
applied offset and the motor, relative to where homing put its zero; counts, state, status word, delivery, ok.
"""

import itertools
import subprocess
import sys
import time

import hal
import linuxcnc

sys.stdout = open("motor.txt", "w")  # linuxcnc keeps stdout for itself
command, status = linuxcnc.command(), linuxcnc.stat()
watch = hal.component("watch")
watch.ready()
NAME = "thermfittest."
UM_PER_K = [-0.002, -0.001, 0.001]  # correction of Z in mm/K
COUNT = 1e-4
temperatures, zero = [20.0] * 3, [20.0] * 3
failed = []  # the step that did not come out as it should: one more line, then the end


def pin(name):
    return hal.get_value(name)


def own(name):
    return hal.get_value(NAME + name)


def setp(name, value):
    hal.set_p(name, str(value))


def wait(condition, what, seconds=20):
    end = time.time() + seconds
    while time.time() < end:
        status.poll()
        if condition():
            return
        time.sleep(0.005)
    sys.exit("gave up waiting for " + what)


def motor_away():
    return pin("joint.2.motor-pos-cmd") - pin("joint.2.motor-offset") - pin("axis.z.pos-cmd")


def expected():
    return sum(k * (t - z) for k, t, z in zip(UM_PER_K, temperatures, zero))


def report(what, settled=None):
    """A line as soon as it has been as it should for 60 ms, or after 3 s."""
    if settled is None:
        settled = lambda: (own("ok") and abs(motor_away() - expected()) < 1.01 * COUNT
                           and abs(own("offset-z") - expected()) < 1e-9)
    if failed:
        sys.exit("stopped after " + what)
    end, since = time.time() + 3, None
    while since is None or time.time() < since + 0.06:
        since = (since or time.time()) if settled() else None
        failed[:] = [what] * (time.time() > end)
        if failed:
            break
        time.sleep(0.005)
    motor = pin("joint.2.motor-pos-cmd") - pin("joint.2.motor-offset")
    print("%-34s at %10.5f expected %8.5f offset %8.5f applied %8.5f motor %10.5f counts %6d state %d status %08x delivery %d ok %d"
          % (what, pin("axis.z.pos-cmd"), expected(), own("offset-z"), pin("axis.z.eoffset"), motor, own("offset-z-counts"),
             own("state"), own("status"), own("delivery"), own("ok")), flush=True)


def read(*values):
    temperatures[:] = values
    for name, value in zip(["t1", "t2", "t3"], values):
        setp(NAME + "temperature-" + name, value)


course = itertools.cycle([24.0, 31.0, 22.0, 35.0, 28.0, 20.5, 33.0])


def warm():
    """Another temperature, while something else is going on."""
    read(next(course), 20.0, 20.0)
    time.sleep(0.05)


def power_on():
    command.state(linuxcnc.STATE_ESTOP_RESET)
    wait(lambda: status.task_state >= linuxcnc.STATE_ESTOP_RESET, "emergency stop reset")
    command.state(linuxcnc.STATE_ON)
    wait(lambda: status.task_state == linuxcnc.STATE_ON and pin("motion.motion-enabled"), "machine on")


def home():
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete()
    command.teleop_enable(0)
    command.wait_complete()
    for joint in range(3):
        command.home(joint)
    wait(lambda: all(status.homed[:3]) and pin("motion.teleop-mode"), "homing")


def mdi(words):
    command.mode(linuxcnc.MODE_MDI)
    command.wait_complete()
    command.mdi(words)
    command.wait_complete()
    wait(lambda: status.inpos, words)


def emergency_stop():
    command.state(linuxcnc.STATE_ESTOP)
    wait(lambda: not pin("motion.motion-enabled"), "emergency stop")
    warm()
    power_on()


def power_off():
    command.state(linuxcnc.STATE_OFF)
    wait(lambda: not pin("motion.motion-enabled"), "machine off")
    warm()
    power_on()


def unhome():
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete()
    command.teleop_enable(0)
    wait(lambda: not pin("motion.teleop-mode"), "joint mode")
    command.unhome(-1)
    wait(lambda: not any(status.homed[:3]), "unhoming")
    warm()
    home()


def toggle():
    """In the midst of a movement."""
    read(next(course), 20.0, 20.0)
    time.sleep(0.03)
    subprocess.run(["halcmd", "sets", "enabled", "0"], check=True)
    warm()
    subprocess.run(["halcmd", "sets", "enabled", "1"], check=True)


def joint_mode():
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete()
    command.teleop_enable(0)
    wait(lambda: not pin("motion.teleop-mode"), "joint mode")
    warm()
    time.sleep(0.3)
    command.teleop_enable(1)
    wait(lambda: pin("motion.teleop-mode"), "teleop mode")


def pulse_datum():
    setp(NAME + "datum", 1)
    time.sleep(0.03)
    setp(NAME + "datum", 0)


def datum():
    pulse_datum()
    wait(lambda: not own("zero-pending"), "the zero")
    zero[:] = temperatures


EVENTS = [emergency_stop, power_off, unhome, toggle, joint_mode, datum]


def all_triples(events):
    """A course in which every three different events follow on one another in every order: an Euler path over pairs."""
    left = {pair: [c for c in events if c not in pair] for pair in itertools.permutations(events, 2)}
    stack, path = [next(iter(left))], []
    while stack:
        if left[stack[-1]]:
            stack.append((stack[-1][1], left[stack[-1]].pop()))
        else:
            path.append(stack.pop())
    path.reverse()
    return [path[0][0]] + [second for _, second in path]


# A component just loaded: what is not netted is not used.
setp(NAME + "enable", 1)
pulse_datum()
time.sleep(0.3)
report("not netted", lambda: True)
setp(NAME + "enable", 0)
wait(lambda: own("state") == 0, "off")
pulse_datum()  # while off: no longer asked for
read(20, 20, 20)
setp(NAME + "enable", 1)
time.sleep(0.1)
report("no datum", lambda: True)
datum()
read(25, 20, 20)
time.sleep(0.2)
report("off", lambda: True)
power_on()
report("on", lambda: True)
print("joints homed %s is-all-homed %s" % ([pin("joint.%d.homed" % j) for j in range(3)], pin("motion.is-all-homed")), flush=True)
home()
report("homed")
mdi("G21 G53 G0 Z-10")
report("Z-10")
read(20, 20, 20)
report("cold")
read(30, 20, 20)
report("warm")
before = expected()
held = lambda: own("state") == 4 and abs(motor_away() - before) < 1.01 * COUNT
read(30, 20, 200)
report("bad", held)
read(35, 20, 200)
report("still-bad", held)
read(30, 20, 20)
report("good")
read(45, 20, 20)
report("hot", lambda: abs(motor_away() + 0.04) < 1.01 * COUNT)
read(30, 20, 20)
report("warm again")
sampler = subprocess.Popen(["halsampler", "-t"], stdout=open("trace.txt", "w"))
setp("sampler.0.enable", 1)
began = time.time()
for event in all_triples(EVENTS):
    event()
    report(event.__name__)
print("%.0f s" % (time.time() - began), flush=True)
setp("sampler.0.enable", 0)
time.sleep(0.2)
sampler.terminate()
sampler.wait()
mdi("G53 G0 Z99.99")
read(zero[0] - 15, 20, 20)
report("soft limit", lambda: own("delivery") == 3)
read(zero[0] - 18, 20, 20)
time.sleep(1)
report("soft limit, wanted more", lambda: own("delivery") == 3)
mdi("G53 G0 Z-10")
report("away from it")
setp("axis.z.eoffset-clear", 1)
time.sleep(0.5)
report("cleared", lambda: own("delivery") == 3)
setp("axis.z.eoffset-clear", 0)
report("no longer cleared")
setp(NAME + "heartbeat", 1)
report("heartbeat")
time.sleep(1)
report("silent", lambda: own("state") == 4 and own("fault") == 7)
setp(NAME + "heartbeat", 2)
report("heard again")
setp(NAME + "enable", 0)
report("stopped", lambda: own("state") == 0 and abs(motor_away()) < 1.01 * COUNT)
