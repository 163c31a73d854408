#include "thermfit/version.hpp"

#include <string>

#include "support/catch.hpp"

#if THERMFIT_VERSION_NUMBER < 100
#error "a version is a number that #if can compare"
#endif

TEST_CASE("the version is the same in words, as a number and in parts") {
  CHECK(std::string(THERMFIT_VERSION) == std::to_string(THERMFIT_VERSION_MAJOR) + '.' +
                                             std::to_string(THERMFIT_VERSION_MINOR) + '.' +
                                             std::to_string(THERMFIT_VERSION_PATCH));
  CHECK(THERMFIT_VERSION_NUMBER / 10000 == THERMFIT_VERSION_MAJOR);
  CHECK(THERMFIT_VERSION_NUMBER / 100 % 100 == THERMFIT_VERSION_MINOR);
  CHECK(THERMFIT_VERSION_NUMBER % 100 == THERMFIT_VERSION_PATCH);
}
