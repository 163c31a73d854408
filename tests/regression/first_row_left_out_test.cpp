// Leaving rows out moved the row that rises count from, and the numbers of the rows.
#include "support/catch.hpp"
#include "support/scratch_folder.hpp"
#include "thermfit/io/csv/moments.hpp"
#include "thermfit/io/csv/reader.hpp"
#include "thermfit/model/predict.hpp"
#include "thermfit/moments/observations.hpp"

using namespace thermfit;

namespace {

const ScratchFolder& folder() {
  static const ScratchFolder scratch;
  return scratch;
}

CsvOptions dropping(bool errors_may_lack = false) {
  CsvOptions options;
  options.missing = MissingValues::drop;
  options.errors_may_lack = errors_may_lack;
  return options;
}

Batch read(const std::string& text, const CsvOptions& options) {
  return read_campaign({folder().write("a.csv", text)}, options).batches.at(0);
}

TrainedModel one_sensor_model() {
  TrainedModel model;
  model.temperatures = {"T1"};
  model.errors = {"Z"};
  model.model = {Matrix::Constant(1, 1, 2), Vector::Constant(1, 1)};
  model.domain.mean = model.domain.lowest = model.domain.highest = Vector::Zero(1);
  model.domain.scale = Vector::Ones(1);
  model.domain.rotations = model.domain.loadings = Matrix::Ones(1, 1);
  model.domain.score_variance = Vector::Ones(1);
  return model;
}

const std::string without_first_errors =
    "time_s,T1,T2,Z\n0,20,30,\n60,21,31,NA\n120,22,33,5\n180,23,34,6\n240,,35,7\n300,25,36,8\n";

}  // namespace

TEST_CASE("rises count from the first row of the file, also where its error is missing", "[regression]") {
  const Batch batch = read(without_first_errors, dropping());
  REQUIRE(batch.rows() == 3);
  CHECK(batch.row_numbers == std::vector<Index>{3, 4, 6});
  CHECK(batch.number_of(2) == 6);
  CHECK(model_temperatures(batch, TemperatureReference::rise) == (Matrix(3, 2) << 2, 3, 3, 4, 5, 6).finished());
  CHECK(observe(batch).moments.temperature_lowest() == (Vector(2) << 2, 3).finished());
  CHECK(read_moments(folder().write("a.csv", without_first_errors), dropping())
            .batches.at(0)
            .moments.temperature_lowest() == (Vector(2) << 2, 3).finished());
}

TEST_CASE("rows that are all there have the numbers of the batch", "[regression]") {
  const Batch batch = read("T1,Z\n20,1\n21,2\n", dropping());
  CHECK(batch.row_numbers.empty());
  CHECK(batch.first_degC.size() == 0);
  CHECK(batch.number_of(1) == 2);
}

TEST_CASE("every row with whole temperatures is predicted, errors or not", "[regression]") {
  for (const MissingValues missing : {MissingValues::error, MissingValues::drop, MissingValues::hold}) {
    CsvOptions options = dropping(true);
    options.missing = missing;
    options.temperatures = {"T1"};
    options.inputs = std::vector<std::string>{};
    const std::string text = "time_s,T1,T2,Z\n0,20,30,\n60,21,,NA\n120,22,33,5\n180,23,34,\n";
    const BatchPrediction predicted = predict(one_sensor_model(), read(text, options));
    REQUIRE(predicted.errors.rows() == 4);
    CHECK(predicted.errors.col(0) == (Vector(4) << 1, 3, 5, 7).finished());
    CHECK(std::isnan(predicted.residuals(0, 0)));
    CHECK(predicted.residuals(2, 0) == 0);
  }
}

TEST_CASE("a thermometer that starts late gets no other zero than the error", "[regression]") {
  const std::string late =
      "time_s,T1,T2,Z\n0,,30,0\n60,,31,10\n120,22,32,20\n180,23,33,30\n240,24,34,40\n300,25,35,50\n";
  const Batch batch = read(late, dropping());
  CHECK(lacks_first_reading(batch) == std::vector<std::string>{"T1"});
  CHECK_THROWS_WITH(observe(batch), Catch::Contains("T1 has no reading in the first row") && Catch::Contains("is 3"));
  CHECK_THROWS_AS(predict(one_sensor_model(), batch), Error);
  CHECK_THROWS_AS(read_moments(folder().write("a.csv", late), dropping()), Error);
  CHECK_NOTHROW(observe(batch, TemperatureReference::absolute));

  const Observations<> since = observe(batch, TemperatureReference::rise, ErrorReference::start);
  CHECK(since.temperatures.row(0).isZero());  // both count from row 3
  CHECK(since.errors(0, 0) == 0);
  CHECK(since.errors(3, 0) == 30);
  TrainedModel from_start = one_sensor_model();
  from_start.error_reference = ErrorReference::start;
  CHECK(predict(from_start, batch).errors(1, 0) == 3);

  CsvOptions only_T2 = dropping();
  only_T2.temperatures = {"T2"};
  CHECK(observe(read(late, only_T2)).moments.temperature_lowest()(0) == 2);  // T1 is an input now, and needed
  only_T2.inputs_may_lack = true;
  CHECK(observe(read(late, only_T2)).moments.temperature_lowest()(0) == 0);
}

TEST_CASE("each batch of a file has a first row of its own, and the order of the first batch", "[regression]") {
  CsvOptions options = dropping();
  options.batch_column = "run";
  const Batch second =
      read_campaign({folder().write("a.csv", "run,T1,T2,Z\na,20,30,0\nb,40,50,\na,21,31,1\nb,42,53,7\n")}, options)
          .batches.at(1);
  CHECK(second.row_numbers == std::vector<Index>{2});
  CHECK(second.first_degC == (Vector(2) << 40, 50).finished());
  const Batch turned = read_campaign({folder().write("a.csv", "T1,T2,Z\n20,30,0\n"),
                                      folder().write("b.csv", "T2,T1,Z\n50,40,\n53,42,1\n")},
                                     dropping())
                           .batches.at(1);
  CHECK(turned.first_degC == (Vector(2) << 40, 50).finished());
}

TEST_CASE("a clock of dates counts from the first row of the file", "[regression]") {
  const Batch batch =
      read("time,T1,Z\n2024-05-01T08:00:00,20,\n2024-05-01T08:01:00,21,1\n2024-05-01T08:02:00,22,2\n", dropping());
  CHECK(batch.time_s == (Vector(2) << 60, 120).finished());
}

TEST_CASE("the digest knows the first row that was left out", "[regression]") {
  CHECK(read("T1,Z\n20,\n21,1\n", dropping()).digest != read("T1,Z\n19,\n21,1\n", dropping()).digest);
  CHECK(read("T1,Z\n21,1\n", dropping()).digest == read("T1,Z\n21,1\n22,\n", dropping()).digest);
}
