#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/error.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/number.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// JSON that keeps its keys in the order they were written.
using Json = nlohmann::ordered_json;

/// A value in a JSON document (of nlohmann's type `J`) together with its key path, so that every complaint can say
/// where.
///
/// Refers to the document, which must live longer. Each accessor checks type, finiteness and range and throws
/// Error("file: key.path[3].name", what was found, what is allowed) otherwise.
template <typename J>
class BasicJsonNode {
 public:
  /// `value` at the key path `path` of the document that errors call `file`; the whole document has an empty path.
  BasicJsonNode(const J& value, std::string file, std::string path = {})
      : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

  /// The value itself, unchecked. Does not allocate.
  const J& json() const { return *value_; }
  /// "file: key.path[3].name", as Error::place() has it; the file alone for the whole document. Allocates.
  std::string place() const { return path_.empty() ? file_ : file_ + ": " + path_; }
  /// Throws Error at place() with these parts; never returns.
  [[noreturn]] void fail(const std::string& found, const std::string& allowed = {},
                         const std::string& remedy = {}) const {
    throw Error(place(), found, allowed, remedy);
  }

  /// An object with no keys but these.
  const BasicJsonNode& require_keys(const std::vector<std::string>& allowed) const {
    require(value_->is_object(), "an object");
    for (const auto& [key, unused] : value_->items()) {
      bool known = false;
      for (const std::string& name : allowed) known = known || name == key;
      if (!known)
        fail("unknown key '" + key + "'", name_list(allowed), "remove or rename it" + did_you_mean(key, allowed));
    }
    return *this;
  }
  /// Whether this is an object that has the key. Does not allocate.
  bool has(const std::string& key) const { return value_->is_object() && value_->contains(key); }
  /// The value of a key of an object. Throws Error when this is no object or the key is missing. Allocates.
  BasicJsonNode at(const std::string& key) const {
    require(value_->is_object(), "an object");
    const auto it = value_->find(key);
    if (it == value_->end()) fail("key '" + key + "' is missing");
    return {*it, file_, path_.empty() ? key : path_ + '.' + key};
  }
  /// The value of a key; nothing when it is missing or this is no object. Allocates.
  std::optional<BasicJsonNode> find(const std::string& key) const {
    return has(key) ? std::optional<BasicJsonNode>(at(key)) : std::nullopt;
  }

  /// Length of an array of at most `most` items.
  std::size_t size(std::size_t most = 100000) const {
    require(value_->is_array(), "a list");
    if (value_->size() > most)
      fail("a list of " + std::to_string(value_->size()) + " entries", "at most " + std::to_string(most));
    return value_->size();
  }
  /// Item `i` of an array, from 0. Not checked: this must be an array, and `i` below size(). Allocates.
  BasicJsonNode item(std::size_t i) const { return {(*value_)[i], file_, path_ + '[' + std::to_string(i) + ']'}; }

  /// A finite number from `lowest` to `highest`, both included. Allocates.
  double number(double lowest = -std::numeric_limits<double>::max(),
                double highest = std::numeric_limits<double>::max()) const {
    require(value_->is_number(), range("a number", lowest, highest));
    const double value = value_->template get<double>();
    if (!(value >= lowest && value <= highest)) fail("value " + exact_text(value), range("a number", lowest, highest));
    return value;
  }
  /// A number above zero.
  double positive() const {
    const double value = number();
    if (!(value > 0)) fail("value " + exact_text(value), "a number above 0");
    return value;
  }
  /// A whole number from `lowest` to `highest`, both included, written without decimals and exponent. Allocates.
  Index integer(Index lowest, Index highest) const {
    const std::string allowed = "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
    require(value_->is_number_integer(), allowed);
    const bool above_signed = value_->is_number_unsigned() && value_->template get<std::uint64_t>() > INT64_MAX;
    const Index value = above_signed ? highest : value_->template get<Index>();
    if (above_signed || value < lowest || value > highest) fail("value " + value_->dump(), allowed);
    return value;
  }
  /// `true` or `false`, for which no number stands. Does not allocate.
  bool boolean() const {
    require(value_->is_boolean(), "true or false");
    return value_->template get<bool>();
  }
  /// Text of at most `most` bytes, without control characters.
  std::string text(std::size_t most = 1000) const {
    require(value_->is_string(), "a text");
    std::string value = value_->template get<std::string>();
    if (value.size() > most)
      fail("a text of " + std::to_string(value.size()) + " bytes", "at most " + std::to_string(most));
    for (const char c : value)
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) fail("a control character in a text", "printable text");
    return value;
  }
  /// A text that is one of `allowed`, spelled exactly. Allocates.
  std::string choice(const std::vector<std::string>& allowed) const {
    const std::string value = text();
    for (const std::string& word : allowed)
      if (word == value) return value;
    fail("'" + value + "'", name_list(allowed), "change it" + did_you_mean(value, allowed));
  }
  /// A list of at most `most` texts, each as text() takes it. Allocates.
  std::vector<std::string> texts(std::size_t most = 10000) const {
    std::vector<std::string> values;
    for (std::size_t i = 0, n = size(most); i < n; ++i) values.push_back(item(i).text());
    return values;
  }
  /// A list of exactly `length` finite numbers.
  Vector vector(Index length) const {
    const std::size_t n = size();
    if (static_cast<Index>(n) != length)
      fail("a list of " + std::to_string(n) + " entries", "exactly " + std::to_string(length));
    Vector values(length);
    for (std::size_t i = 0; i < n; ++i) values(static_cast<Index>(i)) = item(i).number();
    return values;
  }
  /// `rows` lists of `columns` finite numbers each.
  Matrix matrix(Index rows, Index columns) const {
    if (static_cast<Index>(size()) != rows)
      fail("a list of " + std::to_string(size()) + " rows", "exactly " + std::to_string(rows));
    Matrix values(rows, columns);
    for (Index i = 0; i < rows; ++i) {
      const Vector row = item(static_cast<std::size_t>(i)).vector(columns);
      for (Index j = 0; j < columns; ++j) values(i, j) = row(j);
    }
    return values;
  }

  /// A document of this name and major version: `"format": "thermfit-model/1"`.
  void require_format(const std::string& name, int major) const {
    const std::string wanted = name + '/' + std::to_string(major);
    if (!value_->is_object() || !has("format")) fail("no \"format\"", "\"" + wanted + "\"", "is this the right file?");
    const std::string found = at("format").text();
    if (found != wanted)
      at("format").fail("'" + found + "'", "'" + wanted + "'",
                        found.rfind(name + '/', 0) == 0 ? "it was written by another version of thermfit"
                                                        : "is this the right file?");
  }

 private:
  void require(bool fits, const std::string& allowed) const {
    if (fits) return;
    std::string shown = value_->is_structured() ? std::string(value_->type_name()) : value_->dump();
    if (shown.size() > 60) shown = shown.substr(0, 60) + "…";
    fail("found " + shown, allowed);
  }
  static std::string range(const std::string& what, double lowest, double highest) {
    const bool bounded_below = lowest > -std::numeric_limits<double>::max();
    const bool bounded_above = highest < std::numeric_limits<double>::max();
    return what + (bounded_below ? " from " + exact_text(lowest) : "") +
           (bounded_above ? " up to " + exact_text(highest) : "");
  }

  const J* value_;
  std::string file_, path_;
};

