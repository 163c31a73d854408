#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "thermfit/io/files/atomic_file.hpp"
#include "thermfit/io/files/sha256.hpp"
#include "thermfit/io/json/node.hpp"
#include "thermfit/model/trained_model.hpp"
#include "thermfit/version.hpp"

/// The model file `thermfit-model/1`: readable JSON with 17 digits, bounded counts and a digest over all of it.
///
/// A model of the method `transfer` has the key `transfer`: `features` (kind, point or input, and lag_min of a lag), of
/// which `um_per_K` and the training domain have a row each, the climates of training, and `blocks`, an entry an error:
/// its penalties, null where a block is not there, and its lag. The state of a lag starts at 0 where rises do.
/// `reference` tells what temperatures count from (rise, absolute), `error_reference` what errors do (recorded, start,
/// batch: TrainedModel::error_reference); files of earlier versions lack it, and their errors are as recorded.

namespace thermfit {
namespace detail {

constexpr Index most_sensors = 2000, most_errors = 100, most_features = 10000;

/// Puts the fields that `describe_model` names into a JSON object.
template <typename J>
class ModelWriter {
 public:
  explicit ModelWriter(J& object) : object_(object) {}
  void text(const char* key, const std::string& value) { object_[key] = value; }
  void texts(const char* key, const std::vector<std::string>& values, Index) { object_[key] = values; }
  void choice(const char* key, std::string& value, const std::vector<std::string>&) { object_[key] = value; }
  void integer(const char* key, Index value, Index) { object_[key] = value; }
  void number(const char* key, double value) { object_[key] = std::isfinite(value) ? J(value) : J(); }
  void vector(const char* key, const Vector& values, Index) { object_[key] = to_json<J>(values); }
  void matrix(const char* key, const Matrix& values, Index, Index) { object_[key] = to_json<J>(values); }
  template <class Describe>
  void object(const char* key, bool present, Describe describe) {
    if (!present) return;
    J inner = J::object();
    ModelWriter writer(inner);
    describe(writer);
    object_[key] = std::move(inner);
  }
  template <class Describe>
  void optional(const char* key, bool present, Describe describe) {
    object(key, present, describe);
  }
  void optional(const char* key, std::string& value, const std::vector<std::string>&) { object_[key] = value; }
  void optional(const char* key, const Vector& values, Index) {
    if (values.size() > 0) object_[key] = to_json<J>(values);
  }
  void optional(const char* key, double value) {
    if (std::isfinite(value)) object_[key] = value;
  }
  void optional(const char* key, const std::vector<std::string>& values, Index) {
    if (!values.empty()) object_[key] = values;
  }
  template <class Item, class Describe>
  void list(const char* key, std::vector<Item>& items, Index, Describe describe) {
    J list = J::array();
    for (Item& item : items) {
      J inner = J::object();
      ModelWriter writer(inner);
      describe(writer, item);
      list.push_back(std::move(inner));
    }
    object_[key] = std::move(list);
  }

 private:
  J& object_;
};

/// Takes the same fields out of a JSON object, checking type, range, length and that no other key is there.
template <typename J>
class ModelReader {
 public:
  using Node = BasicJsonNode<J>;

