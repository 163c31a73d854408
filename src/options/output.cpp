#include "options/output.hpp"

#include <algorithm>
#include <filesystem>

#include "options/campaign_options.hpp"
#include "thermfit/error.hpp"
#include "thermfit/io/files/file_identity.hpp"

namespace thermfit::cli {
namespace {

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
  if (path) require_not_read(arguments, *path);
  return path;
}

std::vector<std::string> outputs_in_folder(const Arguments& arguments, const std::vector<std::string>& names) {
  const auto folder = arguments.value("--output-folder");
  if (!folder) return {};
  std::vector<std::string> paths;
  for (const std::string& name : names) {
    paths.push_back((std::filesystem::path(*folder) / name).string());
    require_not_read(arguments, paths.back());
  }
  std::filesystem::create_directories(*folder);
  return paths;
}

}  // namespace thermfit::cli
