/// thermfit_transfer_benchmark: what the method transfer costs in a study of 43 batches x 700 rows x 24 points with two
/// errors, every batch left out and all chosen without it, as a ratio to the paper's whole comparison in the same run.
/// CPU seconds are those of all threads: on a shared machine they tell more than the clock.

#include <chrono>
#include <cstdio>
#include <ctime>

#include "support/transfer_campaign.hpp"
#include "thermfit/fit/train_transfer.hpp"
#include "thermfit/robustness/study.hpp"
#include "thermfit/robustness/transfer_left_out.hpp"

namespace {

using namespace thermfit;

struct Cost {
  double cpu_s, wall_s;
};

template <class Work>
Cost cost(const Work& work) {
  const std::clock_t cpu = std::clock();
  const auto wall = std::chrono::steady_clock::now();
  work();
  return {static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC,
          std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count()};
}

void print(const char* what, const Cost& one, const Cost& peer) {
  std::printf("%-44s %7.2f s of CPU %7.2f s of wall %7.2f of the paper's\n", what, one.cpu_s, one.wall_s,
              one.cpu_s / peer.cpu_s);
}

}  // namespace

int main() {
  Campaign campaign = TransferMachine{20, .1, .3, 0}.campaign(43, 700, 24);
  const Campaign other = TransferMachine{40, 0, .3, 0}.campaign(43, 700, 24);
  for (std::size_t b = 0; b < campaign.size(); ++b) {
    campaign[b].errors.names = {"X", "Z"};
    campaign[b].errors.values.conservativeResize(Eigen::NoChange, 2);
    campaign[b].errors.values.col(1) = other[b].errors.values.col(0);
  }
  TransferPlan plan;
  plan.error_reference = ErrorReference::start;
  TransferData<> data;
  MeanAndStd<> figure;
  const Cost paper = cost([&] { study(observe(campaign, TemperatureReference::rise, ErrorReference::start)); });
  const Cost seen = cost([&] { data = transfer_data(campaign, plan); });
  const Cost left_out = cost([&] { figure = transfer_left_out(data.batches, 2, data.options).figure(0); });
  const Cost one = cost([&] { fit_transfer(data.batches, 0, data.options); });
  print("the paper's comparison", paper, paper);
  print("transfer: batches once, every lag", seen, paper);
  print("transfer: every batch left out, two errors", left_out, paper);
  print("transfer: one fit of one error", one, paper);
  std::printf("%zu lags; S_mean %.2f um of the first error, noise .3\n", data.lags_min.size(), figure.S_mean);
}
