#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "thermfit/batch/joined.hpp"
#include "thermfit/io/csv/reading.hpp"
#include "thermfit/io/files/batch_digest.hpp"

namespace thermfit::detail {

/// The name of a file without its folder and the endings that tables have.
inline std::string stem(const std::string& path) {
  std::string name = path.substr(path.rfind('/') + 1);  // npos + 1 is 0
  for (const std::string_view suffix : {".gz", ".csv", ".txt", ".tsv", ".asc", ".lvm", ".dat"})
    if (name.size() > suffix.size() && lower_case(name.substr(name.size() - suffix.size())) == suffix)
      name.erase(name.size() - suffix.size());
  return name;
}

inline bool is_like(const std::string& glob, const std::string& path) {
  return matches_glob(glob, path) || matches_glob(glob, path.substr(path.rfind('/') + 1)) ||
         matches_glob(glob, stem(path));
}

/// "run1" for run1_*.csv: what a glob says without its wildcards; the first file where it says nothing.
inline std::string name_of_joined(const std::string& glob, const std::string& first) {
  std::string name = stem(glob);
  name.erase(std::remove_if(name.begin(), name.end(), [](char c) { return c == '*' || c == '?'; }), name.end());
  const char* const edges = "_-. ";
  const std::size_t begin = name.find_first_not_of(edges);
  return begin == std::string::npos ? first : name.substr(begin, name.find_last_not_of(edges) - begin + 1);
}

/// Makes one batch of those whose files are like a glob of CsvOptions::join, where the first of them stands.
inline void join_files(const std::vector<std::string>& globs, CsvReading& reading) {
  Campaign whole;
  std::vector<std::vector<Batch>> parts(globs.size());
  std::vector<std::size_t> places(globs.size());
  for (Batch& batch : reading.batches) {
    std::size_t into = globs.size();
    for (std::size_t g = 0; g < globs.size(); ++g) {
      if (!is_like(globs[g], batch.source)) continue;
      if (into < globs.size())
        throw problem(batch.source,
                      {"is like ", shown(globs[into]), " and like ", shown(globs[g]), " (CsvOptions::join)"},
                      {"one batch for a file"});
      into = g;
    }
    if (into == globs.size()) {
      whole.push_back(std::move(batch));
      continue;
    }
    if (parts[into].empty()) {
      places[into] = whole.size();
      whole.emplace_back();
    }
    parts[into].push_back(std::move(batch));
  }
  for (std::size_t g = 0; g < globs.size(); ++g) {
    if (parts[g].empty()) {
      std::vector<std::string> names;
      for (const CsvFile& file : reading.files) names.push_back(file.path.substr(file.path.rfind('/') + 1));
      throw problem("CsvOptions::join", {"no file is like ", shown(globs[g])}, {"files among ", name_list(names)});
    }
    Batch& batch = whole[places[g]];
    const std::size_t count = parts[g].size();
    const std::string name = name_of_joined(globs[g], parts[g].front().name);
    batch = joined(std::move(parts[g]), name);
    batch.digest = batch_digest(batch);
    reading.joined.push_back(batch.name + ": " + std::to_string(count) + (count == 1 ? " file" : " files") + " like " +
                             globs[g] + " as one batch, the first " + batch.source);
  }
  reading.batches = std::move(whole);
}

}  // namespace thermfit::detail
