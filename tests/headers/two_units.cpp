#include "thermfit/thermfit.hpp"

int main() { return thermfit::LinearModel<float, 2, 1>().sensors() == 2 ? 0 : 1; }
