#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "thermfit/error.hpp"

namespace thermfit {

namespace detail {

/// Every byte to a file descriptor; false, with the reason in errno, where that fails.
inline bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace detail

/// Writes `text` to `path` so that a reader sees either the old file or the whole new one: a temporary file beside it,
/// flushed to disk, then renamed. Devices and pipes (`/dev/stdout`, `/dev/full`) are written to directly, since
/// replacing them is not meant. Throws Error with the system's reason; the old file is then intact and no temporary
/// file is left.
inline void write_atomically(const std::string& path, std::string_view text) {
  struct stat status {};
  const bool replaces_file = ::stat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode);
  std::string target = replaces_file ? path + ".thermfit-XXXXXX" : path;
  const int descriptor = replaces_file ? ::mkstemp(target.data()) : ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) throw Error(path, std::strerror(errno), "", "choose a folder that exists and can be written");
  try {
    if (!detail::write_all(descriptor, text)) throw Error(path, std::strerror(errno), "", "the file was not changed");
    if (replaces_file) {
      const mode_t mask = ::umask(0);
      ::umask(mask);
      const mode_t mode = status.st_mode ? status.st_mode & 07777 : 0666 & ~mask;
      if (::fchmod(descriptor, mode) != 0 || ::fsync(descriptor) != 0) throw Error(path, std::strerror(errno));
    }
  } catch (...) {
    ::close(descriptor);
    if (replaces_file) ::unlink(target.c_str());
    throw;
  }
  const bool closed = ::close(descriptor) == 0;
  if (!replaces_file) return;
  if (!closed || std::rename(target.c_str(), path.c_str()) != 0) {
    const std::string reason = std::strerror(errno);
    ::unlink(target.c_str());
    throw Error(path, reason, "", "the file was not changed");
  }
}

}  // namespace thermfit
