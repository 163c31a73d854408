#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#ifdef THERMFIT_HAS_ZLIB
#include <zlib.h>
#endif

#include "thermfit/error.hpp"

namespace thermfit {

/// The bytes of a file, or of standard input for the path `-`. Gzip is known by its first two bytes, not by its name.
class ByteSource {
 public:
  /// Throws Error with the system's reason when the file cannot be opened or read.
  explicit ByteSource(const std::string& path)
      : name_(path == "-" ? "stdin" : path),
        descriptor_(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) throw Error(name_, std::strerror(errno), "a file that can be read");
    try {
      start();
    } catch (...) {
      close();
      throw;
    }
  }
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  ~ByteSource() { close(); }

  const std::string& name() const { return name_; }  ///< path, or `stdin`
  bool compressed() const { return compressed_; }    ///< whether it is gzip, which read() inflates

  /// Up to `capacity` bytes; 0 only at the end. Throws Error on a failed read or broken compressed data.
  std::size_t read(char* to, std::size_t capacity) {
    if (compressed_) return inflate_some(to, capacity);
    if (ahead_begin_ == ahead_end_) return read_raw(to, capacity);
    const std::size_t count = std::min(capacity, ahead_end_ - ahead_begin_);
    std::memcpy(to, ahead_.data() + ahead_begin_, count);
    ahead_begin_ += count;
    return count;
  }

 private:
  static constexpr std::size_t block_bytes = std::size_t{1} << 16;

  void start() {
    ahead_.resize(block_bytes);
    while (ahead_end_ < 2) {
      const std::size_t count = read_raw(ahead_.data() + ahead_end_, ahead_.size() - ahead_end_);
      if (count == 0) return;
      ahead_end_ += count;
    }
    compressed_ = ahead_[0] == '\x1f' && ahead_[1] == '\x8b';
#ifdef THERMFIT_HAS_ZLIB
    if (compressed_ && inflateInit2(&stream_, 16 + MAX_WBITS) != Z_OK) throw Error(name_, "zlib does not start");
#else
    if (compressed_)
      throw Error(name_, "is gzip, and this thermfit was built without zlib", "plain text",
                  "zcat " + name_ + " | thermfit … -");
#endif
  }

  std::size_t read_raw(char* to, std::size_t capacity) {
    for (;;) {
      const ssize_t count = ::read(descriptor_, to, capacity);
      if (count >= 0) return static_cast<std::size_t>(count);
      if (errno != EINTR) throw Error(name_, std::strerror(errno), "a file that can be read");
    }
  }

#ifdef THERMFIT_HAS_ZLIB
  std::size_t inflate_some(char* to, std::size_t capacity) {
    stream_.next_out = reinterpret_cast<Bytef*>(to);
    stream_.avail_out = static_cast<uInt>(std::min<std::size_t>(capacity, 1u << 30));
    const uInt wanted = stream_.avail_out;
    while (stream_.avail_out == wanted) {
      if (ahead_begin_ == ahead_end_) {
        ahead_begin_ = 0;
        ahead_end_ = read_raw(ahead_.data(), ahead_.size());
        if (ahead_end_ == 0) {
          if (between_members_) return 0;
          throw Error(name_, "the compressed data end in the middle", "a whole gzip file", "copy the file again");
        }
      }
      if (between_members_ && inflateReset(&stream_) != Z_OK) throw broken();
      between_members_ = false;
      stream_.next_in = reinterpret_cast<Bytef*>(ahead_.data() + ahead_begin_);
      stream_.avail_in = static_cast<uInt>(ahead_end_ - ahead_begin_);
      const int status = inflate(&stream_, Z_NO_FLUSH);
      ahead_begin_ = ahead_end_ - stream_.avail_in;
      if (status == Z_STREAM_END)
        between_members_ = true;  // gzip files may be joined end to end
      else if (status != Z_OK && status != Z_BUF_ERROR)
        throw broken();
    }
    return wanted - stream_.avail_out;
  }

  Error broken() const {
    return Error(name_, std::string("broken gzip data") + (stream_.msg ? std::string(": ") + stream_.msg : ""),
                 "a whole gzip file", "copy the file again");
  }

  z_stream stream_{};
  bool between_members_ = false;
#else
  std::size_t inflate_some(char*, std::size_t) { return 0; }
#endif

  void close() noexcept {
#ifdef THERMFIT_HAS_ZLIB
    if (compressed_) inflateEnd(&stream_);
#endif
    if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
  }

  std::string name_;
  int descriptor_;
  bool compressed_ = false;
  std::vector<char> ahead_;  ///< bytes read but not yet handed out
  std::size_t ahead_begin_ = 0, ahead_end_ = 0;
};

}  // namespace thermfit
