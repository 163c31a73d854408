#include "thermfit/io/csv/title.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

CsvColumn column(const std::string& title) { return detail::column_of({title, 1, false}); }

}  // namespace

TEST_CASE("a unit is found behind a name in every usual spelling, and the title stays as it was", "[io]") {
  struct Case {
    const char *title, *name, *unit;
  };
  for (const Case& one : std::vector<Case>{{"Z [mm]", "Z", "mm"},
                                           {"Z (mm)", "Z", "mm"},
                                           {"Z_mm", "Z", "mm"},
                                           {"Z mm", "Z", "mm"},
                                           {"Z/mm", "Z", "mm"},
                                           {"Z / mm", "Z", "mm"},
                                           {"Z, mm", "Z", "mm"},
                                           {"Z in mm", "Z", "mm"},
                                           {"Z..mm.", "Z", "mm"},
                                           {"Z [0.1um]", "Z", "0.1um"},
                                           {"T1/°C", "T1", "°C"},
                                           {"T1 (Deg. C)", "T1", "Deg. C"},
                                           {"T1 Deg. C", "T1", "Deg. C"},
                                           {"T1_degF", "T1", "degF"},
                                           {"T1 in ºC", "T1", "ºC"},
                                           {"t / s", "t", "s"},
                                           {"Zeit in s", "Zeit", "s"},
                                           {"Elapsed Time (s)", "Elapsed Time", "s"},
                                           {"Dia Disp [µm]", "Dia Disp", "µm"},
                                           {"Bed, left, °C", "Bed, left", "°C"}}) {
    INFO(one.title);
    CHECK(column(one.title).title == one.title);
    CHECK(column(one.title).name == one.name);
    CHECK(column(one.title).unit == one.unit);
    CHECK(column(one.title).is_called(one.title));
    CHECK(column(one.title).is_called(one.name));
  }
}

TEST_CASE("what only looks like a unit stays in the name", "[io]") {
  for (const char* title : {"T_in", "T_C", "air in", "Motor F", "time_s", "feed mm/min", "feed_mm_min", "Pump, left",
                            "A/B", "spindle_rpm", "mm", "_mm", "Z (front)", "T1", "/mm", "Z_Nm"}) {
    INFO(title);
    CHECK(column(title).name == title);
    CHECK(column(title).unit.empty());
  }
}

TEST_CASE("blanks around a title are cut, also those that are no blanks to the eye or to ASCII", "[io]") {
  for (const char* title : {" T1", "T1\t", "T1\xC2\xA0", "\xE2\x80\x8BT1 \xE2\x80\xAF", "T1\r", "\xEF\xBB\xBFT1"})
    CHECK(column(title).name == "T1");
  CHECK(column("\xC2\xA0").name.empty());
  CHECK(column("Größe").name == "Größe");
  CHECK(detail::visible_name("T\xC2\xA0"
                             "1") == "'T\\xc2\\xa01'");
  CHECK(detail::visible_name("Bed left") == "Bed left");
}

TEST_CASE("two titles that differ by their units keep them in their names", "[io]") {
  std::vector<CsvColumn> columns{column("Z_mm"), column("Z_um"), column("T1_degC"), column("T1"), column("T2_degC")};
  detail::keep_names_apart(columns);
  CHECK(columns[0].name == "Z_mm");
  CHECK(columns[1].name == "Z_um");
  CHECK(columns[2].name == "T1_degC");
  CHECK(columns[2].unit == "degC");
  CHECK(columns[4].name == "T2");
}