  explicit ModelReader(Node node, std::vector<std::string> other_keys = {})
      : node_(std::move(node)), keys_(std::move(other_keys)) {}
  void text(const char* key, std::string& value) { value = at(key).text(); }
  void texts(const char* key, std::vector<std::string>& values, Index most) {
    values = at(key).texts(static_cast<std::size_t>(most));
    if (values.empty()) at(key).fail("an empty list", "at least one name");
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (values[i] == values[j]) at(key).item(i).fail("'" + values[i] + "' twice");
  }
  void choice(const char* key, std::string& value, const std::vector<std::string>& allowed) {
    value = at(key).choice(allowed);
  }
  void optional(const char* key, std::string& value, const std::vector<std::string>& allowed) {
    if (node_.json().contains(key)) choice(key, value, allowed);
  }
  void integer(const char* key, Index& value, Index most) { value = at(key).integer(0, most); }
  void number(const char* key, double& value) {
    const Node node = at(key);
    value = node.json().is_null() ? std::numeric_limits<double>::infinity() : node.number();
  }
  void vector(const char* key, Vector& values, Index length) { values = at(key).vector(length); }
  void matrix(const char* key, Matrix& values, Index rows, Index columns) { values = at(key).matrix(rows, columns); }
  template <class Describe>
  void object(const char* key, bool present, Describe describe) {
    if (!present) return;
    ModelReader reader(at(key));
    describe(reader);
    reader.finish();
  }
  /// What files of earlier versions do not have.
  template <class Describe>
  void optional(const char* key, bool, Describe describe) {
    if (node_.json().contains(key)) object(key, true, describe);
  }
  void optional(const char* key, Vector& values, Index length) {
    if (node_.json().contains(key)) vector(key, values, length);
  }
  /// Infinite where it is not there.
  void optional(const char* key, double& value) {
    if (node_.json().contains(key)) number(key, value);
  }
  void optional(const char* key, std::vector<std::string>& values, Index most) {
    if (node_.json().contains(key)) texts(key, values, most);
  }
  template <class Item, class Describe>
  void list(const char* key, std::vector<Item>& items, Index most, Describe describe) {
    const Node node = at(key);
    items.resize(node.size(static_cast<std::size_t>(most)));
    for (std::size_t i = 0; i < items.size(); ++i) {
      ModelReader reader(node.item(i));
      describe(reader, items[i]);
      reader.finish();
    }
  }
  void finish() const { node_.require_keys(keys_); }

 private:
  Node at(const char* key) {
    keys_.emplace_back(key);
    return node_.at(key);
  }

