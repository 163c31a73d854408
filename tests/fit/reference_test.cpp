// Coefficients, latent variables and errors against R pls, scikit-learn, 50-digit arithmetic and NIST.
#include "support/catch.hpp"
#include "support/numeric_csv.hpp"
#include "support/shared_data.hpp"
#include "thermfit/fit/fit.hpp"
#include "thermfit/fit/jackknife.hpp"
#include "thermfit/io/json/node.hpp"

using namespace thermfit;
using json = thermfit::Json;

namespace {

struct DataSet {
  std::string name, first_x, last_x, first_y, last_y;
};

const std::vector<DataSet> data_sets{{"yarn", "NIR1", "NIR268", "density", "density"},
                                     {"gasoline", "NIR_900nm", "NIR_1700nm", "octane", "octane"},
                                     {"oliveoil", "Acidity", "DK", "yellow", "syrup"},
                                     {"linnerud", "Chins", "Jumps", "Weight", "Pulse"},
                                     {"thermalW1b1", "T1", "T10", "Z", "Z"}};

struct Reference {
  Matrix x, y;
  Moments<> moments;
  Reference(const std::string& folder, const DataSet& set) {
    const NumericCsv csv(folder + "/pls_reference/" + set.name + ".csv");
    x = csv.columns(set.first_x, set.last_x);
    y = csv.columns(set.first_y, set.last_y);
    moments = Moments(x, y);
  }
};

/// What `by` says of a data set.
json reference_of(const std::string& folder, const DataSet& set, const std::string& by) {
  return read_json(folder + "/pls_reference/ref_" + set.name + "_" + by + ".json");
}

/// A matrix from nested lists, or one column from a flat list.
Matrix matrix(const json& rows) {
  const bool flat = !rows.at(0).is_array();
  Matrix result(static_cast<Index>(rows.size()), flat ? 1 : static_cast<Index>(rows[0].size()));
  for (Index r = 0; r < result.rows(); ++r) {
    const json& row = rows[static_cast<std::size_t>(r)];
    for (Index c = 0; c < result.cols(); ++c) {
      result(r, c) = (flat ? row : row[static_cast<std::size_t>(c)]).get<double>();
    }
  }
  return result;
}

/// Largest difference relative to the largest entry of each column: coefficients of one response share a size.
double difference(const Matrix& ours, const Matrix& theirs) {
  REQUIRE(ours.rows() == theirs.rows());
  REQUIRE(ours.cols() == theirs.cols());
  double worst = 0;
  for (Index c = 0; c < ours.cols(); ++c) {
    worst = std::max(worst, (ours.col(c) - theirs.col(c)).cwiseAbs().maxCoeff() / theirs.col(c).cwiseAbs().maxCoeff());
  }
  return worst;
}

FitOptions options(Scaling scaling, Index components) {
  FitOptions result;
  result.scaling = scaling;
  result.components = ComponentRule::fixed(components);
  return result;
}

}  // namespace

TEST_CASE("PLS1 agrees with 50-digit arithmetic, from moments and from rows", "[fit]") {
  REQUIRE_SHARED_DATA(folder);
  for (const DataSet& set : data_sets) {
    if (set.name == "oliveoil" || set.name == "linnerud") continue;
    const Reference data(folder, set);
    double worst_rows = 0, worst_moments = 0;
    const json reference = reference_of(folder, set, "exact");
    for (const json& exact : reference.at("fits")) {
      const FitOptions how =
          options(exact.at("scale").get<bool>() ? Scaling::both : Scaling::centre, exact.at("ncomp").get<Index>());
      const Matrix b = matrix(exact.at("B"));
      worst_rows = std::max(worst_rows, difference(fit_pls(data.x, data.y, how).model.coefficients, b));
      worst_moments = std::max(worst_moments, difference(fit_pls(data.moments, how).model.coefficients, b));
    }
    CAPTURE(set.name, worst_rows, worst_moments);

    CHECK(worst_rows < 1e-12);
    CHECK(worst_moments < 1e-9);
  }
}

