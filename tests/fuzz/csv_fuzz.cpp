/// Any bytes as a CSV file: they are read or refused with an Error, by every policy, and what was read survives being
/// written and read again. With libFuzzer, or as a program that replays files and folders.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "thermfit/findings/findings.hpp"
#include "thermfit/io/csv/reader.hpp"
#include "thermfit/io/csv/writer.hpp"

#ifndef THERMFIT_LIBFUZZER
#include "replay.hpp"
#endif

namespace {

/// A file in memory with a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view text) : descriptor_(::memfd_create("csv", 0)) {
    while (!text.empty()) {
      const ssize_t written = ::write(descriptor_, text.data(), text.size());
      if (written <= 0) std::abort();
      text.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(descriptor_); }
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

void check(const thermfit::Campaign& campaign) {
  for (const thermfit::Batch& batch : campaign) {
    require(batch.rows() > 0, "a batch without rows");
    require(batch.temperatures.count() > 0, "a batch without temperatures");
    if (batch.rows() < 500 && batch.temperatures.count() < 30) thermfit::find_faults(batch);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const MemoryFile file(text);
  thermfit::CsvOptions strict, drop, hold, keep, logger;
  strict.max_line_bytes = 1 << 14;
  drop.missing = thermfit::MissingValues::drop;
  drop.batch_column = "run";
  hold.missing = thermfit::MissingValues::hold;
  hold.temperatures = {"*"};
  hold.max_errors = 1;
  keep.missing = thermfit::MissingValues::keep;
  keep.increasing_time = false;
  keep.columns = {"time_s", "T1 [degF]", "Z"};
  keep.separator = ';';
  hold.between = thermfit::BetweenSamples::held;
  logger.dialect = "halsampler";
  logger.columns = {"T1", "Z"};
  logger.time_step_s = 0.5;
  logger.thousands = '\'';
  for (const thermfit::CsvOptions& options : {drop, hold, keep, logger}) {
    try {
      check(thermfit::read_campaign({file.path()}, options).batches);
    } catch (const thermfit::Error& error) {
      require(*error.what() != 0, "an error that says nothing");
    }
  }
  try {
    const thermfit::CsvReading reading = thermfit::read_campaign({file.path()}, strict);
    check(reading.batches);
    reading.notes(strict);
    const thermfit::Batch& batch = reading.batches.front();
    const MemoryFile copy(thermfit::write_csv(batch));
    thermfit::CsvOptions again;
    again.inputs = std::vector<std::string>{};
    const thermfit::Batch second = thermfit::read_campaign({copy.path()}, again).batches.front();
    require(second.time_s == batch.time_s, "time changed in a round trip");
    require(second.temperatures.values == batch.temperatures.values, "temperatures changed in a round trip");
    require(second.errors.values == batch.errors.values, "errors changed in a round trip");
  } catch (const thermfit::Error& error) {
    require(*error.what() != 0, "an error that says nothing");
  }
  return 0;
}
