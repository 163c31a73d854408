#include "export/source_text.hpp"

#include <algorithm>
#include <stdexcept>

#include "thermfit/error.hpp"
#include "thermfit/io/json/model.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

OffsetUnit offset_unit(const std::string& name) {
  if (name == "um") return {"um", "um", 1};
  if (name == "mm") return {"mm", "mm", .001};
  if (name == "0.1um") return {"0.1 um", "tenth_um", 10};
  throw Error("unit", "'" + name + "'", "um, mm, 0.1um");
}

std::string chosen_parts(std::string_view text, const std::vector<std::string>& wanted) {
  std::string result;
  bool keep = true;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end == text.npos ? end : end + 1);
    text.remove_prefix(line.size());
    if (line == "@.@\n") {
      keep = true;
    } else if (line.substr(0, 2) == "@?") {
      const std::string part(line.substr(2, line.find('@', 2) - 2));
      keep = std::find(wanted.begin(), wanted.end(), part) != wanted.end();
    } else if (keep) {
      result += line;
    }
  }
  return result;
}

std::string fill_template(std::string_view text, const std::map<std::string, std::string>& values) {
  std::string result;
  while (true) {
    const auto open = text.find('@');
    result += text.substr(0, open);
    if (open == std::string_view::npos) return result;
    const auto close = text.find('@', open + 1);
    const auto found = close == std::string_view::npos
                           ? values.end()
                           : values.find(std::string(text.substr(open + 1, close - open - 1)));
    if (found == values.end()) throw std::logic_error("no value for " + std::string(text.substr(open, 20)));
    result += found->second;
    text.remove_prefix(close + 1);
  }
}

std::vector<std::string> identifiers(const std::vector<std::string>& names) {
  std::vector<std::string> result, taken;
  for (const std::string& name : names) {
    std::string identifier;
    for (const char c : name) {
      if (is_letter(c) || is_digit(c))
        identifier += c;
      else if (!identifier.empty() && identifier.back() != '_')
        identifier += '_';
    }
    if (identifier.empty() || is_digit(identifier[0])) identifier = "P" + identifier;
    identifier = identifier.substr(0, 20);
    while (identifier.back() == '_') identifier.pop_back();  // begins with a letter
    const std::string base = identifier;
    for (int n = 2; std::find(taken.begin(), taken.end(), upper_case(identifier)) != taken.end(); ++n)
      identifier = base + "_n" + std::to_string(n);
    taken.push_back(upper_case(identifier));
    result.push_back(identifier);
  }
  return result;
}

std::string comment_text(std::string_view text) {
  std::string result;
  for (const char c : text)
    result += c == '*' || c == '@' || c == '\\' || static_cast<unsigned char>(c) < ' ' ? '_' : c;
  return result;
}

std::string upper_case(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

void require_formula(const ExportRequest& request, const std::string& target, const std::string& why) {
  if (request.trained.features.empty()) return;
  throw Error("--target " + target,
              "a model of the method " + request.trained.method +
                  ", which remembers lags and the climate of the session: " + why,
              "c, cpp, st, linuxcnc", "export it to one of these, or fit pls, mlr, pcr or ridge");
}

std::string sign_name(OutputSign sign) { return sign == OutputSign::error ? "error" : "correction"; }

std::string policy_name(DomainPolicy policy) {
  const char* const names[] = {"ignore", "warn", "shrink", "hold"};
  return names[static_cast<int>(policy)];
}

std::string zero_name(ZeroPolicy policy) { return policy == ZeroPolicy::first ? "first" : "wait"; }

std::vector<std::string> facts(const ExportRequest& request) {
  const TrainedModel& model = request.trained;
  const auto settings = settings_for<double>(model, request.wishes);
  std::vector<std::string> batches;
  for (const TrainingBatch& batch : model.batches) batches.push_back(batch.name);
  std::vector<std::string> lines{
      "Written by thermfit " THERMFIT_VERSION " from " + request.source,
      "model " + model_to_json(model)["digest"].get<std::string>(),
      "method " + model.method + ", trained on " + std::to_string(batches.size()) + " batches: " + joined(batches),
      "",
      "in:  temperatures in degC, in this order: " + joined(model.temperatures),
      model.reference == TemperatureReference::rise
          ? "     the model works on their rise since the zero: a datum, kept over a power cycle, or first samples"
          : "     the model works on absolute temperatures; after a datum on their rise since it",
      "out: offset of " + joined(model.errors) + " in " + request.unit.name,
      request.wishes.sign == OutputSign::correction
          ? "     it is the correction, minus the predicted error: add it to the axis command"
          : "     it is the predicted thermal error: subtract it from the axis command"};
  if (!model.features.empty())
    lines.insert(lines.begin() + 6, "     and on channels derived from it: " + std::to_string(model.features.size()) +
                                        " in all, " + std::to_string(detail::lags_of(model).size()) +
                                        " lags; climates of training " + general_text(model.climate.lowest, 4) +
                                        " to " + general_text(model.climate.highest, 4) + " degC");
  for (std::size_t j = 0; j < model.errors.size(); ++j)
    lines.push_back("     " + model.errors[j] + ": clamp +-" + exact_text(settings.outputs[j].clamp_um) + " um, slew " +
                    exact_text(settings.outputs[j].slew_um_per_step) + " um per step of " +
                    exact_text(request.wishes.period_s) + " s; residual deviation in training " +
                    general_text(model.residual_deviation_um(static_cast<Index>(j)), 3) + " um");
  lines.push_back("outside the training domain: " + policy_name(settings.domain_policy));
  for (std::string& line : lines) line = comment_text(line);
  return lines;
}

std::string fact_comment(const ExportRequest& request, std::string_view mark) {
  std::string text;
  for (const std::string& line : facts(request)) {
    text += mark;
    text += line.empty() ? "" : " " + line;
    text += '\n';
  }
  return text;
}

}  // namespace thermfit::cli
