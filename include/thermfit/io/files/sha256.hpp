#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "thermfit/io/files/sha256_blocks.hpp"

namespace thermfit {

/// SHA-256 (FIPS 180-4) fed in pieces: `update` as often as needed, then `hex` once. Does not allocate until `hex`.
class Sha256 {
 public:
  /// Feeds `bytes` behind those fed before. Does not allocate.
  void update(std::string_view bytes) {
    length_ += bytes.size();
    while (!bytes.empty()) {
      const std::size_t whole = filled_ == 0 ? bytes.size() / block_.size() : 0;
      std::size_t taken = whole * block_.size();
      if (whole > 0) {
        detail::sha256_blocks(state_, reinterpret_cast<const unsigned char*>(bytes.data()), whole);
      } else {
        taken = std::min(bytes.size(), block_.size() - filled_);
        std::memcpy(block_.data() + filled_, bytes.data(), taken);
        filled_ = (filled_ + taken) % block_.size();
        if (filled_ == 0) detail::sha256_blocks(state_, block_.data(), 1);
      }
      bytes.remove_prefix(taken);
    }
  }

  /// 64 lower-case hexadecimal digits of everything fed so far; the object is spent afterwards.
  std::string hex() {
    const std::uint64_t bits = length_ * 8;
    update(std::string_view("\x80", 1));
    while (filled_ != 56) update(std::string_view("\0", 1));
    std::array<char, 8> length_bytes;
    for (std::size_t i = 0; i < 8; ++i) length_bytes[i] = static_cast<char>(bits >> (56 - 8 * i));
    update({length_bytes.data(), length_bytes.size()});
    std::string text;
    for (const std::uint32_t word : state_)
      for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[(word >> shift) & 15U];
    return text;
  }

 private:
  detail::Sha256State state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                             0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> block_{};
  std::size_t filled_ = 0;
  std::uint64_t length_ = 0;
};

/// SHA-256 of `bytes` as 64 lower-case hexadecimal digits.
inline std::string sha256_hex(std::string_view bytes) {
  Sha256 hash;
  hash.update(bytes);
  return hash.hex();
}

}  // namespace thermfit
