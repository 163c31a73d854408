#include "cli/labels.hpp"

#include <set>

#include "cli/table.hpp"
#include "support/catch.hpp"

using thermfit::cli::display_width;
using thermfit::cli::label_width;
using thermfit::cli::Labels;
using Names = std::vector<std::string>;

TEST_CASE("short names are their own labels", "[cli]") {
  const Labels labels({"K01", "K02"}, 'b', 8);
  CHECK(labels.all() == Names{"K01", "K02"});
  CHECK(labels.legend().empty());
}

TEST_CASE("words that all names begin and end with are cut, and told", "[cli]") {
  const Labels labels({"2021-03 warm-up lathe run 07 north", "2021-03 warm-up lathe run 12 north"}, 'b', 8);
  CHECK(labels.all() == Names{"run 07", "run 12"});
  CHECK(labels.legend() == "Names are shown without '2021-03 warm-up lathe ' before them and ' north' behind them.\n");
  const Labels digits({"spindle_front_T1", "spindle_front_T12"}, 'p', 8);
  CHECK(digits.all() == Names{"T1", "T12"});
}

TEST_CASE("names that stay long are numbered, and the legend gives each its name", "[cli]") {
  Names names;
  for (int i = 1; i <= 12; ++i)
    names.push_back("a batch whose name says much: " + std::string(static_cast<std::size_t>(i), 'x'));
  names.push_back("b01");
  const Labels labels(names, 'b', 10);
  CHECK(labels[0] == "bb01");
  for (std::size_t i = 0; i < names.size(); ++i)
    CHECK(labels.legend().find(labels[i] + "  " + names[i]) != std::string::npos);
}

TEST_CASE("labels differ where names do, and are as narrow as asked", "[cli]") {
  for (const std::size_t count : {std::size_t{2}, std::size_t{24}, std::size_t{43}}) {
    Names names;
    for (std::size_t i = 0; i < count; ++i)
      names.push_back("2021-0" + std::to_string(i % 9 + 1) + "-11_machine " + std::to_string(i) + "_warm-up ä");
    const std::size_t widest = label_width(count);
    const Labels labels(names, 'b', widest);
    CHECK(std::set<std::string>(labels.all().begin(), labels.all().end()).size() == count);
    for (const std::string& label : labels.all()) {
      CHECK_FALSE(label.empty());
      CHECK(display_width(label) <= widest);
    }
  }
}
