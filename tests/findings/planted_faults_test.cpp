// Faults of every kind, planted one at a time at random places of campaigns: what `check` finds of them, and what it
// takes for a fault beside them. The table goes to the output.
#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>
#include <random>
#include <set>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "support/vcenter55.hpp"
#include "thermfit/findings/campaign_findings.hpp"
#include "thermfit/io/csv/reader.hpp"

using namespace thermfit;

namespace {

/// Where something is planted, and at which size.
struct Place {
  std::size_t batch, other_batch;
  Index channel, other, row;
  double size;
};

struct Kind {
  std::string name;
  std::function<std::set<std::string>(Campaign&, const Place&, std::mt19937&)> plant;  ///< channels that are faulty
  bool elsewhere = false;                                                              ///< whether other_batch is too
};

auto column(Campaign& campaign, const Place& at) { return campaign[at.batch].temperatures.values.col(at.channel); }

std::set<std::string> own(const Campaign& campaign, const Place& at) {
  return {campaign[at.batch].temperatures.names[static_cast<std::size_t>(at.channel)]};
}

/// A fault of one temperature that `change` makes of its readings.
Kind of_readings(const std::string& name, std::function<void(Eigen::Ref<Vector>, const Place&, std::mt19937&)> change) {
  return {name, [change](Campaign& campaign, const Place& at, std::mt19937& random) {
            change(column(campaign, at), at, random);
            return own(campaign, at);
          }};
}

const std::vector<Kind> kinds{
    of_readings("one reading", [](auto x, const Place& at, auto&) { x(at.row) += at.size; }),
    of_readings("two in a row", [](auto x, const Place& at, auto&) { x.segment(at.row, 2).array() += at.size; }),
    of_readings("a burst of four",
                [](auto x, const Place& at, auto& random) {
                  for (Index i = 0; i < 4; ++i)
                    x(at.row + i) += at.size * (1 + double(random() % 8)) * (i % 2 ? -1 : 1);
                }),
    of_readings("every second of twenty",
                [](auto x, const Place& at, auto&) {
                  for (Index i = 0; i < 20; i += 2) x(at.row + i) += at.size;
                }),
    of_readings("the first three", [](auto x, const Place& at, auto&) { x.head(3).array() -= 3 * at.size; }),
    of_readings("the last one", [](auto x, const Place& at, auto&) { x.tail(1).array() -= 3 * at.size; }),
    of_readings("-127", [](auto x, const Place& at, auto&) { x(at.row) = -127; }),
    of_readings("a jump that stays",
                [](auto x, const Place& at, auto&) { x.tail(x.size() - at.row).array() += at.size; }),
    of_readings("30 K over four rows that stay",
                [](auto x, const Place& at, auto&) {
                  for (Index i = at.row; i < x.size(); ++i) x(i) += 7.5 * double(std::min<Index>(4, i - at.row + 1));
                }),
    of_readings("a drift", [](auto x, const Place& at, auto&) { x += Vector::LinSpaced(x.size(), 0, at.size); }),
    of_readings("half the movement",
                [](auto x, const Place&, auto&) { x = (x(0) + 0.5 * (x.array() - x(0))).matrix().eval(); }),
    of_readings("no response",
                [](auto x, const Place&, auto& random) {
                  const double start = x(0);
                  for (Index i = 0; i < x.size(); ++i) x(i) = start + 0.1 * double(random() % 2);
                }),
    of_readings("stuck from there on",
                [](auto x, const Place& at, auto&) { x.tail(x.size() - at.row).setConstant(x(at.row)); }),
    of_readings("degrees Fahrenheit", [](auto x, const Place&, auto&) { x = (1.8 * x.array() + 32).matrix().eval(); }),
    {"two sensors swapped",
     [](Campaign& campaign, const Place& at, auto&) {
       auto& values = campaign[at.batch].temperatures.values;
       values.col(at.channel).swap(values.col(at.other));
       return std::set<std::string>{campaign[0].temperatures.names[std::size_t(at.channel)],
                                    campaign[0].temperatures.names[std::size_t(at.other)]};
     }},
    {"swapped between batches",
     [](Campaign& campaign, const Place& at, auto&) {
       Matrix &a = campaign[at.batch].temperatures.values, &b = campaign[at.other_batch].temperatures.values;
       const Index rows = std::min(a.rows(), b.rows());
       a.col(at.channel).head(rows).swap(b.col(at.channel).head(rows));
       return own(campaign, at);
     },
     true},
    {"rows missing",
     [](Campaign& campaign, const Place& at, auto&) {
       Batch& batch = campaign[at.batch];
       const Index kept = batch.rows() - at.row - 1;
       for (Matrix* values : {&batch.temperatures.values, &batch.errors.values}) {
         values->middleRows(at.row, kept) = values->bottomRows(kept).eval();
         values->conservativeResize(at.row + kept, values->cols());
       }
       batch.time_s.segment(at.row, kept) = batch.time_s.tail(kept).eval();
       batch.time_s.conservativeResize(at.row + kept);
       return std::set<std::string>{"time"};
     }},
    {"the clock set back",
     [](Campaign& campaign, const Place& at, auto&) {
       auto& time = campaign[at.batch].time_s;
       time.tail(time.size() - at.row).array() -= 2 * (time(1) - time(0));
       return std::set<std::string>{"time"};
     }},
    {"another time step",
     [](Campaign& campaign, const Place& at, auto&) {
       campaign[at.batch].time_s *= 2;
       return std::set<std::string>{"time"};
     }},
    {"an error of opposite sign",
     [](Campaign& campaign, const Place& at, auto&) {
       campaign[at.batch].errors.values *= -1;
       return std::set<std::string>{campaign[0].errors.names[0]};
     }},
};

using Told = std::set<std::pair<std::size_t, std::string>>;

Told told(const Campaign& campaign) {
  Told result;
  const CampaignFindings findings = find_faults(campaign);
  for (std::size_t b = 0; b < findings.size(); ++b)
    for (const Finding& one : findings[b]) result.emplace(b, one.channel);
  return result;
}

struct Score {
  int planted = 0, found = 0, false_findings = 0;
};

/// Plants each kind `times` times.
std::vector<Score> scores(const std::string& title, const Campaign& sound, double size, int times) {
  std::mt19937 random(7);
  const Told before = told(sound);
  std::vector<Score> result;
  std::cout << title << ": " << before.size() << " channels of batches have findings as they are\n";
  for (const Kind& kind : kinds) {
    Score score;
    for (int i = 0; i < times; ++i) {
      Campaign campaign = sound;
      Place at{random() % sound.size(), 0, 0, 0, 0, size};
      at.other_batch = (at.batch + 1 + random() % (sound.size() - 1)) % sound.size();
      const auto channels = static_cast<std::size_t>(sound[0].temperatures.count());
      at.channel = static_cast<Index>(random() % channels);
      at.other = static_cast<Index>((static_cast<std::size_t>(at.channel) + 1 + random() % (channels - 1)) % channels);
      const Index rows = sound[at.batch].rows();
      at.row = 8 + static_cast<Index>(random() % static_cast<std::size_t>(rows - 36));
      const std::set<std::string> faulty = kind.plant(campaign, at, random);
      const Told after = told(campaign);
      bool found = false;
      for (const auto& one : after) {
        const bool right = (one.first == at.batch || (kind.elsewhere && one.first == at.other_batch)) &&
                           (faulty.count(one.second) > 0);
        found = found || right;
        if (!right && before.count(one) == 0) ++score.false_findings;
      }
      ++score.planted;
      score.found += found;
    }
    std::cout << "  " << std::left << std::setw(32) << kind.name << std::right << std::setw(4) << score.planted
              << " planted" << std::setw(4) << score.found << " found" << std::setw(4) << score.false_findings
              << " false\n";
    result.push_back(score);
  }
  return result;
}

Campaign read(const std::string& folder, int count, const std::function<std::string(int)>& file,
              const std::vector<std::string>& temperatures, const std::vector<std::string>& errors) {
  std::vector<std::string> paths;
  for (int i = 1; i <= count; ++i) paths.push_back(folder + "/" + file(i));
  CsvOptions options;
  options.temperatures = temperatures;
  options.errors = errors;
  Campaign campaign = read_campaign(paths, options).batches;
  for (Batch& batch : campaign) {
    if (!batch.has_time()) batch.time_s = Vector::LinSpaced(batch.rows(), 0, 60. * double(batch.rows() - 1));
    batch.inputs = {};
  }
  return campaign;
}

}  // namespace

