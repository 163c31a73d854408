#include "report/study_json.hpp"

#include <cmath>

#include "options/field_flags.hpp"
#include "thermfit/io/json/node.hpp"
#include "thermfit/version.hpp"

namespace thermfit::cli {
namespace {

Json figure(const MeanAndStd<>& value) { return {{"S_mean_um", value.S_mean}, {"S_std_um", value.S_std}}; }

Json model(const StudyReport& r, const BatchModel<>& m, std::size_t batch) {
  Json points = Json::array();
  for (const Index point : m.points) points.push_back(r.temperatures[static_cast<std::size_t>(point)]);
  return {{"batch", r.batches[batch]},
          {"points", std::move(points)},
          {"intercept_um", to_json(m.fit.model.intercept)},
          {"um_per_K", to_json(m.fit.model.coefficients)},
          {"components", m.fit.components},
          {"condition_number", m.fit.condition_number}};
}

Json robustness_json(const StudyReport& r, const Robustness<>& robust) {
  Json models = Json::array();
  for (std::size_t b = 0; b < robust.models.size(); ++b) {
    Json one = figure(robust.models[b]);
    one["batch"] = r.batches[b];
    models.push_back(std::move(one));
  }
  return {{"per_model", figure(robust.per_model)},
          {"pooled", figure(robust.pooled)},
          {"worst",
           {{"S_um", robust.worst_S},
            {"model", r.batches[static_cast<std::size_t>(robust.worst_model)]},
            {"batch", r.batches[static_cast<std::size_t>(robust.worst_batch)]}}},
          {"models", std::move(models)}};
}

Json step_json(const StudyReport& r, const SweepStep<>& step, bool whole) {
  Json errors = Json::object();
  for (std::size_t e = 0; e < r.errors.size(); ++e) {
    errors[r.errors[e]] = robustness_json(r, step.robustness[e]);
    if (whole) errors[r.errors[e]]["S_um"] = to_json(step.S[e]);
  }
  Json result{{"points", step.points}, {"errors", std::move(errors)}};
  if (!whole) return result;
  result["batch_models"] = Json::array();
  for (std::size_t b = 0; b < step.models.size(); ++b) result["batch_models"].push_back(model(r, step.models[b], b));
  return result;
}

Json left_out_json(const StudyReport& r, const LeftOutMethod<>& row) {
  Json result{{"method", name(row.method)}, {"components", row.components}};
  if (!row.result) {
    result["refusal"] = with_flags(row.refusal);
    return result;
  }
  Json errors = Json::object();
  for (std::size_t e = 0; e < r.errors.size(); ++e) {
    Json rmse = Json::object();
    for (std::size_t b = 0; b < r.batches.size(); ++b) rmse[r.batches[b]] = row.result->residuals[b][e].rmse();
    errors[r.errors[e]] = {{"mean_rmse_um", row.result->mean(e, &Residuals<>::rmse)},
                           {"pooled_rmse_um", row.result->pooled(e).rmse()},
                           {"S_mean_um", figure_of(row.result->residuals, e).S_mean},
                           {"S_std_um", figure_of(row.result->residuals, e).S_std},
                           {"rmse_um", std::move(rmse)}};
  }
  result["errors"] = std::move(errors);
  return result;
}

Json transfer_json(const StudyReport& r) {
  Json result{{"method", "transfer"}, {"components", 0}};
  if (!r.transfer) {
    result["refusal"] = with_flags(r.transfer_refusal);
    return result;
  }
  Json errors = Json::object();
  for (std::size_t e = 0; e < r.errors.size(); ++e) {
    Json rmse = Json::object(), chosen = Json::object();
    Residuals<> pooled;
    double mean = 0;
    const auto known = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
    for (std::size_t b = 0; b < r.batches.size(); ++b) {
      const Residuals<>& left = r.transfer->residuals[b][e];
      rmse[r.batches[b]] = left.rmse();
      mean += left.rmse() / static_cast<double>(r.batches.size());
      pooled.add(left);
      const TransferPenalties<>& p = r.transfer->fits[b][e].penalties;
      chosen[r.batches[b]] = {{"rise_penalty", known(p.rise)},
                              {"lag_penalty", known(p.lag)},
                              {"climate_penalty", known(p.climate)},
                              {"lag_min", std::isfinite(p.lag) ? Json(r.transfer_lags_min[p.lag_index]) : Json()}};
    }
    const MeanAndStd<> figure = r.transfer->figure(e);
    errors[r.errors[e]] = {{"mean_rmse_um", mean},       {"pooled_rmse_um", pooled.rmse()},
                           {"S_mean_um", figure.S_mean}, {"S_std_um", figure.S_std},
                           {"rmse_um", std::move(rmse)}, {"chosen", std::move(chosen)}};
  }
  result["errors"] = std::move(errors);
  return result;
}

}  // namespace

std::string study_json(const StudyReport& r) {
  Json document{{"format", "thermfit-study/1"},
                {"tool_version", THERMFIT_VERSION},
                {"reference", r.reference == TemperatureReference::rise ? "rise" : "absolute"},
                {"error_reference", name(r.error_reference)},
                {"temperatures", r.temperatures},
                {"errors", r.errors},
                {"points", r.study.options.points},
                {"own_batch", r.study.options.own_batch}};
  if (r.card) document["data"] = {{"origin", r.card->origin}, {"title", r.card->title}};
  document["batches"] = Json::array();
  for (std::size_t b = 0; b < r.batches.size(); ++b)
    document["batches"].push_back(
        {{"name", r.batches[b]}, {"rows", r.rows[b]}, {"correlations", to_json(r.study.correlations[b])}});
  document["methods"] = Json::array();
  for (const StudiedMethod<>& method : r.study.methods) {
    Json one{{"method", name(method.method)}, {"selection", name(method.selection)}, {"components", method.components}};
    if (!method.refusal.empty()) one["refusal"] = with_flags(method.refusal);
    if (method.chosen()) one["chosen"] = step_json(r, *method.chosen(), true);
    one["sweep"] = Json::array();
    for (const auto& step : method.sweep)
      if (step) one["sweep"].push_back(step_json(r, *step, false));
    document["methods"].push_back(std::move(one));
  }
  document["left_out"] = Json::array();
  for (const LeftOutMethod<>& row : r.study.left_out) document["left_out"].push_back(left_out_json(r, row));
  document["left_out"].push_back(transfer_json(r));
  if (r.card && !r.card->published.empty()) {
    document["published"] = {{"source", r.card->published_source}, {"figures", Json::array()}};
    for (const PublishedFigure& f : r.card->published)
      document["published"]["figures"].push_back(
          {{"method", f.method}, {"points", f.points}, {"S_mean_um", f.S_mean_um}, {"S_std_um", f.S_std_um}});
  }
  return document.dump(1) + '\n';
}

}  // namespace thermfit::cli
