#include "cli/console.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "thermfit/error.hpp"
#include "thermfit/io/atomic_file.hpp"

namespace thermfit::cli {
namespace {

/// Every byte to a file descriptor, or the reason why not.
void write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0 && errno == EPIPE) return;  // the reader had enough (head); that is its right
    if (written <= 0) throw Error("standard output", std::strerror(errno), "", "the result is not complete");
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

void Console::note(std::string_view text) const {
  progress({});
  std::string line = "thermfit: ";
  line += text;
  line += '\n';
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, line.data(), line.size());
}

void Console::progress(std::string_view text) const {
  if (!::isatty(STDERR_FILENO)) return;
  std::string line = "\r\033[K";
  line += text;
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, line.data(), line.size());
}

std::string Console::strong(std::string_view text) const {
  const char* no_color = std::getenv("NO_COLOR");
  if (!path_.empty() || (no_color && *no_color) || !::isatty(STDOUT_FILENO)) return std::string(text);
  return "\033[1m" + std::string(text) + "\033[0m";
}

void Console::flush() {
  write_all(STDOUT_FILENO, result_);
  result_.clear();
}

void Console::finish() {
  progress({});
  if (path_.empty())
    flush();
  else
    write_atomically(path_, result_);
}

}  // namespace thermfit::cli
