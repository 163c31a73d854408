#pragma once

/// The one place where the version is written; CMake reads it from here. Semantic versioning: below 1.0 a minor version
/// may break.
#define THERMFIT_VERSION_MAJOR 0
#define THERMFIT_VERSION_MINOR 1
#define THERMFIT_VERSION_PATCH 0
#define THERMFIT_VERSION "0.1.0"

/// The same as one number for `#if`: 10000 major + 100 minor + patch.
#define THERMFIT_VERSION_NUMBER (THERMFIT_VERSION_MAJOR * 10000 + THERMFIT_VERSION_MINOR * 100 + THERMFIT_VERSION_PATCH)
