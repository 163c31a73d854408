#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "thermfit/fit/linear_fit.hpp"
#include "thermfit/robustness/robustness.hpp"
#include "thermfit/select/rule.hpp"

namespace thermfit {

/// A fitter is anything called as `fitter(const Moments<Scalar>&)` that returns a LinearFit<Scalar> or a
/// LinearModel<Scalar>.
template <class Fitter, typename Scalar = double>
inline constexpr bool is_fitter = std::is_invocable_r_v<LinearFit<Scalar>, const Fitter&, const Moments<Scalar>&> ||
                                  std::is_invocable_r_v<LinearModel<Scalar>, const Fitter&, const Moments<Scalar>&>;

/// The model of one batch (or of several) and the temperature points it reads, in coefficient order.
template <typename Scalar = double>
struct BatchModel {
  std::vector<Index> points;  ///< columns of the temperatures
  LinearFit<Scalar> fit;      ///< on these points
};

namespace detail {

/// An Error that tells which batch it came from.
template <class Work>
auto in_batch(const std::string& name, Work&& work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string batch = name.empty() ? "batch" : "batch " + name;
    throw Error(batch + ": " + error.place(), error.found(), error.allowed(), error.remedy());
  }
}

}  // namespace detail

/// One model per batch: `rule` names `count` points (select/rule.hpp), `fitter` fits the batch's moments on them.
/// Errors of either name the batch. Allocates.
template <typename Scalar, class Rule, class Fitter>
std::vector<BatchModel<Scalar>> batch_models(const std::vector<Observations<Scalar>>& batches, const Rule& rule,
                                             Index count, const Fitter& fitter) {
  static_assert(is_fitter<Fitter, Scalar>,
                "A fitter is called as fitter(const thermfit::Moments<Scalar>&) and returns "
                "thermfit::LinearFit<Scalar> or thermfit::LinearModel<Scalar>.");
  std::vector<BatchModel<Scalar>> models;
  for (const Observations<Scalar>& batch : batches) {
    models.push_back(detail::in_batch(batch.name, [&] {
      std::vector<Index> points = select_points(rule, batch, count);
      LinearFit<Scalar> fit = fit_of(fitter(batch.moments.subset(points)));
      return BatchModel<Scalar>{std::move(points), std::move(fit)};
    }));
  }
  return models;
}

/// S of eq. (10) of every model on every batch, um: one models x batches matrix per error. Quadratic forms of the
/// moments, no rows. Widths must agree, or Error. Allocates.
template <typename Scalar>
std::vector<MatrixX<Scalar>> cross_batch_S(const std::vector<BatchModel<Scalar>>& models,
                                           const std::vector<Observations<Scalar>>& batches) {
  if (models.empty() || batches.empty()) return {};
  const Index count = static_cast<Index>(models.size());
  std::vector<MatrixX<Scalar>> result(static_cast<std::size_t>(batches.front().moments.errors()),
                                      MatrixX<Scalar>(count, static_cast<Index>(batches.size())));
  for (Index m = 0; m < count; ++m) {
    const BatchModel<Scalar>& model = models[static_cast<std::size_t>(m)];
    for (std::size_t b = 0; b < batches.size(); ++b) {
      const auto per_error = residuals(model.fit.model, batches[b].moments.subset(model.points));
      for (std::size_t e = 0; e < result.size(); ++e) result[e](m, static_cast<Index>(b)) = per_error[e].S();
    }
  }
  return result;
}

/// What a number of points gives: models, matrices of S and their summary per error.
template <typename Scalar = double>
struct SweepStep {
  Index points = 0;                            ///< of every model
  std::vector<BatchModel<Scalar>> models;      ///< one per batch
  std::vector<MatrixX<Scalar>> S;              ///< per error: models x batches, um
  std::vector<Robustness<Scalar>> robustness;  ///< per error
};

/// Step 4 of the paper: models of every batch with `points` points, each on every other batch. Errors as batch_models
/// and robustness. Allocates.
template <typename Scalar, class Rule, class Fitter>
SweepStep<Scalar> cross_batch(const std::vector<Observations<Scalar>>& batches, const Rule& rule, Index points,
                              const Fitter& fitter, bool own_batch = false) {
  SweepStep<Scalar> step{points, batch_models(batches, rule, points, fitter), {}, {}};
  step.S = cross_batch_S(step.models, batches);
  for (const MatrixX<Scalar>& S : step.S) step.robustness.push_back(robustness(S, own_batch));
  return step;
}

/// cross_batch for 1, 2, … `most` points (0: all there are).
template <typename Scalar, class Rule, class Fitter>
std::vector<SweepStep<Scalar>> sweep_points(const std::vector<Observations<Scalar>>& batches, const Rule& rule,
                                            const Fitter& fitter, Index most = 0, bool own_batch = false) {
  std::vector<SweepStep<Scalar>> steps;
  if (batches.empty()) return steps;
  if (most == 0) most = batches.front().moments.temperatures();
  for (Index k = 1; k <= most; ++k) steps.push_back(cross_batch(batches, rule, k, fitter, own_batch));
  return steps;
}

THERMFIT_COMPILED_TEMPLATE(std::vector<MatrixX<double>> cross_batch_S<double>(
    const std::vector<BatchModel<double>>&, const std::vector<Observations<double>>&));

}  // namespace thermfit
