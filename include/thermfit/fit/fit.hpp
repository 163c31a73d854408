#pragma once

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

/// fit_pls, fit_mlr, fit_pcr or fit_ridge on one Moments or on those of several batches.
template <class Data>
LinearFit fit(Method method, const Data& moments, const FitOptions& options = {}) {
  switch (method) {
    case Method::mlr:
      return fit_mlr(moments);
    case Method::pcr:
      return fit_pcr(moments, options);
    case Method::ridge:
      return fit_ridge(moments, options);
    case Method::pls:
      break;
  }
  return fit_pls(moments, options);
}

/// The same row-wise.
inline LinearFit fit(Method method, const Matrix& temperatures, const Matrix& errors, const FitOptions& options = {}) {
  switch (method) {
    case Method::mlr:
      return fit_mlr(temperatures, errors);
    case Method::pcr:
      return fit_pcr(temperatures, errors, options);
    case Method::ridge:
      return fit_ridge(temperatures, errors, options);
    case Method::pls:
      break;
  }
  return fit_pls(temperatures, errors, options);
}

}  // namespace thermfit
