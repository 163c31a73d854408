#include "commands/kept_zero.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "thermfit/io/files/atomic_file.hpp"
#include "thermfit/io/json/node.hpp"

namespace thermfit::cli {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

Json or_null(double value) { return is_finite(value) ? Json(value) : Json(); }
double or_nothing(const JsonNode& value) { return value.json().is_null() ? nothing : value.number(); }

std::vector<double> numbers(const JsonNode& list, int count) {
  if (!list.json().is_array() || list.json().size() != static_cast<std::size_t>(count))
    list.fail("not a number for each lag of the model", std::to_string(count), "give a datum");
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(or_nothing(list.item(static_cast<std::size_t>(k))));
  return values;
}

KeptZero kept_in(const JsonNode& file, const std::vector<std::string>& names, std::uint32_t model, int lags) {
  file.require_format("thermfit-datum", 1);
  std::vector<std::string> keys{"format", "model", "through_zero", "zero_degC", "digest"};
  if (lags >= 0 && file.json().contains("model") && file.at("model").json() == model)
    for (const char* key : {"lag_degC", "lag_zero_degC", "climate_degC", "time_s"}) keys.push_back(key);
  file.require_keys(keys);
  if (file.at("model").integer(0, UINT32_MAX) != model)
    file.at("model").fail("the zero of another model", std::to_string(model),
                          "give a datum: then the file becomes this model's");
  KeptZero kept{{}, nothing, ""};
  RetainedDatum<double, dynamic_size>& zero = kept.zero;
  zero.through_zero = file.at("through_zero").boolean() ? 1 : 0;
  const JsonNode values = file.at("zero_degC");
  values.require_keys(names);
  for (const std::string& name : names) zero.zero_degC.push_back(or_nothing(values.at(name)));
  if (lags >= 0) {
    zero.lag_degC = numbers(file.at("lag_degC"), lags);
    zero.lag_zero_degC = numbers(file.at("lag_zero_degC"), lags);
    zero.climate_degC = file.at("climate_degC").number();
    kept.time_s = or_nothing(file.at("time_s"));
  }
  zero.seal(model);
  if (file.at("digest").integer(0, UINT32_MAX) != zero.digest)
    file.at("digest").fail("the digest does not fit the content", "", "the file was edited or damaged: give a datum");
  return kept;
}

}  // namespace

KeptZero read_zero(const std::string& path, const std::vector<std::string>& names, std::uint32_t model, int lags) {
  try {
    return kept_in(JsonNode(read_json(path), path), names, model, lags);
  } catch (const std::exception& problem) {
    return {{}, nothing, std::string(problem.what()) + "; no zero until there is a datum"};
  }
}

void write_zero(const std::string& path, const std::vector<std::string>& names,
                const RetainedDatum<double, dynamic_size>& zero, bool session, double time_s) {
  Json document{{"format", "thermfit-datum/1"},
                {"model", zero.model},
                {"through_zero", zero.through_zero != 0},
                {"zero_degC", Json::object()},
                {"digest", zero.digest}};
  for (std::size_t i = 0; i < names.size(); ++i) document["zero_degC"][names[i]] = or_null(zero.zero_degC[i]);
  if (session) {
    for (const auto& [key, values] : {std::pair{"lag_degC", &zero.lag_degC}, {"lag_zero_degC", &zero.lag_zero_degC}}) {
      document[key] = Json::array();
      for (const double value : *values) document[key].push_back(or_null(value));
    }
    document["climate_degC"] = zero.climate_degC;
    document["time_s"] = or_null(time_s);
  }
  write_atomically(path, document.dump(1) + '\n');
}

}  // namespace thermfit::cli
