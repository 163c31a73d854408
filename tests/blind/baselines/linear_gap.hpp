#pragma once

/// What the baselines share: the machine calibrated under white noise, its residual, and the signature of any effect.

#include <Eigen/Dense>

#include "thermfit/effects/catalogue.hpp"
#include "thermfit/io/csv/reader.hpp"
#include "thermfit/io/json/machine.hpp"
#include "thermfit/network/simulate.hpp"

namespace blind {

using thermfit::Index;
using thermfit::Matrix;
using thermfit::Vector;

/// One channel of one batch within the stacked rows.
struct Piece {
  std::size_t batch, channel;
  Index first, rows;
};

struct SeenChannel {
  std::string name;
  bool displacement;
  Index column;
  double sd;  ///< white noise, from differences of neighbours
};

class LinearGap {
 public:
  LinearGap(const std::string& machine, const std::vector<std::string>& files)
      : library(thermfit::standard_effects()),
        network(thermfit::read_machine(machine, library)),
        campaign(thermfit::read_campaign(files).batches),
        setting(thermfit::setting_of(network, campaign)),
        excitations_(thermfit::excitations_of(network, campaign)) {
    find_channels();
    const auto parameters = thermfit::calibration_parameters(network, library);
    Vector t = Vector::Zero(static_cast<Index>(parameters.size()));
    const auto values = [&] {
      Vector result(t.size());
      for (Index j = 0; j < t.size(); ++j) result[j] = parameters[static_cast<std::size_t>(j)].value(t[j]);
      return result;
    };
    const thermfit::ThermalNetwork nominal = network;
    double cost = 0, damping = 0;
    for (int pass = 0; pass < 12; ++pass) {
      const auto runs = thermfit::simulate(network, excitations_, library, parameters);
      residual = measured() - stacked(runs);
      cost = residual.squaredNorm() + t.squaredNorm();
      if (pass == 0) as_simulated = residual;
      jacobian = slopes(runs, t.size());
      for (Index j = 0; j < t.size(); ++j) jacobian.col(j) *= parameters[static_cast<std::size_t>(j)].slope(t[j]);
      const Matrix normal = jacobian.transpose() * jacobian;
      const Vector downhill = jacobian.transpose() * residual - t;
      bool better = false;
      for (int trial = 0; trial < 6 && !better; ++trial, damping = std::max(10 * damping, 1e-4)) {
        Matrix damped = normal;
        damped.diagonal() += Vector::Ones(t.size()) + damping * normal.diagonal();
        const Vector moved = t + damped.llt().solve(downhill), before = t;
        t = moved.cwiseMax(-6).cwiseMin(6);
        const thermfit::ThermalNetwork tried = thermfit::with_values(nominal, parameters, values());
        const double now =
            (measured() - stacked(thermfit::simulate(tried, excitations_, library))).squaredNorm() + t.squaredNorm();
        better = now < cost;
        if (better) {
          network = tried;
          if (now > .999 * cost) pass = 100;
          damping /= 100;
        } else {
          t = before;
        }
      }
      if (!better) break;
    }
    const auto runs = thermfit::simulate(network, excitations_, library, parameters);
    residual = measured() - stacked(runs);
    jacobian = slopes(runs, t.size());
    for (Index j = 0; j < t.size(); ++j) jacobian.col(j) *= parameters[static_cast<std::size_t>(j)].slope(t[j]);
    base_ = stacked(thermfit::simulate(network, excitations_, library));
  }

  /// Change of all channels, in units of their noise, when `added` joins the calibrated machine.
  Vector signature(thermfit::ThermalNetwork::AddedEffect added) const {
    const auto known = library.at(added.effect).parameters(network, added);
    std::vector<std::pair<std::string, double>> values;
    for (const auto& one : known) {
      double value = added.value(one.name, one.starts.empty() ? one.mean : one.starts[0]);
      if (!one.shapes && !one.fixed && !one.logarithmic && value == one.null)
        value = std::clamp(one.null + one.sd, one.lower, one.upper);
      values.emplace_back(one.name, value);
    }
    added.parameters = values;
    thermfit::ThermalNetwork with = network;
    with.effects.push_back(added);
    return stacked(thermfit::simulate(with, excitations_, library)) - base_;
  }

  /// rms of the displacement's part of stacked values, um.
  double output_rms(const Vector& values) const {
    double square = 0;
    Index rows = 0;
    for (const Piece& piece : pieces) {
      const SeenChannel& channel = channels[piece.channel];
      if (!channel.displacement) continue;
      square += (channel.sd * values.segment(piece.first, piece.rows)).squaredNorm();
      rows += piece.rows;
    }
    return rows ? std::sqrt(square / static_cast<double>(rows)) : 0;
  }

