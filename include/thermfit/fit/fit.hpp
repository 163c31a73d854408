#pragma once

#include <vector>

#include "thermfit/fit/mlr.hpp"
#include "thermfit/fit/pcr.hpp"
#include "thermfit/fit/pls.hpp"
#include "thermfit/fit/ridge.hpp"

namespace thermfit {

/// The four methods under one name, for those who choose at run time.
enum class Method { pls, mlr, pcr, ridge };

/// "pls", "mlr", "pcr", "ridge", as in the model file.
inline const char* name(Method method) {
  constexpr const char* names[] = {"pls", "mlr", "pcr", "ridge"};
  return names[static_cast<int>(method)];
}

namespace detail {

/// The fit that `method` names, on anything the four take; fit_mlr has no options.
template <typename Scalar, class... Data>
LinearFit<Scalar> fit(Method method, const FitOptions& options, const Data&... data) {
  switch (method) {
    case Method::mlr:
      return thermfit::fit_mlr(data...);
    case Method::pcr:
      return thermfit::fit_pcr(data..., options);
    case Method::ridge:
      return thermfit::fit_ridge(data..., options);
    case Method::pls:
      break;
  }
  return thermfit::fit_pls(data..., options);
}

}  // namespace detail

/// fit_pls, fit_mlr, fit_pcr or fit_ridge on one Moments; errors are theirs.
template <typename Scalar>
LinearFit<Scalar> fit(Method method, const Moments<Scalar>& moments, const FitOptions& options = {}) {
  return detail::fit<Scalar>(method, options, moments);
}

/// The same on the moments of several batches, which may choose components or the penalty.
template <typename Scalar>
LinearFit<Scalar> fit(Method method, const std::vector<Moments<Scalar>>& batches, const FitOptions& options = {}) {
  return detail::fit<Scalar>(method, options, batches);
}

/// The same row-wise. Temperatures rows x points, errors rows x responses, um.
template <typename Temperatures, typename Errors, typename Scalar = typename Temperatures::Scalar>
LinearFit<Scalar> fit(Method method, const Eigen::MatrixBase<Temperatures>& temperatures,
                      const Eigen::MatrixBase<Errors>& errors, const FitOptions& options = {}) {
  using Rows = MatrixView<Scalar>;
  return detail::fit<Scalar>(method, options, Rows(temperatures), Rows(errors));
}

THERMFIT_COMPILED_TEMPLATE(LinearFit<double> fit<double>(Method, const Moments<double>&, const FitOptions&));
THERMFIT_COMPILED_TEMPLATE(LinearFit<double> fit<double>(Method, const std::vector<Moments<double>>&,
                                                         const FitOptions&));

}  // namespace thermfit
