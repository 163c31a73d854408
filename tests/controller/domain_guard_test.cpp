#include "thermfit/controller/domain_guard.hpp"

#include <Eigen/QR>
#include <iostream>
#include <random>

#include "controller/example_model.hpp"
#include "support/catch.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/number.hpp"

using namespace thermfit;

namespace {

using Guard = DomainGuard<double, 6, 2>;
using Domain = Guard::Domain;

/// Six sensors that follow two hidden causes, plus noise; the error follows the causes.
Batch draw(Index rows, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto noise = [&] { return normal(random); };
  Matrix loadings(2, 6);
  loadings << 5, 4, 3, 2, 1, 0, 0, 1, -2, 3, -1, 2;
  const Matrix causes = Matrix::NullaryExpr(rows, 2, noise);
  Batch batch;
  batch.name = "made";
  batch.temperatures.names = {"a", "b", "c", "d", "e", "f"};
  batch.temperatures.values = (causes * loadings + .3 * Matrix::NullaryExpr(rows, 6, noise)).array() + 20;
  batch.errors.names = {"Z"};
  batch.errors.values = causes * Eigen::Vector2d(3, -2) + .2 * Matrix::NullaryExpr(rows, 1, noise);
  return batch;
}

double alarm_rate(Domain domain, bool t2, bool spe, const Matrix& samples, Guard& guard) {
  if (!t2) domain.t2_limit = 0;
  if (!spe) domain.spe_limit = 0;
  Index alarms = 0;
  for (Index row = 0; row < samples.rows(); ++row) {
    std::array<double, 6> sample;
    for (std::size_t i = 0; i < 6; ++i) sample[i] = samples(row, static_cast<Index>(i));
    alarms += guard.share_inside(domain, sample) < 1;
  }
  return static_cast<double>(alarms) / static_cast<double>(samples.rows());
}

}  // namespace

TEST_CASE("one percent of new ordinary samples lie beyond the 1 % limits", "[controller]") {
  std::mt19937_64 random(55);
  TrainingPlan plan;
  plan.options.components = ComponentRule::fixed(2);
  plan.reference = TemperatureReference::absolute;
  double t2 = 0, spe = 0;
  const int trainings = 400;
  for (int n = 0; n < trainings; ++n) {
    const auto model = narrow_model<double, 6, 1, 2>(train({draw(300, random)}, plan));
    Guard guard;
    const Matrix samples = draw(5000, random).temperatures.values;
    t2 += alarm_rate(model.domain, true, false, samples, guard) / trainings;
    spe += alarm_rate(model.domain, false, true, samples, guard) / trainings;
  }
  std::cout << "alarms at the 1 % limit over " << trainings << " trainings, " << trainings * 5000 << " samples: T2 "
            << fixed_text(100 * t2, 3) << " %, SPE " << fixed_text(100 * spe, 3) << " %\n";
  CHECK(t2 > .009);
  CHECK(t2 < .011);
  CHECK(spe > .009);
  CHECK(spe < .011);
}

TEST_CASE("the guard's distance is that of the trained model's domain", "[controller]") {
  const TrainedModel trained = example_model();
  const auto model = narrow_model<double, 3, 2, 2>(trained);
  DomainGuard<double, 3, 2> guard;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, 6);
  for (int n = 0; n < 1000; ++n) {
    const std::array<double, 3> sample{6 + normal(random), 5 + normal(random), 2 + normal(random)};
    const auto distance = trained.domain.distance(Vector(Vector::Map(sample.data(), 3)));
    const double ratio = std::min(9.5 / distance.t2, 6.5 / distance.spe);
    CHECK(guard.share_inside(model.domain, sample) == Approx(std::min(1., std::sqrt(ratio))));
  }
}

TEST_CASE("a sample that is no number shrinks to nothing", "[controller]") {
  const auto model = narrow_model<double, 3, 2, 2>(example_model());
  DomainGuard<double, 3, 2> guard;
  CHECK(guard.share_inside(model.domain, {std::nan(""), 0, 0}) == 0);
  CHECK(guard.share_inside(model.domain, {1e300, 0, 0}) == 0);
}

TEST_CASE("where the components span all features, those of a lost sensor are the ones of least T2", "[controller]") {
  TrainedModel trained = example_transfer_model();
  const Index n = trained.inputs();
  Matrix whole = Matrix::Random(n, n) + 2 * Matrix::Identity(n, n);
  trained.domain.rotations = Eigen::HouseholderQR<Matrix>(whole).householderQ();
  trained.domain.loadings = trained.domain.rotations;
  trained.domain.score_variance = Vector::LinSpaced(n, 4, 1);
  trained.domain.spe_limit_99 = 0;
  const auto model = narrow_model<double>(trained);
  DomainGuard<double, dynamic_size, dynamic_size> guard;
  guard.reset(model.domain);
  const auto missing = [&](std::size_t f) { return model.features.channels[f].of(0); };
  std::vector<double> inputs(model.inputs());
  for (std::size_t f = 0; f < inputs.size(); ++f) inputs[f] = std::sin(1 + 2. * static_cast<double>(f)) * 5 + 4;
  guard.fill_in_all(model.domain, inputs, missing);
  const Vector z =
      (Eigen::Map<const Vector>(inputs.data(), n) - trained.domain.mean).cwiseQuotient(trained.domain.scale);
  const Vector slope =
      trained.domain.rotations *
      (trained.domain.rotations.transpose() * z).cwiseQuotient(trained.domain.score_variance);  // of T2 / 2
  for (std::size_t f = 0; f < inputs.size(); ++f)
    if (missing(f)) CHECK(std::abs(slope(static_cast<Index>(f))) < 1e-3 * slope.cwiseAbs().maxCoeff());
}

TEST_CASE("all features of a lost sensor are filled in so that none of them has a residual", "[controller]") {
  const TrainedModel trained = example_transfer_model();
  const auto model = narrow_model<double>(trained);
  DomainGuard<double, dynamic_size, dynamic_size> guard;
  guard.reset(model.domain);
  const auto missing = [&](std::size_t f) { return model.features.channels[f].of(0); };
  std::vector<double> inputs(model.inputs());
  for (std::size_t f = 0; f < inputs.size(); ++f) inputs[f] = std::sin(1 + 2. * static_cast<double>(f)) * 5 + 4;
  guard.fill_in_all(model.domain, inputs, missing);
  const Vector z = (Eigen::Map<const Vector>(inputs.data(), static_cast<Index>(inputs.size())) - trained.domain.mean)
                       .cwiseQuotient(trained.domain.scale);
  const Vector residual = z - trained.domain.loadings * (trained.domain.rotations.transpose() * z);
  double most = 0, others = 0;
  for (std::size_t f = 0; f < inputs.size(); ++f)
    (missing(f) ? most : others) = std::max(missing(f) ? most : others, std::abs(residual(static_cast<Index>(f))));
  CAPTURE(most, others);
  CHECK(most < 1e-3 * others);
}
