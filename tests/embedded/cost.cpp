/// What a step costs of a model on derived channels and of a plain one on the same sensors: instructions on an emulated
/// Cortex-M, whose clock qemu drives by them (-icount shift=0: one a nanosecond), nanoseconds on the host.

#include "cost_plain.hpp"
#include "cost_transfer.hpp"

void write_text(const char* text);

#ifdef __arm__
namespace {
volatile std::uint32_t& tick_control = *reinterpret_cast<volatile std::uint32_t*>(0xe000e010);
volatile std::uint32_t& tick_reload = *reinterpret_cast<volatile std::uint32_t*>(0xe000e014);
volatile std::uint32_t& tick_now = *reinterpret_cast<volatile std::uint32_t*>(0xe000e018);
constexpr std::uint32_t steps = 500;

void start_clock() {
  tick_reload = 0xffffff;
  tick_now = 0;
  tick_control = 5;
}
/// In a clock of 25 MHz: 40 instructions a tick.
std::uint32_t since() { return (0xffffff - tick_now) * 40u; }
}  // namespace
#else
#include <chrono>
namespace {
std::chrono::steady_clock::time_point begin;
constexpr std::uint32_t steps = 200000;
void start_clock() { begin = std::chrono::steady_clock::now(); }
std::uint32_t since() {
  return static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - begin).count());
}
}  // namespace
#endif

namespace {

template <class Device>
void cost(const char* name, const typename Device::Model& model, const typename Device::Settings& settings) {
  Device device(model, settings);
  device.start();
  device.take_datum();
  typename Device::Temperatures readings{};
  std::uint32_t of_all = 0;
  for (std::uint32_t n = 0; n < 20 + steps; ++n) {
    for (std::size_t i = 0; i < readings.size(); ++i)
      readings[i] = 24 + static_cast<float>((n < 20 ? 0 : n * (i + 3)) % 64) / 256;
    if (n == 20) start_clock();
    device.step(readings);
  }
  of_all = since();
  char digits[] = "       0\n";
  std::uint32_t each = of_all / steps;
  for (int at = 7; at >= 0 && each > 0; --at, each /= 10) digits[at] = static_cast<char>('0' + each % 10);
  write_text(device.state() == thermfit::CompensatorState::tracking ? name : "NOT TRACKING ");
  write_text(digits);
}

}  // namespace

int main() {
  for (int again = 0; again < 3; ++again) {
    cost<cost_plain::Compensator>("plain    ", cost_plain::model, cost_plain::settings);
    cost<cost_transfer::Compensator>("transfer ", cost_transfer::model, cost_transfer::settings);
  }
  return 0;
}
