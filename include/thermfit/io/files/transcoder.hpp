#pragma once

#include <iconv.h>

#include <cerrno>
#include <string>
#include <string_view>

#include "thermfit/error.hpp"

namespace thermfit {

/// Text of another encoding as UTF-8, block by block, by the system's iconv.
class Transcoder {
 public:
  /// Throws Error, which names `path`, when the system knows no such encoding. Allocates.
  Transcoder(const std::string& encoding, std::string path)
      : path_(std::move(path)), encoding_(encoding), state_(::iconv_open("UTF-8", encoding.c_str())) {
    if (state_ == reinterpret_cast<iconv_t>(-1))
      throw Error(path_, "no encoding is called '" + encoding + "'",
                  "names that iconv knows: latin1, gb18030, utf-16, …");
  }
  Transcoder(const Transcoder&) = delete;
  Transcoder& operator=(const Transcoder&) = delete;
  ~Transcoder() { ::iconv_close(state_); }

  /// Appends a block to `to`; bytes of a character that is cut wait for the next block. Throws Error at bytes that are
  /// none of the encoding, and at the end (an empty block) when such bytes are left. Allocates.
  void append(std::string_view block, std::string& to) {
    if (block.empty() && !waiting_.empty()) throw broken();
    waiting_ += block;
    char* from = waiting_.data();
    std::size_t left = waiting_.size();
    char buffer[4096];
    while (left > 0) {
      char* at = buffer;
      std::size_t room = sizeof buffer;
      const bool whole = ::iconv(state_, &from, &left, &at, &room) != static_cast<std::size_t>(-1);
      const int reason = errno;
      to.append(buffer, static_cast<std::size_t>(at - buffer));
      if (whole || reason == E2BIG) continue;
      if (reason == EINVAL) break;
      throw broken();
    }
    waiting_.erase(0, waiting_.size() - left);
  }

 private:
  Error broken() const {
    return Error(path_, "holds bytes that are no text in " + encoding_, "text in one encoding", "is it another one?");
  }

  std::string path_, encoding_, waiting_;
  iconv_t state_;
};

}  // namespace thermfit
