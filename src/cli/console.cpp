#include "cli/console.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "thermfit/error.hpp"
#include "thermfit/io/files/atomic_file.hpp"

namespace thermfit::cli {

void Console::note(std::string_view text) const {
  progress({});
  std::string line = "thermfit: ";
  line += wording_ ? wording_(text) : std::string(text);
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

bool Console::flush() {
  // A closed pipe: the reader had enough (head); that is its right.
  const bool arrived = detail::write_all(STDOUT_FILENO, result_);
  if (!arrived && errno != EPIPE)
    throw Error("standard output", std::strerror(errno), "", "the result is not complete");
  result_.clear();
  return arrived;
}

void Console::finish() {
  progress({});
  if (path_.empty())
    flush();
  else
    write_atomically(path_, result_);
}

}  // namespace thermfit::cli
