/// Writes the example model of tests/controller to the file named.
#include "controller/example_model.hpp"
#include "thermfit/io/json/model.hpp"

int main(int count, char** words) {
  if (count != 2) return 2;
  thermfit::save_model(example_model(), words[1]);
  return 0;
}
