#pragma once

#include <string>
#include <vector>

#include "thermfit/network/simulate.hpp"

namespace thermfit {

/// One measured channel that the simulator predicts, over all batches.
struct OutputChannel {
  std::string name;
  bool displacement = false;     ///< um, else degC
  Index column = 0;              ///< in Simulation::channels
  std::vector<Vector> measured;  ///< by batch; NaN where missing
};

/// What is fitted: batches, their excitations and measured channels. The column that gives the ambient temperature is
/// an input, not an output.
struct CalibrationData {
  std::vector<std::string> batches;
  std::vector<Excitation> excitations;
  std::vector<OutputChannel> channels;
};
CalibrationData calibration_data(const ThermalNetwork& network, const Campaign& campaign);

/// Weight of a channel in the likelihood: residuals of standard deviation `sd` of which only `effective_share` count as
/// independent, 1 / (1 + 2 sum rho).
struct ChannelNoise {
  double sd = 0;
  double effective_share = 1;
  double correlation_lag1 = 0;
};

/// Gauss-Newton blocks of one batch at the solution, in working coordinates t: information H = J'WJ, score g = J'Wr
/// (r = measured - simulated), cost r'Wr. Sum over batches + identity = posterior information.
struct BatchBlock {
  Matrix information;
  Vector score;
  double cost = 0;
};

struct CalibrationOptions {
  int most_iterations = 30;
  double tolerance = 1e-6;          ///< on the decrease of the cost, relative
  int noise_rounds = 4;             ///< how often the channel noise is estimated anew
  std::vector<ChannelNoise> noise;  ///< given: kept as it is
  std::vector<bool> use_batch;      ///< empty: all
  std::vector<bool> free;           ///< by parameter; empty: all
  Vector start;                     ///< working coordinates; empty: the network's values
};

struct Calibration {
  ThermalNetwork network;  ///< with the calibrated values
  std::vector<Parameter> parameters;
  Vector t;                             ///< working coordinates: prior standard deviations from the prior mean
  Matrix covariance;                    ///< of t
  std::vector<ChannelNoise> noise;      ///< by channel of the data
  std::vector<BatchBlock> blocks;       ///< by batch
  std::vector<Simulation> simulations;  ///< at the solution, every batch
  double cost = 0;                      ///< -2 log posterior up to a constant: sum of r'Wr + log-determinant + t't
  double log_evidence = 0;              ///< Laplace approximation
  int iterations = 0;
  bool converged = false;
};

/// Maximum a posteriori values of all calibration parameters of `network`, effects included.
Calibration calibrate(const ThermalNetwork& network, const CalibrationData& data, const EffectLibrary& effects,
                      const CalibrationOptions& options = {});

}  // namespace thermfit
