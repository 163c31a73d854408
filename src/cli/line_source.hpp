#pragma once

#include <cstddef>
#include <string>

namespace thermfit::cli {

/// Lines from a file descriptor as they arrive, with a time-out. Lines longer than 1 MB are cut, not kept.
class LineSource {
 public:
  explicit LineSource(int descriptor) : descriptor_(descriptor) {}

  enum class Got { line, nothing, end };

  /// The next line without its end (LF or CRLF). Waits at most `timeout_s` seconds, or for ever when that is 0; a last
  /// line without an end counts. Throws Error when reading fails.
  Got next(std::string& line, double timeout_s);

  std::size_t line_number() const { return line_number_; }

 private:
  bool take_line(std::string& line);

  int descriptor_;
  std::string buffer_;
  std::size_t searched_ = 0, line_number_ = 0;
  bool ended_ = false, overlong_ = false;
};

}  // namespace thermfit::cli