  Node node_;
  std::vector<std::string> keys_;
};

/// What files have of models on derived channels only: `features` (what each coefficient is of), the climate of
/// training, and what was chosen for each error.
template <class Archive>
void describe_features(Archive& io, TrainedModel& m, Index points, Index errors) {
  io.optional("transfer", !m.features.empty(), [&](auto& inner) {
    inner.optional("known_inputs", m.known_inputs, most_sensors);
    const auto known = static_cast<Index>(m.known_inputs.size());
    inner.list("features", m.features, most_features, [&](auto& item, Feature& f) {
      std::vector<std::string> kinds{"rise", "lag", "climate", "difference", "input", "input lag"};
      std::string kind = kinds[static_cast<std::size_t>(f.kind)];
      item.choice("kind", kind, kinds);
      f.kind = static_cast<FeatureKind>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
      if (of_input(f.kind))
        item.integer("input", f.point, known - 1);
      else
        item.integer("point", f.point, points - 1);
      if (f.kind == FeatureKind::difference) item.integer("other", f.other, points - 1);
      if (f.kind == FeatureKind::lag || f.kind == FeatureKind::input_lag) item.number("lag_min", f.lag_min);
    });
    inner.number("climate_lowest_degC", m.climate.lowest);
    inner.number("climate_highest_degC", m.climate.highest);
    inner.number("climate_mean_degC", m.climate.mean);
    inner.list("blocks", m.blocks, errors, [&](auto& item, TransferRecord& r) {
      item.number("rise_penalty", r.rise_penalty);
      item.number("lag_penalty", r.lag_penalty);
      item.number("climate_penalty", r.climate_penalty);
      item.number("lag_min", r.lag_min);
      item.optional("input_penalty", r.input_penalty);
      item.optional("input_lag_penalty", r.input_lag_penalty);
      item.optional("difference_penalty", r.difference_penalty);
    });
  });
}

/// Every field of a model file once, for reading and for writing.
template <class Archive>
void describe_model(Archive& io, TrainedModel& m) {
  io.text("tool_version", m.tool_version);
  io.choice("method", m.method, {"pls", "mlr", "pcr", "ridge", "transfer"});
  io.text("selection", m.selection);
  io.texts("temperatures", m.temperatures, most_sensors);
  io.texts("errors", m.errors, most_errors);
  const Index points = static_cast<Index>(m.temperatures.size()), q = static_cast<Index>(m.errors.size());
  describe_features(io, m, points, q);
  const Index p = m.inputs();
  std::string reference = m.reference == TemperatureReference::rise ? "rise" : "absolute";
  io.choice("reference", reference, {"rise", "absolute"});
  m.reference = reference == "rise" ? TemperatureReference::rise : TemperatureReference::absolute;
  std::string error_reference = name(m.error_reference);  // files of earlier versions: recorded
  io.optional("error_reference", error_reference, {"recorded", "start", "batch"});
  for (const ErrorReference one : {ErrorReference::recorded, ErrorReference::start, ErrorReference::batch})
    if (error_reference == name(one)) m.error_reference = one;
  io.integer("components", m.components, p);
  io.number("ridge_lambda", m.ridge_lambda);

  io.vector("intercept_um", m.model.intercept, q);
  io.matrix("um_per_K", m.model.coefficients, p, q);
  io.matrix("standardised_coefficients", m.standardised_coefficients, p, q);
  io.vector("temperature_mean", m.temperature_mean, p);
  io.vector("temperature_scale", m.temperature_scale, p);
  io.vector("error_mean_um", m.error_mean, q);
  io.vector("error_scale_um", m.error_scale, q);
  io.vector("residual_deviation_um", m.residual_deviation_um, q);
  io.integer("degrees_of_freedom", m.degrees_of_freedom, std::numeric_limits<Index>::max());
  io.number("condition_number", m.condition_number);

  const Index a = m.components;
  io.object("latent_variables", a > 0, [&](auto& inner) {
    LatentVariables<>& v = m.latent;
    inner.matrix("weights", v.weights, p, a);
    inner.matrix("loadings", v.loadings, p, a);
    inner.matrix("rotations", v.rotations, p, a);
    inner.matrix("error_loadings", v.error_loadings, q, a);
    inner.vector("explained_temperature_variance", v.explained_temperature_variance, a);
    inner.vector("explained_error_variance", v.explained_error_variance, a);
    inner.vector("vip", v.vip, p);
  });
  io.object("training_domain", true, [&](auto& inner) {
    TrainingDomain<>& d = m.domain;
    inner.vector("lowest", d.lowest, p);
    inner.vector("highest", d.highest, p);
    inner.vector("mean", d.mean, p);
    inner.vector("scale", d.scale, p);
    Index components = d.score_variance.size();
    inner.integer("components", components, p);
    inner.matrix("rotations", d.rotations, p, components);
    inner.matrix("loadings", d.loadings, p, components);
    inner.vector("score_variance", d.score_variance, components);
    inner.number("t2_limit_95", d.t2_limit_95);
    inner.number("t2_limit_99", d.t2_limit_99);
    inner.number("spe_limit_95", d.spe_limit_95);
    inner.number("spe_limit_99", d.spe_limit_99);
  });
  io.object("sensor_envelope", true, [&](auto& inner) {
    SensorEnvelope& e = m.envelope;
    std::string known = e.has_rates() ? "range and rates" : e.has_range() ? "range" : "nothing";
    inner.choice("known", known, {"nothing", "range", "range and rates"});
    const Index ranges = known == "nothing" ? 0 : points, rates = known == "range and rates" ? points : 0;
    inner.vector("lowest_degC", e.lowest_degC, ranges);
    inner.vector("highest_degC", e.highest_degC, ranges);
    inner.vector("largest_rate_K_per_min", e.largest_rate_K_per_min, rates);
    inner.vector("longest_still_min", e.longest_still_min, rates);
  });
  io.optional("sensor_starts", m.envelope.has_starts(), [&](auto& inner) {
    SensorEnvelope& e = m.envelope;
    inner.vector("first_lowest_degC", e.first_lowest_degC, points);
    inner.vector("first_highest_degC", e.first_highest_degC, points);
    inner.vector("scatter_K", e.scatter_K, points);
  });
  io.list("substitutes", m.substitutes, points, [&](auto& inner, SubstituteModel& s) {
    inner.integer("lost", s.lost, points - 1);
    inner.vector("intercept_um", s.model.intercept, q);
    inner.matrix("um_per_K", s.model.coefficients, p, q);
    inner.vector("residual_deviation_um", s.residual_deviation_um, q);
    inner.optional("agreement_um", s.agreement_um, q);
  });
  io.list("batches", m.batches, 100000, [&](auto& inner, TrainingBatch& b) {
    inner.text("name", b.name);
    inner.integer("rows", b.rows, std::numeric_limits<Index>::max());
    inner.text("digest", b.digest);
  });
}

template <typename J>
std::string model_digest(J document) {
  document.erase("digest");
  return "sha256:" + sha256_hex(document.dump());
}

}  // namespace detail

/// The document of a model, digest included. Allocates.
template <typename J = Json>
J model_to_json(TrainedModel model) {
  J document{{"format", "thermfit-model/1"}};
  detail::ModelWriter<J> writer(document);
  detail::describe_model(writer, model);
  document["digest"] = detail::model_digest(document);
  return document;
}

/// A model from its document. Throws Error with the key path on a wrong format or version, an unknown or missing key, a
/// value of another type, length or range, and when the digest tells that the document was edited or damaged.
template <typename J = Json>
TrainedModel model_from_json(const J& document, const std::string& file) {
  const BasicJsonNode<J> root(document, file);
  root.require_format("thermfit-model", 1);
  TrainedModel model;
  detail::ModelReader<J> reader(root, {"format", "digest"});
  detail::describe_model(reader, model);
  reader.finish();
  const std::string digest = root.at("digest").text();
  if (digest != detail::model_digest(document))
    root.at("digest").fail("the digest does not fit the content", "",
                           "the file was edited or damaged: fit the model again");
  const auto positive = [&](const Vector& values, const char* name) {
    for (Index i = 0; i < values.size(); ++i)
      if (values(i) <= 0) root.fail(std::string(name) + " holds a value that is not above 0");
  };
  for (const Feature& feature : model.features)
    if ((feature.kind == FeatureKind::lag || feature.kind == FeatureKind::input_lag) &&
        !(feature.lag_min > 0 && std::isfinite(feature.lag_min)))
      root.fail("transfer.features holds a lag that is not above 0");
  if (!(model.climate.lowest <= model.climate.highest)) root.fail("transfer.climate_lowest_degC is above the highest");
  positive(model.temperature_scale, "temperature_scale");
  positive(model.error_scale, "error_scale_um");
  positive(model.domain.scale, "training_domain.scale");
  positive(model.domain.score_variance, "training_domain.score_variance");
  return model;
}

/// Saves so that a reader sees the old file or the whole new one. Throws Error when it cannot be written.
template <typename J = Json>
void save_model(const TrainedModel& model, const std::string& path) {
  write_atomically(path, model_to_json<J>(model).dump(1) + '\n');
}

/// The model in a file; throws Error also when the file cannot be read or is no JSON.
template <typename J = Json>
TrainedModel load_model(const std::string& path) {
  return model_from_json<J>(read_json<J>(path), path);
}

THERMFIT_COMPILED_TEMPLATE(Json model_to_json<Json>(TrainedModel));
THERMFIT_COMPILED_TEMPLATE(TrainedModel model_from_json<Json>(const Json&, const std::string&));
THERMFIT_COMPILED_TEMPLATE(void save_model<Json>(const TrainedModel&, const std::string&));
THERMFIT_COMPILED_TEMPLATE(TrainedModel load_model<Json>(const std::string&));

}  // namespace thermfit
