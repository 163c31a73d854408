#pragma once

/// Cells that are no readings, left out so that a diagnosis goes on as if they had been.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/findings/findings.hpp"

namespace thermfit {

/// A campaign without the cells that are no readings, and what was found in it.
struct WithoutBadCells {
  Campaign campaign;                  ///< such cells read off linearly between their neighbours, held at the ends
  std::vector<DataProblem> left_out;  ///< of DataProblem::Kind::left_out, a batch and channel each
  std::vector<std::vector<Finding>> others;  ///< by batch: all other findings
};

/// Takes spikes (but for first and last rows) and impossible numbers of up to `most_rows` rows in a row out of
/// temperatures and errors. Allocates.
template <typename Scalar = double>
WithoutBadCells without_bad_cells(Campaign campaign, DataProblem::Side side, Index most_rows = 5) {
  WithoutBadCells result;
  for (Batch& batch : campaign) {
    std::vector<Finding> others;
    for (Finding& one : find_faults(batch)) {
      // A first or last reading off the others may be a machine that starts warm or was stopped.
      const bool inside = one.first_row > 0 && one.last_row + 1 < batch.rows();
      const bool bad = (one.rule == FindingRule::spike && inside) || one.rule == FindingRule::impossible;
      if (!bad || one.last_row - one.first_row >= most_rows) {
        others.push_back(std::move(one));
        continue;
      }
      Channels& channels = batch.temperatures.find(one.channel) >= 0 ? batch.temperatures : batch.errors;
      const Index column = channels.find(one.channel), rows = batch.rows();
      if (column < 0) continue;
      MatrixX<Scalar>& values = channels.values;
      const Index before = one.first_row - 1, after = one.last_row + 1;
      const bool has_before = before >= 0 && std::isfinite(values(before, column)),
                 has_after = after < rows && std::isfinite(values(after, column));
      const auto at = [&](Index row) { return batch.has_time() ? batch.time_s(row) : static_cast<double>(row); };
      for (Index row = one.first_row; row <= one.last_row; ++row) {
        double value = std::nan("");
        if (has_before && has_after)
          value = values(before, column) +
                  (values(after, column) - values(before, column)) * (at(row) - at(before)) / (at(after) - at(before));
        else if (has_before || has_after)
          value = values(has_before ? before : after, column);
        values(row, column) = value;
      }
      const std::string rows_told = rows_text(one, batch);
      const auto known = std::find_if(result.left_out.begin(), result.left_out.end(), [&](const DataProblem& other) {
        return other.batch == batch.name && other.channel == one.channel;
      });
      if (known != result.left_out.end()) {
        known->note += ", " + rows_told;
        continue;
      }
      DataProblem told;
      told.kind = DataProblem::Kind::left_out;
      told.batch = batch.name;
      told.channel = one.channel;
      told.rule = std::string(rule_name(one.rule));
      told.note = rows_told;
      told.side = side;
      told.certain = false;
      result.left_out.push_back(std::move(told));
    }
    result.others.push_back(std::move(others));
  }
  result.campaign = std::move(campaign);
  return result;
}

THERMFIT_COMPILED_TEMPLATE(WithoutBadCells without_bad_cells<double>(Campaign, DataProblem::Side, Index));

}  // namespace thermfit
