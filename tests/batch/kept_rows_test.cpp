#include "thermfit/batch/kept_rows.hpp"

#include "support/catch.hpp"
#include "thermfit/batch/temperature_rise.hpp"

using namespace thermfit;

TEST_CASE("rows that are kept keep their numbers, their clock and what their rises count from", "[batch]") {
  Batch batch;
  batch.time_s = Vector::LinSpaced(5, 0, 240);
  batch.temperatures = {{"T1", "T2"}, Matrix(5, 2)};
  batch.temperatures.values << 20, 30, 21, 31, 23, 33, 26, 36, 30, 40;
  batch.errors = {{"Z"}, Vector::LinSpaced(5, 0, 4)};
  const Batch kept = kept_rows(batch, {1, 3, 4});
  CHECK(kept.rows() == 3);
  CHECK(kept.dropped_rows == 2);
  CHECK(kept.row_numbers == std::vector<Index>{2, 4, 5});
  CHECK(kept.time_s == (Vector(3) << 60, 180, 240).finished());
  CHECK(kept.errors.values == (Matrix(3, 1) << 1, 3, 4).finished());
  CHECK(model_temperatures(kept, TemperatureReference::rise).col(1) == (Vector(3) << 1, 6, 10).finished());

  const Batch again = kept_rows(kept, {2});
  CHECK(again.number_of(0) == 5);
  CHECK(again.first_degC == (Vector(2) << 20, 30).finished());
  CHECK(kept_rows(batch, {0, 1}).first_degC.size() == 0);
  CHECK(kept_rows(batch, {0, 1, 2, 3, 4}).row_numbers.empty());
}