  thermfit::EffectLibrary library;
  thermfit::ThermalNetwork network;
  thermfit::Campaign campaign;
  thermfit::Setting setting;
  std::vector<SeenChannel> channels;
  std::vector<Piece> pieces;
  Vector residual, as_simulated;  ///< stacked, in units of each channel's noise
  Matrix jacobian;                ///< by working coordinate, prior N(0, 1)

 private:
  Vector series(const thermfit::Batch& batch, const SeenChannel& channel) const {
    const thermfit::Channels& from = channel.displacement ? batch.errors : batch.temperatures;
    return from.values.col(from.find(channel.name));
  }

  void find_channels() {
    const thermfit::Batch& first = campaign.front();
    for (std::size_t s = 0; s < network.sensors.size(); ++s)
      if (network.sensors[s].node >= 0 && first.temperatures.find(network.sensors[s].column) >= 0)
        channels.push_back({network.sensors[s].column, false, static_cast<Index>(s), 1});
    for (std::size_t d = 0; d < network.displacements.size(); ++d)
      if (first.errors.find(network.displacements[d].output) >= 0)
        channels.push_back({network.displacements[d].output, true, static_cast<Index>(network.sensors.size() + d), 1});
    Index at = 0;
    for (SeenChannel& channel : channels) {
      double square = 0, count = 0;
      for (std::size_t b = 0; b < campaign.size(); ++b) {
        const Vector values = series(campaign[b], channel);
        pieces.push_back({b, static_cast<std::size_t>(&channel - channels.data()), at, values.size()});
        at += values.size();
        for (Index k = 2; k < values.size(); ++k, ++count)
          square += std::pow(values[k] - 2 * values[k - 1] + values[k - 2], 2) / 6;
      }
      channel.sd = std::max(std::sqrt(square / std::max(1., count)), 1e-3);
    }
  }

  Index rows() const { return pieces.back().first + pieces.back().rows; }

  Vector measured() const {
    Vector all(rows());
    for (const Piece& piece : pieces)
      all.segment(piece.first, piece.rows) =
          series(campaign[piece.batch], channels[piece.channel]) / channels[piece.channel].sd;
    return all;
  }

  Vector stacked(const std::vector<thermfit::Simulation>& runs) const {
    Vector all(rows());
    for (const Piece& piece : pieces)
      all.segment(piece.first, piece.rows) =
          runs[piece.batch].channels.col(channels[piece.channel].column) / channels[piece.channel].sd;
    return all;
  }

  Matrix slopes(const std::vector<thermfit::Simulation>& runs, Index parameters) const {
    Matrix all(rows(), parameters);
    for (const Piece& piece : pieces) {
      const SeenChannel& channel = channels[piece.channel];
      all.middleRows(piece.first, piece.rows) =
          runs[piece.batch].jacobian.middleRows(channel.column * piece.rows, piece.rows) / channel.sd;
    }
    return all;
  }

  std::vector<thermfit::Excitation> excitations_;
  Vector base_;
};

/// Least squares with the prior on the machine's parameters only; the added columns are free.
struct LinearFit {
  Matrix columns;
  Vector penalty;

  LinearFit(const LinearGap& gap, const std::vector<Vector>& added) {
    const Index machine = gap.jacobian.cols();
    columns.resize(gap.jacobian.rows(), machine + static_cast<Index>(added.size()));
    columns.leftCols(machine) = gap.jacobian;
    penalty = Vector::Constant(columns.cols(), 1e-9);
    penalty.head(machine).setOnes();
    for (std::size_t i = 0; i < added.size(); ++i) columns.col(machine + static_cast<Index>(i)) = added[i];
  }

  Vector left(const Vector& residual) const {
    Matrix normal = columns.transpose() * columns;
    normal.diagonal() += penalty;
    return residual - columns * normal.ldlt().solve(columns.transpose() * residual);
  }

  /// Every batch predicted by a fit to the others.
  Vector held_out(const LinearGap& gap, const Vector& residual) const {
    const std::size_t batches = gap.campaign.size();
    std::vector<Matrix> normals(batches, Matrix::Zero(columns.cols(), columns.cols()));
    std::vector<Vector> rights(batches, Vector::Zero(columns.cols()));
    Matrix all = penalty.asDiagonal();
    Vector right = Vector::Zero(columns.cols());
    for (const Piece& piece : gap.pieces) {
      const auto part = columns.middleRows(piece.first, piece.rows);
      normals[piece.batch] += part.transpose() * part;
      rights[piece.batch] += part.transpose() * residual.segment(piece.first, piece.rows);
    }
    for (std::size_t b = 0; b < batches; ++b) all += normals[b], right += rights[b];
    Vector left = residual;
    for (std::size_t b = 0; b < batches; ++b) {
      const Vector solved = (all - normals[b]).ldlt().solve(right - rights[b]);
      for (const Piece& piece : gap.pieces)
        if (piece.batch == b)
          left.segment(piece.first, piece.rows) -= columns.middleRows(piece.first, piece.rows) * solved;
    }
    return left;
  }
};

}  // namespace blind
