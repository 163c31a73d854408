#include <thermfit/number.hpp>
#include <thermfit/thermfit.hpp>

int main() { return thermfit::parse_number("2.5") == 2.5 ? 0 : 1; }
