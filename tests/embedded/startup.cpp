/// The least a Cortex-M needs before main: vectors, data, the floating point unit; and output through the debugger.

#include <cstdint>

int main();

extern "C" {
extern std::uint32_t stack_top, data_source, data_begin, data_end, bss_begin, bss_end;
void reset();
}

namespace {

constexpr int semihosting_write0 = 0x04, semihosting_exit = 0x18;
constexpr std::uintptr_t exit_done = 0x20026, exit_failed = 0x20023;

void semihosting(int operation, std::uintptr_t argument) {
  register int r0 asm("r0") = operation;
  register std::uintptr_t r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void fault() {
  semihosting(semihosting_write0, reinterpret_cast<std::uintptr_t>("fault\n"));
  semihosting(semihosting_exit, exit_failed);
}

}  // namespace

void write_text(const char* text) { semihosting(semihosting_write0, reinterpret_cast<std::uintptr_t>(text)); }

void reset() {
#if defined(__ARM_FP)
  *reinterpret_cast<volatile std::uint32_t*>(0xe000ed88) |= 0xfu << 20;
  asm volatile("dsb\nisb");
#endif
  for (std::uint32_t *from = &data_source, *to = &data_begin; to < &data_end;) *to++ = *from++;
  for (std::uint32_t* to = &bss_begin; to < &bss_end;) *to++ = 0;
  semihosting(semihosting_exit, main() == 0 ? exit_done : exit_failed);
  for (;;) {
  }
}

using Handler = void (*)();
__attribute__((section(".vectors"), used))
const Handler vectors[] = {reinterpret_cast<Handler>(&stack_top), reset, fault, fault, fault, fault, fault};