TEST_CASE("PLS agrees with R kernelpls and oscorespls: coefficients and every latent quantity", "[fit]") {
  REQUIRE_SHARED_DATA(folder);
  for (const DataSet& set : data_sets) {
    const Reference data(folder, set);
    const json reference = reference_of(folder, set, "R");
    for (const json& theirs : reference.at("fits")) {
      const auto method = theirs.at("method").get<std::string>();
      const bool pcr = method == "svdpc";
      if (method == "simpls" && data.y.cols() > 1) continue;  // another method when there are several responses
      const auto most = theirs.at("ncomp").get<Index>();
      const Scaling scaling = theirs.at("scaleX").get<bool>() ? Scaling::temperatures : Scaling::centre;
      CAPTURE(set.name, method, most, theirs.at("scaleX").get<bool>());
      for (const json& c : theirs.at("coefficients")) {
        const auto a = c.at("ncomp").get<Index>();
        if (method == "simpls" && a > 3) continue;  // loses digits itself: 1e-8 at four components, 1.8e-3 at ten
        CAPTURE(a);
        const FitOptions how = options(scaling, a);
        const LinearFit<> rows = pcr ? fit_pcr(data.x, data.y, how) : fit_pls(data.x, data.y, how);
        const LinearFit<> mom = pcr ? fit_pcr(data.moments, how) : fit_pls(data.moments, how);
        REQUIRE(rows.components == a);
        CHECK(difference(rows.model.coefficients, matrix(c.at("B"))) < 1e-9);
        CHECK(difference(mom.model.coefficients, matrix(c.at("B"))) < 1e-9);
        CHECK(difference(rows.model.intercept.transpose(), matrix(c.at("intercept")).transpose()) < 1e-9);
      }
      const FitOptions how = options(scaling, most);
      const LinearFit<> fit = pcr ? fit_pcr(data.x, data.y, how) : fit_pls(data.x, data.y, how);
      const Matrix explained = fit.latent.explained_temperature_variance;
      double cumulative = 0;
      for (Index a = 0; a < most; ++a) {
        cumulative += theirs.at("explvarX_percent")[static_cast<std::size_t>(a)].get<double>() / 100;
        CHECK(explained(a, 0) == Approx(cumulative).epsilon(1e-9));
      }
      if (pcr || method == "simpls") continue;  // weights and loadings are normalised differently there
      // Equal up to the sign of a component, which R leaves open.
      const Matrix w = matrix(theirs.at("loading_weights_W")), p = matrix(theirs.at("loadings_P"));
      const Matrix r = matrix(theirs.at("projection_R")), t = matrix(theirs.at("scores_T"));
      const Matrix q = matrix(theirs.at("Yloadings_Q"));
      Vector sign(most);
      for (Index a = 0; a < most; ++a) sign(a) = w.col(a).dot(fit.latent.weights.col(a)) < 0 ? -1 : 1;
      // kernelpls never deflates X and loses digits of the last weights itself (1e-7 at ten components).
      CHECK(difference(fit.latent.weights, w * sign.asDiagonal()) < (method == "kernelpls" ? 1e-6 : 1e-8));
      CHECK(difference(fit.latent.loadings, p * sign.asDiagonal()) < 1e-8);
      CHECK(difference(fit.latent.rotations, r * sign.asDiagonal()) < 1e-8);
      CHECK(difference(fit.latent.error_loadings, q * sign.asDiagonal()) < 1e-8);
      CHECK(difference(scores(fit, data.x), t * sign.asDiagonal()) < 1e-8);
    }
  }
}

TEST_CASE("PLS with both blocks standardised agrees with scikit-learn and ikpls", "[fit]") {
  REQUIRE_SHARED_DATA(folder);
  for (const DataSet& set : data_sets) {
    const Reference data(folder, set);
    const json reference = reference_of(folder, set, "sklearn");
    int compared = 0;
    for (const json& theirs : reference.at("fits")) {
      const auto algorithm = theirs.at("algorithm").get<std::string>();
      if (algorithm == "PLSCanonical" || algorithm == "CCA") continue;      // other methods
      if (data.y.cols() > 1 && theirs.value("tol", 0.0) > 1e-10) continue;  // NIPALS stopped early
      CAPTURE(set.name, algorithm, theirs.at("ncomp").get<Index>(), theirs.at("scale").get<bool>());
      const FitOptions how =
          options(theirs.at("scale").get<bool>() ? Scaling::both : Scaling::centre, theirs.at("ncomp").get<Index>());
      const Matrix b = matrix(theirs.at("B"));
      // With several responses scikit-learn iterates until the square of a step is below 1e-15: 3e-8 of a weight.
      const double close = data.y.cols() > 1 && theirs.contains("tol") ? 1e-7 : 1e-9;
      CHECK(difference(fit_pls(data.x, data.y, how).model.coefficients, b) < close);
      CHECK(difference(fit_pls(data.moments, how).model.coefficients, b) < close);
      ++compared;
    }
    CHECK(compared >= 18);
  }
}