/// A value in a Json document.
using JsonNode = BasicJsonNode<Json>;

/// Parses JSON text; `file` names it in errors. Syntax errors become Error("file:line:column", …); a key given twice,
/// nesting deeper than 64 and text that is not UTF-8 are errors too.
template <typename J = Json>
J parse_json(const std::string& text, const std::string& file) {
  std::vector<std::set<std::string>> keys;
  const auto watch = [&](int depth, typename J::parse_event_t event, J& parsed) {
    if (depth > 64) throw Error(file, "JSON nested deeper than 64 levels");
    if (event == J::parse_event_t::object_start) keys.emplace_back();
    if (event == J::parse_event_t::object_end) keys.pop_back();
    if (event == J::parse_event_t::key && !keys.back().insert(parsed.template get<std::string>()).second)
      throw Error(file, "key '" + parsed.template get<std::string>() + "' is given twice in one object", "",
                  "remove one");
    return true;
  };
  try {
    return J::parse(text, watch);
  } catch (const typename J::parse_error& error) {
    const std::size_t at = std::min(error.byte ? error.byte - 1 : 0, text.size());
    const std::size_t line =
        1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    const std::size_t start = at ? text.rfind('\n', at - 1) + 1 : 0;  // npos + 1 is 0
    const std::string place = file + ':' + std::to_string(line) + ':' + std::to_string(at - start + 1);
    if (at >= text.size()) throw Error(place, "the document ends too early", "complete JSON", "is the file cut off?");
    throw Error(place, "not JSON here", "JSON (RFC 8259)", "mend the syntax");
  } catch (const typename J::exception& error) {
    throw Error(file, error.what());
  }
}

/// The JSON document in a file of at most `most_bytes`.
template <typename J = Json>
J read_json(const std::string& path, std::size_t most_bytes = std::size_t{64} << 20) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path, "cannot be opened", "", "check the path and its permissions");
  std::string text;
  char buffer[1 << 16];
  while (file.read(buffer, sizeof buffer), file.gcount() > 0) {
    text.append(buffer, static_cast<std::size_t>(file.gcount()));
    if (text.size() > most_bytes)
      throw Error(path, "the file is larger than " + std::to_string(most_bytes >> 20) + " MiB");
  }
  if (file.bad() || !file.eof()) throw Error(path, "cannot be read", "", "is it a folder?");
  return parse_json<J>(text, path);
}

/// A vector or matrix as JSON lists; numbers keep 17 digits where they need them.
template <typename J = Json>
J to_json(const Vector& values) {
  return std::vector<double>(values.data(), values.data() + values.size());
}
/// A matrix as a list of its rows, each a list of numbers. Allocates.
template <typename J = Json>
J to_json(const Matrix& values) {
  J rows = J::array();
  for (Index i = 0; i < values.rows(); ++i) {
    std::vector<double> row;
    for (Index j = 0; j < values.cols(); ++j) row.push_back(values(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

THERMFIT_COMPILED_TEMPLATE(Json parse_json<Json>(const std::string&, const std::string&));
THERMFIT_COMPILED_TEMPLATE(Json read_json<Json>(const std::string&, std::size_t));

}  // namespace thermfit
