#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include "thermfit/batch/batch.hpp"
#include "thermfit/io/files/sha256.hpp"

namespace thermfit {

/// SHA-256 of what a batch measured: for time and every channel its name, a NUL, and its values as little-endian IEEE
/// doubles, row by row. The same numbers give the same digest from any file, dialect, path or unit.
inline std::string batch_digest(const Batch& batch) {
  Sha256 digest;
  std::string bytes;
  const auto add = [&](const std::string& name, const double* values, Index count) {
    bytes.assign(name).push_back('\0');
    const std::size_t begin = bytes.size();
    bytes.resize(begin + 8 * static_cast<std::size_t>(count));
    char* to = bytes.data() + begin;
    for (Index row = 0; row < count; ++row) {
      std::uint64_t bits;
      const double value = values[row] + 0.0;  // -0 counts as 0
      std::memcpy(&bits, &value, sizeof bits);
      for (int shift = 0; shift < 64; shift += 8) *to++ = static_cast<char>(bits >> shift);
    }
    digest.update(bytes);
  };
  add("time_s", batch.time_s.data(), batch.time_s.size());
  for (const Channels* channels : {&batch.temperatures, &batch.errors, &batch.inputs})
    for (Index c = 0; c < channels->count(); ++c)
      add(channels->names[static_cast<std::size_t>(c)], channels->values.data() + c * channels->values.rows(),
          channels->values.rows());
  if (batch.first_degC.size() > 0) add("first_degC", batch.first_degC.data(), batch.first_degC.size());
  return digest.hex();
}

}  // namespace thermfit
