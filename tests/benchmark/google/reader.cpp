// Reading a file of 100,000 rows x (time, ten temperatures, one error): whole batches with their digest, and moments
// alone in constant memory. bytes_per_second is text read.
#include "thermfit/io/csv/reader.hpp"

#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>

#include "support/thermal_rows.hpp"
#include "thermfit/io/csv/moments.hpp"
#include "thermfit/io/files/atomic_file.hpp"
#include "thermfit/io/files/batch_digest.hpp"
#include "thermfit/number.hpp"

using namespace thermfit;

namespace {

class TemporaryFile {
 public:
  TemporaryFile() {
    const ThermalRows rows(100'000, 10, 1, 1);
    std::string text = "time_s,T1,T2,T3,T4,T5,T6,T7,T8,T9,T10,Z\n";
    for (Index row = 0; row < rows.temperatures.rows(); ++row) {
      text += std::to_string(10 * row);
      for (const double degC : rows.temperatures.row(row)) text += ',' + fixed_text(degC, 2);
      text += ',' + fixed_text(rows.errors(row, 0), 1) + '\n';
    }
    write_atomically(path_, text);
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }
  auto bytes() const { return static_cast<std::int64_t>(std::filesystem::file_size(path_)); }

 private:
  std::string path_ = (std::filesystem::temp_directory_path() / "thermfit_reader_benchmark.csv").string();
};

template <class Work>
void timed(benchmark::State& state, Work&& work) {
  const TemporaryFile file;
  for (auto _ : state) {
    auto result = work(file.path());
    benchmark::DoNotOptimize(&result);
  }
  state.SetBytesProcessed(state.iterations() * file.bytes());
}

void read_batches(benchmark::State& state) {
  timed(state, [](const std::string& path) { return read_campaign({path}); });
}

void read_moments_alone(benchmark::State& state) {
  timed(state, [](const std::string& path) { return read_moments(path); });
}

/// The digest's share of read_batches; bytes_per_second in the same unit, bytes of text.
void digest(benchmark::State& state) {
  const TemporaryFile file;
  const Batch batch = read_campaign({file.path()}).batches.front();
  for (auto _ : state) benchmark::DoNotOptimize(batch_digest(batch));
  state.SetBytesProcessed(state.iterations() * file.bytes());
}

BENCHMARK(read_batches)->Unit(benchmark::kMillisecond);
BENCHMARK(read_moments_alone)->Unit(benchmark::kMillisecond);
BENCHMARK(digest)->Unit(benchmark::kMillisecond);

}  // namespace
