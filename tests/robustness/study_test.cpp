#include "thermfit/robustness/study.hpp"

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "thermfit/io/csv/reader.hpp"
#include "thermfit/number.hpp"

using namespace thermfit;

namespace {

std::vector<std::string> batches_of(const std::string& folder, const std::string& stem, int count, int digits) {
  std::vector<std::string> paths;
  for (int i = 1; i <= count; ++i) {
    std::string number = std::to_string(i);
    number.insert(0, static_cast<std::size_t>(digits) - number.size(), '0');
    paths.push_back(folder + "/" + stem + number + ".csv");
  }
  return paths;
}

Study<> study_of(const std::vector<std::string>& paths, const CsvOptions& options, TemperatureReference reference) {
  return study(observe(read_campaign(paths, options).batches, reference));
}

/// "mean worst" of a row of the leave-one-batch-out table.
std::string left_out(const Study<>& study, Method method, Index components) {
  for (const LeftOutMethod<>& row : study.left_out)
    if (row.method == method && row.components == components && row.result)
      return fixed_text(row.result->mean(0, &Residuals<>::rmse), 2) + ' ' +
             fixed_text(row.result->residuals[row.result->worst(0, &Residuals<>::rmse)][0].rmse(), 2);
  return "";
}

}  // namespace

TEST_CASE("the study of vcenter55 gives the reference row to its printed digits", "[robustness]") {
  const Study<> result =
      study_of(batches_of(THERMFIT_SOURCE_DIR "/data/vcenter55", "K", 12, 2), {}, TemperatureReference::rise);
  std::string mean, std;
  for (const auto& step : result.methods[1].sweep) {
    mean += fixed_text(step->robustness[0].per_model.S_mean, 2) + ' ';
    std += fixed_text(step->robustness[0].per_model.S_std, 2) + ' ';
  }
  CHECK(mean == "6.38 5.72 5.85 5.99 5.98 6.70 7.13 7.53 7.53 8.40 ");
  CHECK(std == "1.01 0.61 0.83 0.81 0.80 0.95 0.97 2.09 1.23 2.03 ");
  const Robustness<>& by_rule = result.methods[0].chosen()->robustness[0];
  CHECK(fixed_text(by_rule.per_model.S_mean, 2) == "5.72");
  CHECK(fixed_text(by_rule.per_model.S_std, 2) == "0.61");
  const StudiedMethod<>& baseline = result.methods.back();
  CHECK(baseline.selection == Selection::fcgr);
  CHECK(fixed_text(baseline.chosen()->robustness[0].per_model.S_mean, 2) == "6.91");
  CHECK(fixed_text(baseline.chosen()->robustness[0].per_model.S_std, 2) == "1.07");
}

TEST_CASE("leaving a day out on the measured lathe gives the independent figures, absolute and as rise",
          "[robustness][real]") {
  REQUIRE_SHARED_DATA(data);
  CsvOptions options;
  options.errors = {"Dia Disp"};
  options.temperatures = {"Ambient", "Ref*", "Spindle*", "Cool*", "Tran*"};
  const auto paths = batches_of(data + "/real/ace_lathe", "day", 18, 2);
  const Study<> absolute = study_of(paths, options, TemperatureReference::absolute);
  CHECK(left_out(absolute, Method::mlr, 0) == "7.73 30.54");
  CHECK(left_out(absolute, Method::pls, 2) == "8.11 13.39");
  CHECK(left_out(absolute, Method::pls, 3) == "7.39 16.81");
}

TEST_CASE("leaving a run out on the measured machine tool gives the independent figures", "[robustness][real]") {
  REQUIRE_SHARED_DATA(data);
  CsvOptions options;
  options.errors = {"err"};
  options.temperatures = {"dT*"};
  const auto paths = batches_of(data + "/real/gooddash", "run", 5, 1);
  const Study<> result = study_of(paths, options, TemperatureReference::rise);
  CHECK(left_out(result, Method::mlr, 0) == "1.33 1.85");
  CHECK(left_out(result, Method::pls, 1) == "2.53 2.86");
  CHECK(left_out(result, Method::pls, 2) == "1.68 2.70");
  CHECK(left_out(result, Method::pls, 3) == "1.44 1.93");
  CHECK(left_out(result, Method::pls, 4) == "0.96 1.30");
  options.temperatures = {"dT02", "dT06", "dT09", "dT12", "dT19", "dT20"};
  CHECK(left_out(study_of(paths, options, TemperatureReference::rise), Method::mlr, 0) == "0.98 1.24");
}

TEST_CASE("one batch is no study, and more points than there are is refused", "[robustness]") {
  const auto paths = batches_of(THERMFIT_SOURCE_DIR "/data/vcenter55", "K", 2, 2);
  CHECK_THROWS_AS(study(observe(read_campaign({paths[0]}).batches)), Error);
  StudyOptions options;
  options.points = 11;
  CHECK_THROWS_AS(study(observe(read_campaign(paths).batches), options), Error);
}
