// From batches to models and their robustness, in one page: quick_start data/vcenter55/*.csv
#include <cstdio>

#include "thermfit/io/csv/reader.hpp"
#include "thermfit/study.hpp"

int main(int count, char** paths) try {
  using namespace thermfit;
  const Campaign campaign = read_campaign({paths + 1, paths + count}).batches;
  const std::vector<Observations<>> batches = observe(campaign);  // temperature rise, and the moments of every batch

  // In every batch the two points most correlated with the error, a PLS model on them, and its S on every batch.
  const SweepStep<> step = cross_batch(batches, ByCorrelation{}, 2, [](const Moments<>& m) { return fit_pls(m); });

  for (std::size_t b = 0; b < campaign.size(); ++b) {
    const LinearModel<>& model = step.models[b].fit.model;
    std::printf("%s: Z = %.3f", campaign[b].name.c_str(), model.intercept(0));
    for (Index i = 0; i < model.sensors(); ++i)
      std::printf(" + %.3f %s", model.coefficients(i, 0),
                  campaign[b]
                      .temperatures.names[static_cast<std::size_t>(step.models[b].points[static_cast<std::size_t>(i)])]
                      .c_str());
    std::printf("\n");
  }
  const MeanAndStd<> robust = step.robustness[0].per_model;
  std::printf("on batches a model was not made from: S_mean %.2f um, S_std %.2f um\n", robust.S_mean, robust.S_std);
} catch (const thermfit::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
