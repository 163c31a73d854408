// Measured machines: figures of their SOURCE.md, computed there in another language.
#include "support/catch.hpp"
#include "support/numeric_csv.hpp"
#include "support/shared_data.hpp"
#include "thermfit/fit/fit.hpp"
#include "thermfit/number.hpp"
#include "thermfit/robustness/leave_one_batch_out.hpp"

using namespace thermfit;

namespace {

std::vector<Moments<>> read(const std::string& folder, const std::string& stem, int digits, int count,
                            const std::string& first, const std::string& last, const std::string& error,
                            TemperatureReference reference) {
  std::vector<Moments<>> batches;
  for (int b = 1; b <= count; ++b) {
    std::string number = std::to_string(b);
    while (static_cast<int>(number.size()) < digits) number.insert(0, "0");
    const NumericCsv csv(folder + stem + number + ".csv");
    Batch batch;
    batch.temperatures.values = csv.columns(first, last);
    batch.errors.values = csv.columns(error, error);
    batches.push_back(observe(batch, reference).moments);
  }
  return batches;
}

/// "mean/worst" of the RMSE over batches left out.
std::string left_out(const std::vector<Moments<>>& batches, Method method, Index components = 1) {
  FitOptions options;
  options.components = ComponentRule::fixed(components);
  const LeftOut<> result = leave_one_batch_out(batches, [&](const Moments<>& m) { return fit(method, m, options); });
  const std::size_t worst = result.worst(0, &Residuals<>::rmse);
  return fixed_text(result.mean(0, &Residuals<>::rmse), 2) + "/" + fixed_text(result.residuals[worst][0].rmse(), 2);
}

}  // namespace

TEST_CASE("ace_lathe: figures of days left out, on absolute temperatures and on rises", "[robustness]") {
  REQUIRE_SHARED_DATA(folder);
  const auto batches = [&](TemperatureReference reference) {
    return read(folder + "/real/ace_lathe/", "day", 2, 18, "Ambient", "Spindle Front", "Dia Disp", reference);
  };
  const std::vector<Moments<>> absolute = batches(TemperatureReference::absolute);
  CHECK(left_out(absolute, Method::mlr) == "7.73/30.54");
  CHECK(left_out(absolute, Method::pls, 2) == "8.11/13.39");
  CHECK(left_out(absolute, Method::pls, 3) == "7.39/16.81");
  const std::vector<Moments<>> rise = batches(TemperatureReference::rise);
  CHECK(left_out(rise, Method::mlr) == "7.17/16.38");
  CHECK(left_out(rise, Method::pls, 2) == "9.42/16.87");
  CHECK(left_out(rise, Method::pls, 3) == "7.20/15.96");
}

TEST_CASE("gooddash: figures of runs left out, on temperatures as recorded", "[robustness]") {
  REQUIRE_SHARED_DATA(folder);
  const std::vector<Moments<>> batches =
      read(folder + "/real/gooddash/", "run", 1, 5, "dT00", "dT21", "err", TemperatureReference::absolute);
  CHECK(left_out(batches, Method::mlr) == "1.33/1.85");
  CHECK(left_out(batches, Method::pls, 1) == "2.53/2.86");
  CHECK(left_out(batches, Method::pls, 2) == "1.68/2.70");
  CHECK(left_out(batches, Method::pls, 3) == "1.44/1.93");
  CHECK(left_out(batches, Method::pls, 4) == "0.96/1.30");
  std::vector<Moments<>> six;
  for (const Moments<>& batch : batches) six.push_back(batch.subset({2, 6, 9, 12, 19, 20}));
  CHECK(left_out(six, Method::mlr) == "0.98/1.24");
}
