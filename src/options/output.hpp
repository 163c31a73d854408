#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.hpp"

namespace thermfit::cli {

/// Throws Error when `path` is a file that the command line names as an input: itself, in a folder or by a glob, under
/// another name (links) or the same. Measurements are never replaced by what is made of them.
void require_not_read(const Arguments& arguments, const std::string& path);

/// The file that `option` names for the result, if it does. Throws like require_not_read(), and where it is a folder or
/// its folder is not there.
std::optional<std::string> output_path(const Arguments& arguments, const std::string& option = "--output");

/// A file for each of `batches`, called as it and `suffix`, in the folder that --output-folder gives, or --output where
/// that is a folder or ends in a slash; none without those. Makes the folder once it is known that no file of it is
/// read; throws like require_not_read().
std::vector<std::string> outputs_in_folder(const Arguments& arguments, const std::vector<std::string>& batches,
                                           const std::string& suffix);

}  // namespace thermfit::cli