TEST_CASE("faults planted in a simulated campaign are found, and little else", "[findings]") {
  const Campaign sound = vcenter55();
  const std::vector<Score> all = scores("vcenter55", sound, 3, 12);
  Score sum;
  for (const Score& one : all) {
    sum.planted += one.planted;
    sum.found += one.found;
    sum.false_findings += one.false_findings;
    CHECK(one.false_findings <= one.planted);
  }
  CHECK(told(sound).empty());
  CHECK(sum.found > 0.9 * sum.planted);
}

TEST_CASE("faults planted in campaigns that were measured are found, and little else", "[findings]") {
  REQUIRE_SHARED_DATA(data);
  const Campaign lathe =
      read(data + "/real/ace_lathe", 18, [](int i) { return (i < 10 ? "day0" : "day") + std::to_string(i) + ".csv"; },
           {"Ambient", "Ref*", "Spindle*", "Coolant*", "Transf*"}, {"Dia Disp"});
  const Campaign tool =
      read(data + "/real/gooddash", 5, [](int i) { return "run" + std::to_string(i) + ".csv"; }, {"dT*"}, {"err"});
  for (const auto& [title, sound] : {std::make_pair("a lathe", lathe), std::make_pair("a machine tool", tool)})
    for (const Score& one : scores(title, sound, 5, 12)) CHECK(one.false_findings <= one.planted);
}
