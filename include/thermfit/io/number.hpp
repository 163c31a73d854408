#pragma once

#include "thermfit/number.hpp"  // moved; this file goes
