#include "export/reserved_words.hpp"

#include "support/catch.hpp"

using thermfit::cli::reserved_in;

TEST_CASE("A name that means something already is told with the languages") {
  CHECK(reserved_in("while") == "C, C++ and Structured Text");
  CHECK(reserved_in("namespace") == "C++ and Structured Text");
  CHECK(reserved_in("restrict") == "C");
  CHECK(reserved_in("std") == "C++");
  CHECK(reserved_in("thermfit") == "C++");
  CHECK(reserved_in("end_if") == "Structured Text");
  CHECK(reserved_in("lreal") == "Structured Text");
  CHECK(reserved_in("limit") == "Structured Text");
  CHECK(reserved_in("r_trig") == "Structured Text");
  CHECK(reserved_in("pid") == "HAL");
  CHECK(reserved_in("time") == "C, C++, Structured Text and HAL");
}

TEST_CASE("Structured Text and HAL ignore case, C and C++ do not") {
  CHECK(reserved_in("Var_Input") == "Structured Text");
  CHECK(reserved_in("Pid") == "HAL");
  CHECK(reserved_in("Restrict").empty());
  CHECK(reserved_in("Template").empty());
}

TEST_CASE("Every conversion from type to type is a word of Structured Text") {
  CHECK(reserved_in("real_to_int") == "Structured Text");
  CHECK(reserved_in("BCD_to_uint") == "Structured Text");
  CHECK(reserved_in("to_lreal") == "Structured Text");
  CHECK(reserved_in("trunc_int") == "Structured Text");
  CHECK(reserved_in("cold_to_warm").empty());
  CHECK(reserved_in("to_machine").empty());
}

TEST_CASE("Other names are free, also those that hold a reserved word") {
  for (const char* name : {"thermal", "thermal_while", "whiles", "spindle_z", "x", "_", ""})
    CHECK(reserved_in(name).empty());
}
