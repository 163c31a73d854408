/// All of the controller headers in one object, as a controller would build them: its symbols, size and stack are
/// judged.

#include "walk_float.hpp"

namespace {
walk_float::Compensator device(walk_float::model, walk_float::settings);
}

extern "C" bool controller_start() { return device.start(); }
extern "C" bool controller_resume(const walk_float::Compensator::Offsets& offsets,
                                  const walk_float::Compensator::Retained& retained) {
  return device.resume(retained, offsets);
}
extern "C" void controller_retain(walk_float::Compensator::Retained& retained) { retained = device.retained(); }
extern "C" void controller_datum() { device.take_datum(); }
extern "C" void controller_stop() { device.stop(); }
extern "C" std::uint32_t controller_step(const walk_float::Compensator::Temperatures& readings) {
  return device.step(readings).word;
}
#ifdef WALK_TRANSFER
extern "C" bool controller_probe(std::size_t error, float measured_um) {
  return device.probe(error, measured_um) == thermfit::ProbeReading::taken;
}
#endif
extern "C" float controller_offset(std::size_t error) { return device.offset_um()[error]; }
