#include "commands/kept_zero.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "thermfit/io/files/atomic_file.hpp"
#include "thermfit/io/json/node.hpp"

namespace thermfit::cli {
namespace {

RetainedDatum<double, dynamic_size> zero_in(const JsonNode& file, const std::vector<std::string>& names,
                                            std::uint32_t model) {
  file.require_format("thermfit-datum", 1);
  file.require_keys({"format", "model", "through_zero", "zero_degC", "digest"});
  if (file.at("model").integer(0, UINT32_MAX) != model)
    file.at("model").fail("the zero of another model", std::to_string(model),
                          "give a datum: then the file becomes this model's");
  RetainedDatum<double, dynamic_size> zero;
  zero.through_zero = file.at("through_zero").boolean() ? 1 : 0;
  const JsonNode values = file.at("zero_degC");
  values.require_keys(names);
  for (const std::string& name : names) {
    const JsonNode value = values.at(name);
    zero.zero_degC.push_back(value.json().is_null() ? std::numeric_limits<double>::quiet_NaN() : value.number());
  }
  zero.seal(model);
  if (file.at("digest").integer(0, UINT32_MAX) != zero.digest)
    file.at("digest").fail("the digest does not fit the content", "", "the file was edited or damaged: give a datum");
  return zero;
}

}  // namespace

KeptZero read_zero(const std::string& path, const std::vector<std::string>& names, std::uint32_t model) {
  KeptZero kept;
  try {
    kept.zero = zero_in(JsonNode(read_json(path), path), names, model);
  } catch (const std::exception& problem) {
    kept.remark = std::string(problem.what()) + "; no zero until there is a datum";
  }
  return kept;
}

void write_zero(const std::string& path, const std::vector<std::string>& names,
                const RetainedDatum<double, dynamic_size>& zero) {
  Json document{{"format", "thermfit-datum/1"},
                {"model", zero.model},
                {"through_zero", zero.through_zero != 0},
                {"zero_degC", Json::object()},
                {"digest", zero.digest}};
  for (std::size_t i = 0; i < names.size(); ++i)
    document["zero_degC"][names[i]] = is_finite(zero.zero_degC[i]) ? Json(zero.zero_degC[i]) : Json();
  write_atomically(path, document.dump(1) + '\n');
}

}  // namespace thermfit::cli
