"""hal_increments_test.py THERMFIT MODEL: the exported HAL component against a model of LinuxCNC's external offsets.

The component is compiled with a stand-in for HAL. Motion is modelled by its documented rules: it adds changes of the
counts times the scale to the requested offset while it is on, homed and enabled; machine-on begins at no offset; the
applied offset follows the requested one within velocity and acceleration, not in joint mode, and only to the soft
limit; clearing sets the request to zero. What is switched, when, and what temperatures do is random; whenever all has
been at rest for a while the applied offset must be the wanted one, and `ok` true only where it is.
"""

import os
import subprocess
import sys
import tempfile

import hal_component

thermfit, model = sys.argv[1:]
work = tempfile.mkdtemp()
COURSES = 200

MAIN = """
static double scale_of_axis = 1e-4;
static struct { double asked, applied, speed, shown; int32_t counts; bool on, free, clear, frozen; double limit; } motion;

static double between(double low, double high) { return low + (high - low) * rand() / RAND_MAX; }
static int one_of(int n) { return rand() %% n; }

/* One servo cycle of an axis of 10 mm/s and 100 mm/s2. */
static void move(void) {
  const double cycle = 1e-3, fastest = 10, change = 100 * cycle;
  const bool on = pin_machine_on;
  const int32_t more = (int32_t)((uint32_t)pin_offset_z_counts - (uint32_t)motion.counts);
  if (on && !motion.on) motion.asked = motion.applied = motion.speed = 0;
  motion.on = on;
  if (on && !motion.free) { /* the planner, from the request of the cycle before */
    const double way = motion.asked - motion.applied, sign = way < 0 ? -1 : 1;
    double speed = fabs(way) > 1e-7 ? sign * (sqrt(2 * 100 * fabs(way) + change * change) - change) : 0;
    if (!pin_eoffset_enabled) speed = 0;
    if (!pin_eoffset_enabled) motion.asked = motion.applied;
    speed = speed > fastest ? fastest : speed < -fastest ? -fastest : speed;
    motion.speed = speed > motion.speed + change ? motion.speed + change : speed < motion.speed - change ? motion.speed - change : speed;
    motion.applied += motion.speed * cycle;
    if (motion.applied > motion.limit) motion.applied = motion.limit, motion.speed = 0;
  }
  motion.counts = pin_offset_z_counts;
  motion.shown = motion.applied;
  if (pin_eoffset_enabled && motion.clear) {
    motion.asked = 0;
  } else if (pin_eoffset_enabled && on && pin_homed) {
    motion.asked += more * scale_of_axis;
  }
  pin_applied_z = motion.frozen ? 0 : motion.shown;
  pin_applied_x = pin_offset_x;
}

static int fail(const char *what, int course, int cycle) {
  printf("course %%d cycle %%d: %%s: wanted %%.5f applied %%.5f asked %%.5f counts %%d delivery %%u state %%u\\n", course, cycle, what,
         pin_offset_z, motion.applied, motion.asked, pin_offset_z_counts, pin_delivery, pin_state);
  return 1;
}

int main(void) {
  const long period = 1000000;
  int rests = 0, oks = 0;
  pin_enable = true;
  pin_eoffset_enabled = true;
  motion.limit = 1e9;
  for (int course = 0; course < %(courses)d; course++) {
    int calm = 0;
    srand(course);
    for (int cycle = 0; cycle < 4000; cycle++) {
      const bool last = cycle >= 2500; /* then everything is as it should be */
      if (!last && one_of(100) == 0) {
        switch (one_of(9)) {
          case 0: pin_machine_on = !pin_machine_on; break;
          case 1: pin_homed = !pin_homed; break;
          case 2: pin_eoffset_enabled = !pin_eoffset_enabled; break;
          case 3: motion.free = !motion.free; break;
          case 4: motion.clear = !motion.clear; break;
          case 5: motion.limit = one_of(2) ? 1e9 : between(-0.01, 0.01); break;
          case 6: pin_datum = !pin_datum; break;
          case 7: pin_temperature_t1 = between(20, 26); break;
          default: pin_enable = !pin_enable; break;
        }
        calm = 0;
      }
      if (last && cycle == 2500) {
        pin_machine_on = pin_homed = pin_eoffset_enabled = pin_enable = true;
        pin_datum = false;
        motion.free = motion.clear = false;
        motion.limit = 1e9;
        calm = 0;
      }
      if (course == 0 && cycle == 0) pin_temperature_t1 = pin_temperature_t2 = pin_temperature_t3 = 20;
      calm++;
      if (one_of(1000) != 0) { /* now and then a cycle is missed */
        component(&hal, period);
        if (pin_ok && !(fabs(pin_offset_z - pin_applied_z) <= 1.0001e-4)) return fail("ok, but not arrived", course, cycle);
        oks += pin_ok;
      }
      const double was = motion.applied;
      const bool was_on = motion.on;
      move();
      if (motion.on == was_on && motion.applied < motion.limit && fabs(motion.applied - was) > 0.0025)
        return fail("a jump", course, cycle);
      if (calm > 1400) {
        rests++;
        if (!(fabs(motion.applied - pin_offset_z) <= 1.0001e-4)) return fail("not arrived", course, cycle);
        if (pin_state == 2U && !pin_ok) return fail("arrived, but not ok", course, cycle);
      }
    }
  }
  printf("%%d courses: applied = wanted within a count in all of %%d cycles at rest; ok in %%d cycles\\n", %(courses)d, rests, oks);
  /* Pins that are not netted, or a scale that is not counts-scale: at most a count is ever tried. */
  for (int wrong = 0; wrong < 3; wrong++) {
    double most = 0;
    motion.frozen = wrong == 0;
    scale_of_axis = wrong == 0 ? 1e-4 : wrong == 1 ? -1e-4 : 1e-2;
    pin_machine_on = false;
    for (int cycle = 0; cycle < 20; cycle++) component(&hal, period), move();
    pin_machine_on = true;
    pin_temperature_t1 = pin_temperature_t1 > 23 ? 20.0 : 26.0;
    for (int cycle = 0; cycle < 20000; cycle++) {
      component(&hal, period);
      move();
      most = fabs(motion.applied) > most ? fabs(motion.applied) : most;
      if (cycle > 1000 && pin_ok) return fail("ok, but in vain", wrong, cycle);
    }
    printf("%%s: axis away by at most %%.4f mm in 20 s, delivery %%u\\n",
           wrong == 0 ? "applied not netted" : wrong == 1 ? "scale of the other sign" : "scale 100 times as large", most, pin_delivery);
    if (most > (wrong == 2 ? 100 : 1) * 1.0001e-4) return 1;
  }
  return 0;
}
"""

text = subprocess.run([thermfit, "export", model, "--target", "linuxcnc", "--period", "0.001", "--slew", "200", "--domain", "ignore"],
                      capture_output=True, text=True, check=True).stdout
program = hal_component.build(text, MAIN % {"courses": COURSES}, os.path.join(work, "increments"))
done = subprocess.run([program], capture_output=True, text=True)
print(done.stdout.strip())
sys.exit(done.returncode)
