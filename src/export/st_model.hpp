#pragma once

/// The equation and the training domain in Structured Text: as controller/domain_guard.hpp, in its order.

#include "export/st_features.hpp"

namespace thermfit::cli {

/// Writes what is predicted of readings, and how far they lie from those of training.
template <class Scalar>
class StModel : public StFeatures<Scalar> {
 protected:
  using Base = StFeatures<Scalar>;
  using Base::Base;
  using Base::components;
  using Base::derive_values;
  using Base::derived;
  using Base::errors;
  using Base::fill_in_all;
  using Base::input;
  using Base::inputs;
  using Base::line;
  using Base::made_of;
  using Base::model_;
  using Base::number;
  using Base::numbered;
  using Base::of;
  using Base::real;
  using Base::sensors;
  using Base::set;
  using Base::set_if;
  using Base::settings_;
  using typename Base::Device;

  /// Compensator::has_reference.
  std::string has_reference(std::size_t i) const {
    return model_.rise ? of(i, "zero_known") : "(zero_from = 0 OR " + of(i, "zero_known") + ")";
  }

  /// The readings less the zero, which is 0 where there is none.
  void values() {
    for (std::size_t i = 0; i < sensors(); ++i) set(of(i, "value"), of(i, "reading") + " - " + of(i, "zero"));
    this->derive_values();
  }

  /// The same as the training domain takes them.
  void domain_values() {
    if (model_.rise) return values();
    for (std::size_t i = 0; i < sensors(); ++i) set(of(i, "value"), of(i, "reading"));
  }

  /// Whether the intercept drops out.
  std::string through() const { return model_.rise ? "zero_through" : "zero_from <> 0"; }

  void equation(const typename Device::Model::Equation& from, const std::string& result) {
    for (std::size_t j = 0; j < errors(); ++j) {
      const std::string sum = numbered(result, j);
      line("IF " + through() + " THEN " + sum + " := 0.0; ELSE " + sum + " := " + real(from.intercept_um[j]) +
           "; END_IF;");
      for (std::size_t i = 0; i < inputs(); ++i)
        set(sum, sum + " + " + real(from.coefficients[j][i]) + " * " + input(i));
    }
  }

  std::string standardised(std::size_t i) const {
    return "(" + input(i) + " - " + real(model_.domain.mean[i]) + ") * " + real(model_.domain.inverse_scale[i]);
  }

  void apply_domain() {
    line("IF follow THEN");
    line("(* how far from the samples of training, a missing sensor at what the others let expect *)");
    domain_values();
    if (derived())
      fill_in_channels();
    else
      for (std::size_t i = 0; i < sensors(); ++i) {
        if (!model_.has_substitute[i]) continue;
        line("IF first_unused = " + number(i) + " THEN");
        fill_in(i);
        line("END_IF;");
      }
    share_inside();
    line("IF share < 1.0 THEN");
    set("outside", "TRUE");
    if (settings_.domain_policy == DomainPolicy::shrink)
      for (std::size_t j = 0; j < errors(); ++j) {
        const std::string demand = numbered("demand", j), intercept = real(model_.equation.intercept_um[j]);
        set("centre", real(model_.centre_um[j]));
        line("IF " + through() + " THEN");
        if (model_.rise) {
          set("centre", "centre - " + intercept);
        } else {
          set("others", intercept);
          for (std::size_t i = 0; i < sensors(); ++i)
            set("others", "others + " + real(model_.equation.coefficients[j][i]) + " * " + of(i, "zero"));
          set("centre", "centre - others");
        }
        line("END_IF;");
        set(demand, "centre + share * (" + demand + " - centre)");
      }
    if (settings_.domain_policy == DomainPolicy::hold) set("follow", "FALSE");
    line("END_IF;");
    line("END_IF;");
  }

  /// The channels of the lost sensor, first at their means: then the scores are those of the others.
  void fill_in_channels() {
    const auto for_each_lost = [&](const auto& write) {
      for (std::size_t i = 0; i < sensors(); ++i) {
        if (!model_.has_substitute[i]) continue;
        line("IF first_unused = " + number(i) + " THEN");
        write(i);
        line("END_IF;");
      }
    };
    line("IF unused > 0 THEN");
    for_each_lost([&](std::size_t i) {
      for (const std::size_t f : this->made_of(i)) set(input(f), real(model_.domain.mean[f]));
    });
    scores();
    for_each_lost([&](std::size_t i) { this->fill_in_all(i); });
    line("END_IF;");
  }

  void scores() {
    for (std::size_t a = 0; a < components(); ++a) {
      const std::string score = numbered("score", a);
      set(score, "0.0");
      for (std::size_t i = 0; i < inputs(); ++i)
        set(score, score + " + " + real(model_.domain.rotations[a][i]) + " * (" + standardised(i) + ")");
    }
  }

  /// DomainGuard::fill_in.
  void fill_in(std::size_t sensor) {
    const auto& domain = model_.domain;
    Scalar own = 0;
    set("expectation", "0.0");
    for (std::size_t a = 0; a < components(); ++a) {
      set("residual", "0.0");
      for (std::size_t i = 0; i < sensors(); ++i)
        if (i != sensor) set("residual", "residual + " + real(domain.rotations[a][i]) + " * (" + standardised(i) + ")");
      set("expectation", "expectation + " + real(domain.loadings[a][sensor]) + " * residual");
      own += domain.loadings[a][sensor] * domain.rotations[a][sensor];
    }
    const std::string mean = real(domain.mean[sensor]);
    set(of(sensor, "value"),
        own < Scalar(0.99) ? mean + " + (expectation / " + real(1 - own) + ") / " + real(domain.inverse_scale[sensor])
                           : mean);
  }

  /// DomainGuard::share_inside.
  void share_inside() {
    const auto& domain = model_.domain;
    set("t_squared", "0.0");
    set("spe", "0.0");
    set("share", "1.0");
    for (std::size_t a = 0; a < components(); ++a) {
      const std::string score = numbered("score", a);
      set(score, "0.0");
      for (std::size_t i = 0; i < inputs(); ++i)
        set(score, score + " + " + real(domain.rotations[a][i]) + " * (" + standardised(i) + ")");
      set("t_squared", "t_squared + " + score + " * " + score + " * " + real(domain.inverse_score_variance[a]));
    }
    for (std::size_t i = 0; domain.spe_limit > 0 && i < inputs(); ++i) {
      set("residual", standardised(i));
      for (std::size_t a = 0; a < components(); ++a)
        set("residual", "residual - " + real(domain.loadings[a][i]) + " * " + numbered("score", a));
      set("spe", "spe + residual * residual");
    }
    if (domain.t2_limit > 0)
      set_if("NOT (t_squared <= " + real(domain.t2_limit) + ")", "share", real(domain.t2_limit) + " / t_squared");
    if (domain.spe_limit > 0) {
      line("IF NOT (spe <= " + real(domain.spe_limit) + ") THEN");
      set_if("NOT (share <= " + real(domain.spe_limit) + " / spe)", "share", real(domain.spe_limit) + " / spe");
      line("END_IF;");
    }
    set_if("NOT (share >= 0.0 AND share <= 1.0)", "share", "0.0");
    set_if("share < 1.0", "share", "SQRT(share)");
  }
};

}  // namespace thermfit::cli
