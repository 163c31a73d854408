#include "cli/line_source.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>

#include "thermfit/error.hpp"

namespace thermfit::cli {

bool LineSource::take_line(std::string& line) {
  constexpr std::size_t longest = 1 << 20;
  const std::size_t end = buffer_.find('\n', searched_);
  if (end == std::string::npos) {
    searched_ = buffer_.size();
    if (searched_ > longest) {  // forget what is there; the rest of the line will not fit the header
      overlong_ = true;
      buffer_.clear();
      searched_ = 0;
    }
    return false;
  }
  line = overlong_ ? std::string("\"") : buffer_.substr(0, end);
  if (!line.empty() && line.back() == '\r') line.pop_back();
  buffer_.erase(0, end + 1);
  searched_ = 0;
  overlong_ = false;
  ++line_number_;
  return true;
}

LineSource::Got LineSource::next(std::string& line, double timeout_s) {
  using Clock = std::chrono::steady_clock;
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_s));
  for (;;) {
    if (take_line(line)) return Got::line;
    if (ended_) {
      if (buffer_.empty() && !overlong_) return Got::end;
      buffer_ += '\n';
      continue;
    }
    if (timeout_s > 0) {
      const double left_s = std::chrono::duration<double>(deadline - Clock::now()).count();
      pollfd waiting{descriptor_, POLLIN, 0};
      const int ready = ::poll(&waiting, 1, static_cast<int>(std::ceil(std::max(0., left_s) * 1000)));
      if (ready == 0) return Got::nothing;
      if (ready < 0 && errno == EINTR) continue;
    }
    char block[65536];
    const ssize_t count = ::read(descriptor_, block, sizeof block);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw Error("standard input", std::strerror(errno));
    if (count == 0) ended_ = true;
    buffer_.append(block, static_cast<std::size_t>(count));
  }
}

}  // namespace thermfit::cli
