#include "options/output.hpp"

#include <algorithm>
#include <filesystem>

#include "options/campaign_options.hpp"
#include "thermfit/error.hpp"
#include "thermfit/io/files/file_identity.hpp"

namespace thermfit::cli {
namespace {

namespace fs = std::filesystem;

/// A path that ends in a slash, or a folder that is there.
bool names_folder(const std::string& path) {
  std::error_code ignored;
  return !path.empty() && (path.back() == '/' || fs::is_directory(path, ignored));
}

/// Options whose values are written, or read and written on purpose.
const char* const written[] = {"--output", "--output-folder", "--write", "--state"};

/// The files that a word of the command line stands for, if it stands for any.
std::vector<std::string> files_of(const std::string& word) {
  try {
    return find_files({word});
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

void require_not_read(const Arguments& arguments, const std::string& path) {
  const auto target = file_identity(path);
  if (!target) return;
  for (const auto& [option, word] : arguments.words()) {
    if (std::find(std::begin(written), std::end(written), option) != std::end(written)) continue;
    for (const std::string& file : files_of(word))
      if (file_identity(file) == target)
        throw Error(path, "is " + (file == path ? "read by this command" : "the file " + file + ", which this reads"),
                    "a file that is not an input", "write to another one: what was measured is never replaced");
  }
}

std::optional<std::string> output_path(const Arguments& arguments, const std::string& option) {
  const auto path = arguments.value(option);
  if (!path) return path;
  require_not_read(arguments, *path);
  if (names_folder(*path))
    throw Error(*path, "is a folder (" + option + ")", "the name of a file",
                "what is written here is one file: " + (fs::path(*path) / "NAME").string());
  const fs::path folder = fs::path(*path).parent_path();
  std::error_code ignored;
  if (!folder.empty() && !fs::exists(folder, ignored))
    throw Error(*path, "there is no folder " + folder.string(), "a file in a folder that exists",
                "make it first: mkdir -p " + folder.string());
  return path;
}

std::vector<std::string> outputs_in_folder(const Arguments& arguments, const std::vector<std::string>& batches,
                                           const std::string& suffix) {
  auto folder = arguments.value("--output-folder");
  if (const auto output = arguments.value("--output"); output && names_folder(*output)) {
    if (folder) throw UsageError("--output and --output-folder name two folders");
    folder = output;
  }
  if (!folder) return {};
  while (folder->size() > 1 && folder->back() == '/') folder->pop_back();
  std::error_code failed;
  if (fs::exists(*folder, failed) && !fs::is_directory(*folder, failed))
    throw Error(*folder, "is a file", "a folder, there or to be made", "one file for each batch is written");
  std::vector<std::string> paths;
  for (std::string name : batches) {
    std::replace(name.begin(), name.end(), '/', '_');  // batches of one name are called by their paths
    paths.push_back((fs::path(*folder) / (name + suffix)).string());
    if (std::count(paths.begin(), paths.end(), paths.back()) > 1)
      throw Error(paths.back(), "two batches would be written to it", "batches with names that differ");
    require_not_read(arguments, paths.back());
  }
  fs::create_directories(*folder, failed);
  if (failed) throw Error(*folder, failed.message(), "a folder that can be made");
  return paths;
}

}  // namespace thermfit::cli
