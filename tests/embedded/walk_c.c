/* The two C exports behind plain functions, so that the walk can call what a C compiler made of them. */
#define WALK_FLOAT_SELF_TEST
#define WALK_FLOAT_SELF_TEST_TOLERANCE 0
#define WALK_DOUBLE_SELF_TEST
#define WALK_DOUBLE_SELF_TEST_TOLERANCE 0
#include "walk_double.h"
#include "walk_float.h"

#define WRAP(name, real)                                                   \
  static name##_compensator name##_device;                                 \
  void name##_c_initialise(void);                                          \
  void name##_c_start(const real* offset_um, const real* zero_degC);       \
  void name##_c_stop(void);                                                \
  uint32_t name##_c_step(const real* temperatures_degC, real* offset_um);  \
  uint32_t name##_c_self_test(void);                                       \
  void name##_c_initialise(void) { name##_initialise(&name##_device); }    \
  void name##_c_start(const real* offset_um, const real* zero_degC) {      \
    name##_start(&name##_device, offset_um, zero_degC);                    \
  }                                                                        \
  void name##_c_stop(void) { name##_stop(&name##_device); }                \
  uint32_t name##_c_step(const real* temperatures_degC, real* offset_um) { \
    return name##_step(&name##_device, temperatures_degC, offset_um);      \
  }                                                                        \
  uint32_t name##_c_self_test(void) { return name##_self_test(); }

WRAP(walk_float, float)
WRAP(walk_double, double)
