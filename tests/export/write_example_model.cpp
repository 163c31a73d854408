/// write_example_model FILE ABSOLUTE_FILE TRANSFER_FILE: writes the example model of tests/controller, with a training
/// domain whose components all sensors share, so that a lost sensor can be expected from the others; and the same on
/// absolute temperatures for a machine that starts at 18 degC; and the one on derived channels.
#include "controller/example_model.hpp"
#include "thermfit/io/json/model.hpp"

int main(int count, char** words) {
  if (count != 4) return 2;
  thermfit::save_model(example_transfer_model(), words[3]);
  thermfit::TrainedModel model = example_model();
  model.domain.rotations << 2, 1, 2, -2, 1, 2;
  model.domain.rotations /= 3;  // orthonormal, and not exact in binary
  model.domain.loadings = model.domain.rotations;
  thermfit::save_model(model, words[1]);
  model.reference = thermfit::TemperatureReference::absolute;
  model.model.intercept -= model.model.coefficients.transpose() * Eigen::Vector3d(18, 18, 18);
  model.domain.mean.array() += 18;
  for (thermfit::SubstituteModel& substitute : model.substitutes)
    substitute.model.intercept -= substitute.model.coefficients.transpose() * Eigen::Vector3d(18, 18, 18);
  thermfit::save_model(model, words[2]);
  return 0;
}
