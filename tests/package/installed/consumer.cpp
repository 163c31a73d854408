#include <thermfit/thermfit.hpp>

int main() {
  thermfit::LinearModel<double, 2, 1> model;
  model.intercept << 1;
  model.coefficients << 2, 3;
  return model.predict(Eigen::Vector2d(10, 100))(0) == 321 ? 0 : 1;
}
