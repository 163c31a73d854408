/* The two C exports behind plain functions, so that the walk can call what a C compiler made of them. */
#define WALK_FLOAT_SELF_TEST
#define WALK_FLOAT_SELF_TEST_TOLERANCE 0
#define WALK_DOUBLE_SELF_TEST
#define WALK_DOUBLE_SELF_TEST_TOLERANCE 0
#include "walk_double.h"
#include "walk_float.h"

/* A model of the method transfer is told how long the power was off, and takes readings of a probe. */
#ifdef WALK_TRANSFER
#define RESUME(name, retained, offset_um) name##_resume_after(&name##_device, retained, 100U, offset_um)
#define PROBE(name, error, measured_um) (void)name##_probe(&name##_device, error, measured_um)
#else
#define RESUME(name, retained, offset_um) name##_resume(&name##_device, retained, offset_um)
#define PROBE(name, error, measured_um) (void)error, (void)measured_um
#endif

#define WRAP(name, real)                                                                                         \
  static name##_compensator name##_device;                                                                       \
  void name##_c_initialise(void);                                                                                \
  void name##_c_start(const real* offset_um);                                                                    \
  void name##_c_resume(const name##_retained* retained, const real* offset_um);                                  \
  void name##_c_retain(name##_retained* retained);                                                               \
  void name##_c_datum(void);                                                                                     \
  void name##_c_stop(void);                                                                                      \
  uint32_t name##_c_step(const real* temperatures_degC, uint32_t periods, uint32_t heartbeat, real* offset_um);  \
  uint32_t name##_c_self_test(void);                                                                             \
  void name##_c_initialise(void) { name##_initialise(&name##_device); }                                          \
  void name##_c_start(const real* offset_um) { name##_start(&name##_device, offset_um); }                        \
  void name##_c_resume(const name##_retained* retained, const real* offset_um) {                                 \
    RESUME(name, retained, offset_um);                                                                           \
  }                                                                                                              \
  void name##_c_retain(name##_retained* retained) { name##_retain(&name##_device, retained); }                   \
  void name##_c_datum(void) { name##_datum(&name##_device); }                                                    \
  void name##_c_stop(void) { name##_stop(&name##_device); }                                                      \
  void name##_c_probe(uint32_t error, real measured_um);                                                         \
  void name##_c_probe(uint32_t error, real measured_um) { PROBE(name, error, measured_um); }                     \
  uint32_t name##_c_step(const real* temperatures_degC, uint32_t periods, uint32_t heartbeat, real* offset_um) { \
    return name##_step_after(&name##_device, temperatures_degC, periods, heartbeat, offset_um);                  \
  }                                                                                                              \
  uint32_t name##_c_self_test(void) { return name##_self_test(); }

WRAP(walk_float, float)
WRAP(walk_double, double)
