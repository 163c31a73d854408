#pragma once

#include <cmath>

#include "thermfit/controller/arithmetic.hpp"
#include "thermfit/controller/controller_model.hpp"

namespace thermfit {

/// What to do with a sample unlike those the model was trained on.
enum class DomainPolicy : std::uint8_t {
  ignore,  ///< do not look
  warn,    ///< follow the model, say so in the status
  shrink,  ///< follow the model at the edge of the domain, on the way from the sample to the domain's mean
  hold     ///< treat the sample as unusable
};

/// Tells how far out a sample lies: T2 and SPE as in training_domain.hpp.
template <class Scalar, int Inputs, int Components>
class DomainGuard {
 public:
  using Domain = ControllerDomain<Scalar, Inputs, Components>;  ///< the training domain it looks at

  /// Makes room for the scores of `domain`. Only dynamic rows allocate.
  void reset(const Domain& domain) { detail::set_size(scores_, domain.inverse_score_variance.size()); }

  /// Puts into `temperatures` what the domain expects `sensor` to be, from the others: the value that leaves it no
  /// residual of its own, x = sum_a p_a sum_(k != i) r_ka z_k / (1 - sum_a p_a r_ia) in standardised temperatures.
  void fill_in(const Domain& domain, Row<Scalar, Inputs>& temperatures, std::size_t sensor) const noexcept {
    Scalar expected = 0, own = 0;
    for (std::size_t a = 0; a < scores_.size(); ++a) {
      Scalar score = 0;
      for (std::size_t i = 0; i < domain.mean.size(); ++i)
        if (i != sensor)
          score += domain.rotations[a][i] * ((temperatures[i] - domain.mean[i]) * domain.inverse_scale[i]);
      expected += domain.loadings[a][sensor] * score;
      own += domain.loadings[a][sensor] * domain.rotations[a][sensor];
    }
    const Scalar standardised = own < Scalar(0.99) ? expected / (1 - own) : Scalar(0);
    temperatures[sensor] = domain.mean[sensor] + standardised / domain.inverse_scale[sensor];
  }

  /// The same for all inputs that are `missing`, which one sensor's features are: those that leave none of them a
  /// residual, z = (1 - P R')^-1 P (scores of the others), by Gauss and Seidel's sweeps, which converge as each lowers
  /// SPE. Where the components span an input it has no residual: then the value of least T2,
  /// z = -sum_a r_a t_a / v_a / sum_a r_a^2 / v_a with the scores t of the others and their variances v.
  template <class Missing>
  void fill_in_all(const Domain& domain, Row<Scalar, Inputs>& inputs, Missing missing) noexcept {
    const std::size_t n = domain.mean.size();
    for (std::size_t a = 0; a < scores_.size(); ++a) {
      scores_[a] = 0;
      for (std::size_t i = 0; i < n; ++i)
        if (!missing(i))
          scores_[a] += domain.rotations[a][i] * ((inputs[i] - domain.mean[i]) * domain.inverse_scale[i]);
    }
    for (std::size_t f = 0; f < n; ++f)
      if (missing(f)) inputs[f] = 0;
    for (int sweep = 0; sweep < fill_in_sweeps; ++sweep)
      for (std::size_t f = 0; f < n; ++f) {
        if (!missing(f)) continue;
        const bool spanned = !(shared(domain, f, f, false) < Scalar(0.99));
        Scalar expected = 0;
        for (std::size_t a = 0; a < scores_.size(); ++a) expected += weight(domain, a, f, spanned) * scores_[a];
        for (std::size_t g = 0; g < n; ++g)
          if (g != f && missing(g)) expected += shared(domain, f, g, spanned) * inputs[g];
        const Scalar own = shared(domain, f, f, spanned);
        inputs[f] = !spanned ? expected / (1 - own) : own > 0 ? -expected / own : Scalar(0);
      }
    for (std::size_t f = 0; f < n; ++f)
      if (missing(f)) inputs[f] = domain.mean[f] + inputs[f] / domain.inverse_scale[f];
  }

  static constexpr int fill_in_sweeps = 8;  ///< of the features of a lost sensor

  /// 1 inside the domain; else the factor in 0…1 by which the way from the mean to `temperatures` must shrink for the
  /// sample to lie on the edge: sqrt(limit / distance), the smaller of T2's and SPE's. 0 when that is no number.
  Scalar share_inside(const Domain& domain, const Row<Scalar, Inputs>& temperatures) noexcept {
    Scalar t2 = 0, spe = 0;
    for (std::size_t a = 0; a < scores_.size(); ++a) {
      Scalar score = 0;
      for (std::size_t i = 0; i < domain.mean.size(); ++i)
        score += domain.rotations[a][i] * ((temperatures[i] - domain.mean[i]) * domain.inverse_scale[i]);
      scores_[a] = score;
      t2 += score * score * domain.inverse_score_variance[a];
    }
    for (std::size_t i = 0; domain.spe_limit > 0 && i < domain.mean.size(); ++i) {
      Scalar residual = (temperatures[i] - domain.mean[i]) * domain.inverse_scale[i];
      for (std::size_t a = 0; a < scores_.size(); ++a) residual -= domain.loadings[a][i] * scores_[a];
      spe += residual * residual;
    }
    Scalar share = 1;
    if (domain.t2_limit > 0 && !(t2 <= domain.t2_limit)) share = domain.t2_limit / t2;
    if (domain.spe_limit > 0 && !(spe <= domain.spe_limit) && !(share <= domain.spe_limit / spe))
      share = domain.spe_limit / spe;
    if (!within(share, Scalar(0), Scalar(1))) return 0;
    return share < 1 ? std::sqrt(share) : share;
  }

 private:
  /// What a score gives to input f: its loading, or of one that the components span its pull on T2.
  static Scalar weight(const Domain& domain, std::size_t a, std::size_t f, bool spanned) noexcept {
    return spanned ? domain.rotations[a][f] * domain.inverse_score_variance[a] : domain.loadings[a][f];
  }
  /// How much of input g the components so give to input f.
  static Scalar shared(const Domain& domain, std::size_t f, std::size_t g, bool spanned) noexcept {
    Scalar sum = 0;
    for (std::size_t a = 0; a < domain.rotations.size(); ++a)
      sum += weight(domain, a, f, spanned) * domain.rotations[a][g];
    return sum;
  }

  Row<Scalar, Components> scores_{};
};

}  // namespace thermfit
