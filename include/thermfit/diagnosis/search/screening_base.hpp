#pragma once

#include <Eigen/Cholesky>
#include <cstddef>
#include <vector>

#include "thermfit/calibration/map_fit.hpp"

namespace thermfit {

/// What the screening of every candidate shares: the calibrated machine, linearised.
template <typename Scalar = double>
class ScreeningBase {
 public:
  /// `own_effects`: how many effects the machine brought along; those that the search added after them are left out of
  /// the machine on which signatures are taken, which to first order changes nothing and is far cheaper.
  ScreeningBase(const MachineRecord& seen, const MapFit& fit, const EffectLibrary& library, std::size_t own_effects)
      : seen_(seen),
        fit_(fit),
        simulated_(simulate(fit.network(), seen.excitations, library, fit.parameters)),
        whiteners_(whiteners_of(seen, fit.noise)),
        model_(linearized(seen, simulated_, fit.slopes(), whiteners_)),
        prior_(fit.precision().asDiagonal()),
        factor_(fit.total().information + prior_),
        bare_(fit.network()) {
    bare_.effects.resize(own_effects);
    bare_simulated_ = simulate(bare_, seen.excitations, library);
  }

  const MachineRecord& seen() const { return seen_; }                                 ///< what the campaign says
  const MapFit& fit() const { return fit_; }                                          ///< of the calibrated machine
  const std::vector<Simulation>& simulated() const { return simulated_; }             ///< with sensitivities
  const ThermalNetwork& bare() const { return bare_; }                                ///< on which signatures are taken
  const std::vector<Simulation>& bare_simulated() const { return bare_simulated_; }   ///< bare(), by batch
  const std::vector<std::vector<Whitener>>& whiteners() const { return whiteners_; }  ///< by channel and batch
  const Linearized& model() const { return model_; }  ///< the calibrated machine, whitened

  /// Information of the machine's parameters with channels reweighted, and its factor; the factor at unit weights is
  /// kept.
  Eigen::LLT<MatrixX<Scalar>> factor(const VectorX<Scalar>& weights) const {
    if ((weights.array() == 1).all()) return factor_;
    MatrixX<Scalar> information = prior_;
    for (std::size_t c = 0; c < model_.channels.size(); ++c) {
      const auto& active = model_.channels[c].active;
      const MatrixX<Scalar>& part = fit_.equations.by_channel[c].information;
      for (std::size_t j = 0; j < active.size(); ++j)
        for (std::size_t i = 0; i < active.size(); ++i)
          information(active[i], active[j]) +=
              weights(static_cast<Index>(c)) * part(static_cast<Index>(i), static_cast<Index>(j));
    }
    return information.llt();
  }

 private:
  const MachineRecord& seen_;
  const MapFit& fit_;
  std::vector<Simulation> simulated_;
  std::vector<std::vector<Whitener>> whiteners_;
  Linearized model_;
  MatrixX<Scalar> prior_;
  Eigen::LLT<MatrixX<Scalar>> factor_;
  ThermalNetwork bare_;
  std::vector<Simulation> bare_simulated_;
};

}  // namespace thermfit
