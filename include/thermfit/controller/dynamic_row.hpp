#pragma once

#include <vector>

#include "thermfit/controller/row.hpp"

/// Host only: lets the headers of controller/ take models whose size is known at run time.

namespace thermfit::detail {

template <class T>
struct RowStorage<T, dynamic_size> {
  using type = std::vector<T>;
};

}  // namespace thermfit::detail
