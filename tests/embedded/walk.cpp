/// The same random walk through the C++ compensator and the C export, in float and double: prints a hash of all offsets
/// and status words, on the host and, started by startup.cpp, on a Cortex-M.

#include "embedded/random_walk.hpp"
#include "walk_double.hpp"
#include "walk_float.hpp"

void write_text(const char* text);  // stdout of the host, semihosting of the emulated controller

extern "C" {
void walk_float_c_initialise();
void walk_float_c_start(const float*, const float*);
void walk_float_c_stop();
std::uint32_t walk_float_c_step(const float*, float*);
std::uint32_t walk_float_c_self_test();
void walk_double_c_initialise();
void walk_double_c_start(const double*, const double*);
void walk_double_c_stop();
std::uint32_t walk_double_c_step(const double*, double*);
std::uint32_t walk_double_c_self_test();
}

namespace {

template <class Scalar>
struct Functions {
  void (*start)(const Scalar*, const Scalar*);
  void (*stop)();
  std::uint32_t (*step)(const Scalar*, Scalar*);
};

template <class Device, class Scalar>
struct CppSubject {
  Device& device;
  std::uint32_t status = 0;
  void start() { device.start(); }
  void start(const typename Device::Offsets& offsets) { device.start(offsets); }
  void start(const typename Device::Offsets& offsets, const typename Device::Temperatures& zero) {
    device.start(offsets, zero);
  }
  void stop() { device.stop(); }
  void step(const typename Device::Temperatures& readings) { status = device.step(readings).word; }
  const typename Device::Offsets& offsets() const { return device.offset_um(); }
};

template <class Scalar>
struct CSubject {
  Functions<Scalar> functions;
  std::array<Scalar, 2> offset_um{};
  std::uint32_t status = 0;
  void start() { functions.start(nullptr, nullptr); }
  void start(const std::array<Scalar, 2>& offsets) { functions.start(offsets.data(), nullptr); }
  void start(const std::array<Scalar, 2>& offsets, const std::array<Scalar, 3>& zero) {
    functions.start(offsets.data(), zero.data());
  }
  void stop() { functions.stop(); }
  void step(const std::array<Scalar, 3>& readings) { status = functions.step(readings.data(), offset_um.data()); }
  const std::array<Scalar, 2>& offsets() const { return offset_um; }
};

template <class Scalar, class Subject>
void walk(const char* name, Subject subject) {
  random_walk::Hash hash;
  random_walk::run<Scalar, 3, 2>(subject, WALK_STEPS, [&] {
    for (const Scalar offset : subject.offsets()) hash.add(offset);
    hash.add(subject.status);
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
  walk<float>("float c++  ", CppSubject<walk_float::Compensator, float>{float_device});
  walk<float>("float c    ", CSubject<float>{{walk_float_c_start, walk_float_c_stop, walk_float_c_step}});
  walk<double>("double c++ ", CppSubject<walk_double::Compensator, double>{double_device});
  walk<double>("double c   ", CSubject<double>{{walk_double_c_start, walk_double_c_stop, walk_double_c_step}});
  const bool passed = walk_float_c_self_test() == 0 && walk_double_c_self_test() == 0;
  write_text(passed ? "self tests passed\n" : "self tests FAILED\n");
  return passed ? 0 : 1;
}
