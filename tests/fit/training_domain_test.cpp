#include "thermfit/fit/training_domain.hpp"

#include <random>

#include "support/catch.hpp"
#include "thermfit/fit/mlr.hpp"
#include "thermfit/fit/pcr.hpp"
#include "thermfit/fit/pls.hpp"
#include "thermfit/model/outside_domain.hpp"

using namespace thermfit;

namespace {

struct Mixture {
  Index points, sources, rows;
  double noise;
};

/// Normal rows from `sources` common sources and noise of its own on every point.
Matrix rows_of(const Matrix& mixing, double noise, Index rows, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  const auto draw = [&](Index r, Index c) {
    return Matrix::NullaryExpr(r, c, [&] { return normal(generator); }).eval();
  };
  return draw(rows, mixing.rows()) * mixing + noise * draw(rows, mixing.cols());
}

struct AlarmRates {
  double t2 = 0, spe = 0;
};

/// Share of new rows beyond the 1 % limits, averaged over training sets.
template <class Fitter>
AlarmRates alarm_rates(const Mixture& setting, const Fitter& fitter, int trainings = 1000, Index fresh = 300) {
  std::mt19937_64 generator(7);
  AlarmRates rates;
  for (int i = 0; i < trainings; ++i) {
    std::normal_distribution<double> normal;
    const Matrix mixing = Matrix::NullaryExpr(setting.sources, setting.points, [&] { return 3 * normal(generator); });
    const Matrix x = rows_of(mixing, setting.noise, setting.rows, generator);
    const Matrix y = x.rowwise().sum() + Matrix::NullaryExpr(setting.rows, 1, [&] { return normal(generator); });
    const Moments moments(x, y);
    const TrainingDomain<> domain = training_domain(fitter(moments), moments);
    const OutsideShares outside = outside_shares(domain, rows_of(mixing, setting.noise, fresh, generator));
    rates.t2 += outside.t2 / trainings;
    rates.spe += outside.spe / trainings;
  }
  return rates;
}

}  // namespace

TEST_CASE("new observations pass the 1 % limits in .9 to 1.1 % of the cases", "[fit]") {
  for (const Mixture& setting :
       {Mixture{2, 1, 79, .3}, Mixture{10, 2, 158, .5}, Mixture{10, 2, 948, .5}, Mixture{22, 4, 300, .5}}) {
    FitOptions options;
    options.components = ComponentRule::fixed(setting.sources);
    const AlarmRates pls = alarm_rates(setting, [&](const Moments<>& m) { return fit_pls(m, options); });
    const AlarmRates pcr = alarm_rates(setting, [&](const Moments<>& m) { return fit_pcr(m, options); });
    CAPTURE(setting.points, setting.rows, pls.t2, pls.spe, pcr.t2, pcr.spe);
    for (const double rate : {pls.t2, pls.spe, pcr.t2, pcr.spe}) {
      CHECK(rate > .009);
      CHECK(rate < .011);
    }
  }
}

TEST_CASE("T2 over all directions, as for least squares, keeps its rate on few rows", "[fit]") {
  const AlarmRates mlr = alarm_rates({3, 2, 25, .5}, [](const Moments<>& m) { return fit_mlr(m); });
  CAPTURE(mlr.t2);
  CHECK(mlr.t2 > .009);
  CHECK(mlr.t2 < .011);
  CHECK(mlr.spe == 0);
}

TEST_CASE("on 79 rows of ten points the rates stay between .8 and 1.2 %", "[fit]") {
  FitOptions options;
  options.components = ComponentRule::fixed(2);
  const AlarmRates pls = alarm_rates({10, 2, 79, .5}, [&](const Moments<>& m) { return fit_pls(m, options); });
  CAPTURE(pls.t2, pls.spe);
  CHECK(pls.t2 > .008);
  CHECK(pls.t2 < .012);
  CHECK(pls.spe > .008);
  CHECK(pls.spe < .012);
}

TEST_CASE("T2 and SPE mean the same in raw units whatever the scaling of the fit", "[fit]") {
  std::mt19937_64 generator(3);
  const Matrix mixing = Matrix::Random(2, 5) * 4;
  const Matrix x = rows_of(mixing, .2, 100, generator);
  const Matrix y = x.col(0) * 2 - x.col(3);
  const Moments moments(x, y);
  FitOptions options;
  options.scaling = Scaling::centre;
  options.components = ComponentRule::fixed(5);
  const TrainingDomain<> all = training_domain(fit_pls(moments, options), moments);
  const TrainingDomain<> mlr = training_domain(fit_mlr(moments), moments);
  for (Index r = 0; r < 100; ++r) {  // all directions: T2 is Mahalanobis' distance
    const DomainDistance<> a = all.distance(x.row(r).transpose()), b = mlr.distance(x.row(r).transpose());
    CHECK(a.t2 == Approx(b.t2).epsilon(1e-8));
    CHECK(a.spe < 1e-18 * x.squaredNorm());
  }
  CHECK(all.spe_limit_99 == 0);
  CHECK(all.t2_limit_99 == Approx(mlr.t2_limit_99));
  CHECK(all.t2_limit_95 < all.t2_limit_99);
}

TEST_CASE("few rows give wide limits, and nothing left gives none", "[fit]") {
  CHECK(std::isinf(t2_limit(.99, 3, 3)));
  CHECK(std::isfinite(spe_limit(.99, Matrix::Identity(4, 4), 2, 2, 4)));
  CHECK(spe_limit(.99, Matrix::Identity(4, 4), 2, 2, 4) > 100 * spe_limit(.99, Matrix::Identity(4, 4), 2, 2, 400));
  CHECK(spe_limit(.99, Matrix::Zero(4, 4), 2, 2, 50) == 0);
  CHECK(spe_limit(.99, Matrix::Identity(4, 4), 0, 4, 50) == 0);
  CHECK(spe_limit(.99, Matrix::Identity(1, 1), 1, 1, 7) > 0);
}
