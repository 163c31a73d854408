#include "thermfit/io/csv/moments.hpp"

#include "support/catch.hpp"
#include "support/scratch_folder.hpp"
#include "thermfit/io/csv/reader.hpp"

using namespace thermfit;

TEST_CASE("moments of a stream equal those of the rows, in rises and in degrees", "[io]") {
  const std::string path = std::string(THERMFIT_SOURCE_DIR) + "/data/vcenter55/K05.csv";
  const Batch batch = read_campaign({path}).batches[0];
  for (const TemperatureReference reference : {TemperatureReference::rise, TemperatureReference::absolute}) {
    const Moments rows(model_temperatures(batch, reference), batch.errors.values);
    const CsvMoments stream = read_moments(path, {}, reference);
    REQUIRE(stream.batches.size() == 1);
    const Moments<>& moments = stream.batches[0].moments;
    CHECK(moments.rows() == 79);
    CHECK(moments.temperature_mean().isApprox(rows.temperature_mean(), 1e-12));
    CHECK(moments.temperature_products().isApprox(rows.temperature_products(), 1e-12));
    CHECK(moments.cross_products().isApprox(rows.cross_products(), 1e-12));
    CHECK(moments.temperature_lowest().isApprox(rows.temperature_lowest(), 1e-12));
    CHECK(stream.file.roles.temperatures == batch.temperatures.names);
  }
}

TEST_CASE("batches that alternate in a long stream are kept apart", "[io]") {
  const ScratchFolder folder;
  std::string text = "run,T1,Z\n";
  for (int row = 0; row < 3000; ++row)
    text += (row % 3 ? "a," : "b,") + std::to_string(20 + row % 7) + ',' + std::to_string(row % 11) + '\n';
  CsvOptions options;
  options.batch_column = "run";
  const std::string path = folder.write("a.csv", text);
  const CsvMoments stream = read_moments(path, options, TemperatureReference::absolute);
  const Campaign campaign = read_campaign({path}, options).batches;
  REQUIRE(stream.batches.size() == 2);
  for (std::size_t b = 0; b < 2; ++b) {
    CHECK(stream.batches[b].name == campaign[b].name);
    const Moments rows(campaign[b].temperatures.values, campaign[b].errors.values);
    CHECK(stream.batches[b].moments.rows() == rows.rows());
    CHECK(stream.batches[b].moments.cross_products().isApprox(rows.cross_products(), 1e-12));
    CHECK(stream.batches[b].moments.error_products().isApprox(rows.error_products(), 1e-12));
  }
}
