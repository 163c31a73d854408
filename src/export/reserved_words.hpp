#pragma once

#include <string>

namespace thermfit::cli {

/// The languages in which `name` already means something, such as "C and C++"; empty where it is free. Structured Text
/// ignores case, and its conversions (`real_to_int`) count as its words. HAL includes the components that LinuxCNC
/// brings along, which `halcompile --install` would overwrite.
std::string reserved_in(const std::string& name);

}  // namespace thermfit::cli
