#pragma once

/// The one place where the version is written; CMake reads it from here. Semantic versioning: below 1.0 a minor version
/// may break.
#define THERMFIT_VERSION_MAJOR 0
#define THERMFIT_VERSION_MINOR 1
#define THERMFIT_VERSION_PATCH 0
#define THERMFIT_VERSION "0.1.0"
