#include "export/source_text.hpp"

#include <random>
#include <set>

#include "controller/example_model.hpp"
#include "support/catch.hpp"
#include "thermfit/error.hpp"

namespace {

using namespace thermfit;
using namespace thermfit::cli;

/// What IEC 61131-3, the strictest, calls an identifier: no underscore at an end, none beside another.
bool is_identifier(const std::string& text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (text.empty() || !letter(text[0]) || text.back() == '_') return false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (!letter(text[k]) && !(text[k] >= '0' && text[k] <= '9') && text[k] != '_') return false;
    if (text[k] == '_' && text[k - 1] == '_') return false;
  }
  return true;
}

void check_identifiers(const std::vector<std::string>& names) {
  std::set<std::string> different;
  for (const std::string& identifier : identifiers(names)) {
    CAPTURE(names, identifier);
    CHECK(is_identifier(identifier));
    CHECK(identifier.size() <= 24);
    different.insert(upper_case(identifier));
  }
  CHECK(different.size() == names.size());
}

ExportRequest request_for(const std::vector<std::string>& temperatures, const std::vector<std::string>& errors) {
  ExportRequest request;
  request.trained = example_model();
  request.trained.temperatures = temperatures;
  request.trained.errors = errors;
  request.unit = offset_unit("mm");
  return request;
}

}  // namespace

TEST_CASE("Names become identifiers that are all different, whatever is cut or replaced") {
  check_identifiers({"T1", "t1", "T-1", "T_1", "T 1", "T__1", "_T1_"});
  check_identifiers({"a_n2", "a", "A", "a!", "a_n3"});
  check_identifiers({"", "1", "P1", "°", "__", "P"});
  check_identifiers({"motor_bearing_front_1", "motor_bearing_front_2", "motor_bearing_front__", "motor_bearing_front"});
  check_identifiers({"abcdefghijklmnopqrs_t", "abcdefghijklmnopqrs", "abcdefghijklmnopqrs-"});
  check_identifiers(std::vector<std::string>(254, "the same name again and again"));
}

TEST_CASE("Random names become identifiers that are all different") {
  std::mt19937 random(1);
  const std::string letters = "aAbB1 _-.n2";
  for (int round = 0; round < 200; ++round) {
    std::vector<std::string> names(30);
    for (std::string& name : names)
      for (std::size_t k = random() % 26; k > 0; --k) name += letters[random() % letters.size()];
    check_identifiers(names);
  }
}

TEST_CASE("Structured Text tells beside each input which name it stands for") {
  const std::string text = export_st(request_for({"Motor ä", "Motor ö", "T3"}, {"X", "Z"}));
  CHECK(text.find("Temperature_Motor : LREAL := 0.0; (* degC, Motor ä *)") != std::string::npos);
  CHECK(text.find("Temperature_Motor_n2 : LREAL := 0.0; (* degC, Motor ö *)") != std::string::npos);
}

TEST_CASE("A Structured Text block cannot have the name of one of its variables") {
  ExportRequest request = request_for({"T1", "T2", "T3"}, {"X", "Z"});
  for (const char* name : {"state", "S1_Zero", "device", "offset1", "Enable", "temperature_T1"}) {
    request.name = name;
    CHECK_THROWS_AS(export_st(request), Error);
  }
  request.name = "thermal2";
  CHECK_NOTHROW(export_st(request));
}

TEST_CASE("HAL pins with names longer than HAL takes are refused by name") {
  const std::string longest = "bearing of the motor, front left";
  ExportRequest request = request_for({longest, longest + " 2", "T3"}, {"X", "Z"});
  CHECK_NOTHROW(export_linuxcnc(request));
  request.name = "thermal_compensation";
  CHECK_THROWS_WITH(export_linuxcnc(request),
                    "HAL pin thermal-compensation.temperature-bearing-of-the-motor: 53 characters, for '" + longest +
                        "'; allowed: 47; take a shorter --name, or rename the column and fit again");
}

TEST_CASE("HAL pins that two names of the model would share are refused by both names") {
  CHECK_THROWS_WITH(export_linuxcnc(request_for({"T1", "T2", "T3"}, {"X", "x counts"})),
                    "HAL pin thermal.offset-x-counts: for 'X' and for 'x counts'; allowed: one name a pin; rename a "
                    "column and fit again");
}
