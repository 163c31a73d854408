#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "thermfit/fit/fit.hpp"
#include "thermfit/fit/ridge_penalty.hpp"
#include "thermfit/robustness/cross_batch.hpp"
#include "thermfit/robustness/leave_one_batch_out.hpp"
#include "thermfit/select/correlation.hpp"
#include "thermfit/select/fcgr.hpp"

namespace thermfit {

/// How temperature points are chosen in a study.
enum class Selection { correlation, fcgr };

/// "correlation", "fcgr", as in the model file.
inline const char* name(Selection selection) { return selection == Selection::fcgr ? "fcgr" : "correlation"; }

/// What a study varies and what it holds.
struct StudyOptions {
  Index points = 2;        ///< temperature points of every batch's model (the paper's best)
  Index most_points = 0;   ///< the sweep goes from 1 to this; 0: all there are
  FitOptions fit;          ///< components, penalty, scaling
  bool own_batch = false;  ///< whether a model's own batch counts in S_mean and S_std
};

/// A method and a selection rule judged across batches at every number of points.
template <typename Scalar = double>
struct StudiedMethod {
  Method method;         ///< which of the four
  Selection selection;   ///< how its points are chosen
  Index components = 0;  ///< fixed number of latent variables; 0: by the study's rule
  std::vector<std::optional<SweepStep<Scalar>>>
      sweep{};            ///< entry k - 1: k points; empty where the method has no answer
  std::string refusal{};  ///< why the first empty step is empty
  Index points = 0;       ///< of `chosen`

  /// The step at the study's number of points, if there is one.
  const SweepStep<Scalar>* chosen() const {
    const auto k = static_cast<std::size_t>(points);
    return k >= 1 && k <= sweep.size() && sweep[k - 1] ? &*sweep[k - 1] : nullptr;
  }
};

/// One row of the leave-one-batch-out table: a method on all given points.
template <typename Scalar = double>
struct LeftOutMethod {
  Method method;                          ///< which of the four
  Index components = 0;                   ///< of PLS and PCR
  std::optional<LeftOut<Scalar>> result;  ///< none where the method has no answer
  std::string refusal;                    ///< why there is none
};

/// The paper's whole comparison on one campaign.
template <typename Scalar = double>
struct Study {
  StudyOptions options;                         ///< it was made with
  Index points = 0;                             ///< temperature points there are
  std::vector<MatrixX<Scalar>> correlations;    ///< per batch: points x errors, eq. (1)
  std::vector<StudiedMethod<Scalar>> methods;   ///< PLS and MLR on correlated points first
  std::vector<LeftOutMethod<Scalar>> left_out;  ///< every batch predicted by a model of all the others
};

namespace detail {

template <typename Scalar, class Rule>
StudiedMethod<Scalar> study_method(const std::vector<Observations<Scalar>>& batches, StudiedMethod<Scalar> studied,
                                   const Rule& rule, const StudyOptions& options, Index most_points) {
  studied.points = options.points;
  const auto fitter = [&](const Moments<Scalar>& moments) {
    FitOptions one_batch = options.fit;
    if (studied.components > 0) one_batch.components = ComponentRule::fixed(studied.components);
    if (studied.method == Method::ridge && !one_batch.ridge_lambda)
      one_batch.ridge_lambda = static_cast<double>(hoerl_kennard_baldwin(moments));
    return thermfit::fit(studied.method, moments, one_batch);
  };
  for (Index k = 1; k <= most_points; ++k) {
    try {
      studied.sweep.emplace_back(cross_batch(batches, rule, k, fitter, options.own_batch));
    } catch (const Error& error) {
      studied.sweep.emplace_back();
      if (studied.refusal.empty()) studied.refusal = error.what();
    }
  }
  return studied;
}

template <typename Scalar>
LeftOutMethod<Scalar> leave_out(const std::vector<Observations<Scalar>>& batches, Method method, Index components,
                                FitOptions options) {
  if (components > 0) options.components = ComponentRule::fixed(components);
  LeftOutMethod<Scalar> row{method, components, {}, {}};
  try {
    row.result = leave_one_batch_out(moments_of(batches), [&](const std::vector<Moments<Scalar>>& others) {
      return thermfit::fit(method, others, options);
    });
  } catch (const Error& error) {
    row.refusal = error.what();
  }
  return row;
}

}  // namespace detail

/// Steps 1 to 5 of the paper on `batches`: selection and fit in every batch, S of every model on every batch, S_mean
/// and S_std at 1 … p points, for PLS (by the component rule, and with one component as printed in the paper), MLR, PCR
/// and ridge on correlated points and for MLR on FCGR points; then every batch left out once, on all points. A method
/// that refuses (condition number, too few classes) is an empty step with its reason, not the end of the study. Fewer
/// than two batches: Error. FCGR needs rows. Allocates.
template <typename Scalar>
Study<Scalar> study(const std::vector<Observations<Scalar>>& batches, const StudyOptions& options = {}) {
  if (batches.size() < 2)
    throw Error("study", std::to_string(batches.size()) + " batch", "2 or more",
                "robustness is how a model does on batches it was not made from");
  Study<Scalar> result{options, batches.front().moments.temperatures(), {}, {}, {}};
  if (options.points < 1 || options.points > result.points)
    throw Error("number of points", std::to_string(options.points), "1 to " + std::to_string(result.points));
  const Index most = options.most_points > 0 ? std::min(options.most_points, result.points) : result.points;
  for (const Observations<Scalar>& batch : batches) result.correlations.push_back(correlations(batch.moments));
  const auto add = [&](Method method, Selection selection, Index components, const auto& rule) {
    result.methods.push_back(
        detail::study_method<Scalar>(batches, {method, selection, components}, rule, options, most));
  };
  add(Method::pls, Selection::correlation, 0, ByCorrelation{});
  add(Method::pls, Selection::correlation, 1, ByCorrelation{});
  add(Method::mlr, Selection::correlation, 0, ByCorrelation{});
  add(Method::pcr, Selection::correlation, 0, ByCorrelation{});
  add(Method::ridge, Selection::correlation, 0, ByCorrelation{});
  add(Method::mlr, Selection::fcgr, 0, ByFcgr{});

  result.left_out.push_back(detail::leave_out(batches, Method::mlr, 0, options.fit));
  for (Index a = 1; a <= std::min<Index>(result.points, 6); ++a)
    result.left_out.push_back(detail::leave_out(batches, Method::pls, a, options.fit));
  for (Index a = 1; a <= std::min<Index>(result.points, 3); ++a)
    result.left_out.push_back(detail::leave_out(batches, Method::pcr, a, options.fit));
  result.left_out.push_back(detail::leave_out(batches, Method::ridge, 0, options.fit));
  return result;
}

THERMFIT_COMPILED_TEMPLATE(Study<double> study<double>(const std::vector<Observations<double>>&, const StudyOptions&));

}  // namespace thermfit
