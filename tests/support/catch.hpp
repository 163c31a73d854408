#pragma once

/// Catch2 as Debian ships it: version 2 in Debian 12, version 3 later.

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
#endif
