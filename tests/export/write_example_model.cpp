/// Writes the example model of tests/controller to the file named, with a training domain whose components all sensors
/// share: there a lost sensor can be expected from the others.
#include "controller/example_model.hpp"
#include "thermfit/io/json/model.hpp"

int main(int count, char** words) {
  if (count != 2) return 2;
  thermfit::TrainedModel model = example_model();
  model.domain.rotations << 2, 1, 2, -2, 1, 2;
  model.domain.rotations /= 3;  // orthonormal, and not exact in binary
  model.domain.loadings = model.domain.rotations;
  thermfit::save_model(model, words[1]);
  return 0;
}
