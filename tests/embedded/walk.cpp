/// The same random walk through the C++ compensator and the C export, in float and double: prints a hash of all
/// offsets, status words and zeros, on the host and, started by startup.cpp, on a Cortex-M.

#include "embedded/random_walk.hpp"
#include "walk_double.hpp"
#include "walk_float.hpp"

void write_text(const char* text);  // stdout of the host, semihosting of the emulated controller

#define C_EXPORT(name, real)                                                                       \
  void name##_c_initialise();                                                                      \
  void name##_c_start(const real*);                                                                \
  void name##_c_resume(const name::Compensator::Retained*, const real*);                           \
  void name##_c_retain(name::Compensator::Retained*);                                              \
  void name##_c_datum();                                                                           \
  void name##_c_stop();                                                                            \
  void name##_c_probe(std::uint32_t, real);                                                        \
  std::uint32_t name##_c_step(const real*, std::uint32_t periods, std::uint32_t heartbeat, real*); \
  std::uint32_t name##_c_self_test();

#define C_FUNCTIONS(name) \
  { name##_c_start, name##_c_resume, name##_c_retain, name##_c_datum, name##_c_stop, name##_c_probe, name##_c_step }

extern "C" {
C_EXPORT(walk_float, float)
C_EXPORT(walk_double, double)
}

namespace {

/// Of both languages: the zero is the same plain data, byte for byte.
template <class Device, class Scalar>
struct Functions {
  void (*start)(const Scalar*);
  void (*resume)(const typename Device::Retained*, const Scalar*);
  void (*retain)(typename Device::Retained*);
  void (*datum)();
  void (*stop)();
  void (*probe)(std::uint32_t, Scalar);
  std::uint32_t (*step)(const Scalar*, std::uint32_t, std::uint32_t, Scalar*);
};

/// What was retained, with another zero.
template <class Device>
typename Device::Retained sealed(typename Device::Retained kept, const typename Device::Temperatures& zero,
                                 std::uint32_t identity) {
  kept.zero_degC = zero;
  kept.seal(identity);
  return kept;
}

template <class Device>
struct CppSubject {
  Device& device;
  std::uint32_t identity, status = 0;
  void start() { device.start(); }
  void start(const typename Device::Offsets& offsets) { device.start(offsets); }
  void start(const typename Device::Offsets& offsets, const typename Device::Temperatures& zero) {
    device.resume(sealed<Device>(retained(), zero, identity), offsets, 100);
  }
  void datum() { device.take_datum(); }
  void stop() { device.stop(); }
  void probe([[maybe_unused]] std::size_t error, [[maybe_unused]] typename Device::Offsets::value_type measured_um) {
#ifdef WALK_TRANSFER
    device.probe(error, measured_um);
#endif
  }
  void step(const typename Device::Temperatures& readings, std::uint32_t periods, std::uint32_t heartbeat) {
    status = device.step(readings, {periods, heartbeat}).word;
  }
  const typename Device::Offsets& offsets() const { return device.offset_um(); }
  typename Device::Retained retained() const { return device.retained(); }
};

template <class Device, class Scalar>
struct CSubject {
  Functions<Device, Scalar> functions;
  std::uint32_t identity, status = 0;
  typename Device::Offsets offset_um{};
  void start() { functions.start(nullptr); }
  void start(const typename Device::Offsets& offsets) { functions.start(offsets.data()); }
  void start(const typename Device::Offsets& offsets, const typename Device::Temperatures& zero) {
    const auto kept = sealed<Device>(retained(), zero, identity);
    functions.resume(&kept, offsets.data());
  }
  void datum() { functions.datum(); }
  void stop() { functions.stop(); }
  void probe(std::size_t error, Scalar measured_um) { functions.probe(static_cast<std::uint32_t>(error), measured_um); }
  void step(const typename Device::Temperatures& readings, std::uint32_t periods, std::uint32_t heartbeat) {
    status = functions.step(readings.data(), periods, heartbeat, offset_um.data());
  }
  const typename Device::Offsets& offsets() const { return offset_um; }
  typename Device::Retained retained() const {
    typename Device::Retained kept;
    functions.retain(&kept);
    return kept;
  }
};

template <class Scalar, class Subject>
void walk(const char* name, Subject subject) {
  random_walk::Hash hash;
  random_walk::run<Scalar, 3, 2>(subject, WALK_STEPS, [&] {
    for (const Scalar offset : subject.offsets()) hash.add(offset);
    hash.add(subject.status);
    const auto kept = subject.retained();
    hash.add(kept.mark), hash.add(kept.through_zero), hash.add(kept.digest);
  });
  char digits[] = "00000000\n";
  for (int i = 0; i < 8; ++i) digits[i] = "0123456789abcdef"[hash.value() >> (28 - 4 * i) & 15u];
  write_text(name);
  write_text(digits);
}

}  // namespace

int main() {
  walk_float::Compensator float_device(walk_float::model, walk_float::settings);
  walk_double::Compensator double_device(walk_double::model, walk_double::settings);
  walk_float_c_initialise();
  walk_double_c_initialise();
  walk<float>("float c++  ", CppSubject<walk_float::Compensator>{float_device, walk_float::model.identity});
  walk<float>("float c    ",
              CSubject<walk_float::Compensator, float>{C_FUNCTIONS(walk_float), walk_float::model.identity});
  walk<double>("double c++ ", CppSubject<walk_double::Compensator>{double_device, walk_double::model.identity});
  walk<double>("double c   ",
               CSubject<walk_double::Compensator, double>{C_FUNCTIONS(walk_double), walk_double::model.identity});
  const bool passed = walk_float_c_self_test() == 0 && walk_double_c_self_test() == 0;
  write_text(passed ? "self tests passed\n" : "self tests FAILED\n");
  return passed ? 0 : 1;
}