TEST_CASE("squared errors on left-out segments agree with R's cross-validation", "[fit]") {
  REQUIRE_SHARED_DATA(folder);
  for (const DataSet& set : data_sets) {
    const Reference data(folder, set);
    const json reference = reference_of(folder, set, "R");
    for (const json& theirs : reference.at("fits")) {
      const auto method = theirs.at("method").get<std::string>();
      if (theirs.at("scaleX").get<bool>() || (method != "kernelpls" && method != "svdpc")) continue;
      if (data.x.cols() > 300 && method == "svdpc") continue;  // 60 eigenproblems of order 401: the time of a suite
      for (const json& cv : theirs.at("cv")) {
        const auto name = cv.at("name").get<std::string>();
        if (data.x.cols() > 100 && name == "LOO") continue;
        CAPTURE(set.name, method, name);
        std::vector<Moments<>> batches;
        const json& segments = reference.at("cv_segments").at(name);
        for (const json& segment : segments) {
          Moments batch(data.x.cols(), data.y.cols());
          const auto add = [&](const json& row) {
            const Index r = row.get<Index>() - 1;
            batch.add_rows(data.x.row(r), data.y.row(r));
          };
          if (segment.is_array()) {
            for (const json& row : segment) add(row);
          } else {
            add(segment);
          }
          batches.push_back(batch);
        }
        const Matrix press = matrix(cv.at("PRESS"));
        FitOptions how = options(Scaling::centre, press.cols());
        const std::vector<Moments<>> others = leave_one_out(batches);
        Matrix ours = Matrix::Zero(press.rows(), press.cols());
        for (std::size_t i = 0; i < batches.size(); ++i) {
          const auto path = method == "svdpc" ? pcr_path(others[i], how) : pls_path(others[i], how);
          REQUIRE(static_cast<Index>(path.size()) == press.cols());
          for (Index a = 0; a < press.cols(); ++a) {
            const auto errors = residuals(path[static_cast<std::size_t>(a)], batches[i]);
            for (Index e = 0; e < press.rows(); ++e) {
              ours(e, a) += errors[static_cast<std::size_t>(e)].sum_of_squares();
            }
          }
        }
        CHECK((ours.array() / press.array() - 1).abs().maxCoeff() < 1e-8);
      }
    }
  }
}

TEST_CASE("jackknife over single rows agrees with R jack.test", "[fit]") {
  REQUIRE_SHARED_DATA(folder);
  for (const DataSet& set : data_sets) {
    if (set.name == "gasoline" || set.name == "yarn") continue;  // hundreds of columns: the time of a suite
    const Reference data(folder, set);
    const json reference = reference_of(folder, set, "R").at("jackknife");
    std::vector<Moments<>> batches;
    for (Index r = 0; r < data.x.rows(); ++r) batches.emplace_back(data.x.row(r), data.y.row(r));
    const FitOptions how = options(Scaling::centre, reference.at("ncomp").get<Index>());
    const CoefficientSpread<> spread = jackknife(batches, [&](const Moments<>& m) { return fit_pls(m, how); });
    CAPTURE(set.name);
    CHECK(difference(spread.model.coefficients, matrix(reference.at("coef"))) < 1e-9);
    CHECK(difference(spread.deviation, matrix(reference.at("sd"))) < 1e-9);
    CHECK(difference(spread.p_values(), matrix(reference.at("pvalues"))) < 1e-8);
    CHECK(spread.degrees_of_freedom == reference.at("df").at(0).get<Index>());
  }
}

TEST_CASE("least squares agrees with R lm: coefficients, sigma and degrees of freedom", "[fit]") {
  REQUIRE_SHARED_DATA(folder);
  const Reference data(folder, data_sets.back());
  const json reference = reference_of(folder, data_sets.back(), "lm_R");
  const Matrix coefficients = matrix(reference.at("coef"));
  for (const LinearFit<>& fit : {fit_mlr(data.x, data.y), fit_mlr(Moments(data.x, data.y))}) {
    CHECK(difference(fit.model.coefficients, coefficients.bottomRows(10)) < 1e-10);
    CHECK(fit.model.intercept(0) == Approx(coefficients(0, 0)).epsilon(1e-10));
    CHECK(fit.rank == 10);
    CHECK(fit.degrees_of_freedom == 69);
    const double sigma = fit.residual_deviation_um(0) * std::sqrt(79.0 / 69.0);
    CHECK(sigma == Approx(reference.at("sigma").get<double>()).epsilon(1e-10));
  }
}

TEST_CASE("least squares reaches the certified values of Longley's data", "[fit]") {
  REQUIRE_SHARED_DATA(folder);
  const Reference data(folder, {"longley", "GNP.deflator", "Year", "Employed", "Employed"});
  Matrix certified(6, 1);  // NIST StRD, in the units of this file
  certified << 15.0618722713733e-3, -0.0358191792925910, -2.02022980381683e-2, -1.03322686717359e-2,
      -0.0511041056535807, 1829.15146461355e-3;
  for (const LinearFit<>& fit : {fit_mlr(data.x, data.y), fit_mlr(Moments(data.x, data.y))}) {
    for (Index i = 0; i < 6; ++i) {
      CAPTURE(i, fit.model.coefficients(i), certified(i));
      CHECK(std::abs(fit.model.coefficients(i) / certified(i) - 1) < 1e-10);
    }
    CHECK(std::abs(fit.model.intercept(0) / -3482.25863459582 - 1) < 1e-10);
    CHECK(fit.residual_deviation_um(0) * std::sqrt(15.0 / 9.0) == Approx(.304854073561965).epsilon(1e-11));
    CHECK(fit.condition_number == Approx(110.5).epsilon(.01));
  }
}
