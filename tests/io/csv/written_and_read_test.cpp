// Generated campaigns, written in every clock, encoding, decimal mark and shape with separators, preambles, line ends
// and spellings drawn by lot, are read back equal.
#include <random>

#include "support/catch.hpp"
#include "support/read_text.hpp"

using namespace thermfit;

namespace {

/// What a campaign is written as.
struct Spelling {
  std::string clock, encoding, shape;
  char separator = ',', decimal = '.', thousands = 0;
  std::string line_end = "\n", preamble;
  bool units_in_cells = false, unit_row = false, quoted = false, names_given = false;
};

struct Truth {
  std::vector<double> time_s;
  std::vector<std::vector<double>> columns;  ///< T1, T2, Z, rpm
};

const std::vector<std::string> clocks{"s",   "min",     "iso",    "german",  "slashes", "american", "month",
                                      "day", "elapsed", "unix_s", "unix_ms", "serial",  "minutes",  "split"};
const std::vector<std::string> encodings{"utf-8", "mark", "utf-16", "latin1"};

Truth made(std::mt19937& chance, const Spelling& spelling) {
  const auto draw = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(chance); };
  Truth truth;
  const int rows = draw(6, 14), step_s = spelling.clock == "minutes" ? 20 : 30 * draw(1, 4);
  for (int row = 0; row < (spelling.clock == "minutes" ? 12 : rows); ++row) truth.time_s.push_back(step_s * row);
  truth.columns.resize(4);
  for (std::size_t row = 0; row < truth.time_s.size(); ++row) {
    truth.columns[0].push_back(0.001 * draw(18001, 31999));
    truth.columns[1].push_back(0.001 * draw(-9999, 31999));
    truth.columns[2].push_back(0.01 * draw(-9999, 9999));
    truth.columns[3].push_back(draw(0, 24000));
  }
  return truth;
}

std::string with_mark(std::string number, char decimal) {
  const std::size_t point = number.find('.');
  if (point != std::string::npos) number[point] = decimal;
  return number;
}

std::string stamp(const std::string& clock, double time_s, char decimal) {
  char text[64] = {};
  const int time = static_cast<int>(time_s), of_day = 10 * 3600 + 50 * 60 + time;
  const int hour = of_day / 3600, minute = of_day / 60 % 60, second = of_day % 60;
  const auto print = [&](const char* form, auto... values) { std::snprintf(text, sizeof text, form, values...); };
  if (clock == "s") print("%d", time);
  if (clock == "min") return with_mark(exact_text(time_s / 60), decimal);
  if (clock == "iso") print("2026-05-14T%02d:%02d:%02d+02:00", hour, minute, second);
  if (clock == "german") print("14.05.2026 %02d:%02d:%02d", hour, minute, second);
  if (clock == "slashes") print("2026/05/14 %02d:%02d:%02d", hour, minute, second);
  if (clock == "american")
    print("5/14/2026 %d:%02d:%02d %s", hour > 12 ? hour - 12 : hour, minute, second, hour < 12 ? "AM" : "PM");
  if (clock == "month") print("14-May-2026 %02d:%02d:%02d", hour, minute, second);
  if (clock == "day") print("%02d:%02d:%02d", (hour + 13) % 24, minute, second);
  if (clock == "elapsed") print("%d:%02d:%02d", hour + 15, minute, second);
  if (clock == "unix_s") print("%d", 1778750000 + time);
  if (clock == "unix_ms") print("%d000", 1778750000 + time);
  if (clock == "serial") return with_mark(fixed_text(46156.25 + time_s / 86400, 10), decimal);
  if (clock == "minutes") print("14.05.2026 %02d:%02d", hour, minute);
  if (clock == "split") print("%02d:%02d:%02d", hour, minute, second);
  return text;
}

std::string number(double value, int decimals, const Spelling& spelling) {
  std::string text = with_mark(fixed_text(value, decimals), spelling.decimal);
  if (spelling.thousands && value >= 1000) {
    const std::size_t digits = std::min(text.find(spelling.decimal), text.size());
    text.insert(digits - 3, spelling.thousands == ' ' ? "\xC2\xA0" : std::string(1, spelling.thousands));
  }
  return text;
}

std::string encoded(const std::string& text, const std::string& encoding) {
  if (encoding == "utf-8") return text;
  if (encoding == "mark") return "\xEF\xBB\xBF" + text;
  std::string bytes = encoding == "utf-16" ? "\xFF\xFE" : "";
  for (std::size_t i = 0; i < text.size(); ++i) {
    auto code = static_cast<unsigned char>(text[i]);
    if (code >= 0xC2) code = static_cast<unsigned char>((code & 3) << 6 | (text[++i] & 0x3F));  // up to U+00FF
    bytes += static_cast<char>(code);
    if (encoding == "utf-16") bytes += '\0';
  }
  return bytes;
}

std::string written(const Truth& truth, const Spelling& spelling) {
  const std::vector<std::string> units{"°C", "°C", "µm", "rpm"}, names{"T1", "T2", "Z", "n"};
  const bool in_names = !spelling.unit_row && !spelling.units_in_cells;
  const std::string clock_unit = spelling.clock == "s" || spelling.clock == "min" ? spelling.clock : "";
  const auto name = [&](std::size_t c) { return names[c] + (in_names ? " [" + units[c] + "]" : ""); };
  const std::string clock_name = "Time" + (clock_unit.empty() || !in_names ? "" : " [" + clock_unit + "]");
  std::string text = spelling.preamble;
  const auto line = [&](const std::vector<std::string>& fields) {
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (f > 0) text += spelling.separator;
      const bool quotes = spelling.quoted || fields[f].find(spelling.separator) != std::string::npos;
      text += quotes ? '"' + fields[f] + '"' : fields[f];
    }
    text += spelling.line_end;
  };
  const auto cell = [&](std::size_t c, std::size_t row) {
    return number(truth.columns[c][row],
                  c < 2    ? 3
                  : c == 2 ? 2
                           : 0,
                  spelling) +
           (spelling.units_in_cells ? " " + units[c] : "");
  };
  const auto time = [&](std::size_t row) {
    return stamp(spelling.clock, truth.time_s[row], spelling.decimal) +
           (spelling.units_in_cells && !clock_unit.empty() ? " " + clock_unit : "");
  };
  const std::size_t rows = truth.time_s.size();
  if (spelling.shape == "long") {
    line({clock_name, "variable", "value"});
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t c = 0; c < 4; ++c) line({time(row), name(c), cell(c, row)});
    return encoded(text, spelling.encoding);
  }
  const bool pairs = spelling.shape == "pairs", split = spelling.clock == "split";
  std::vector<std::string> header, below;
  for (std::size_t c = 0; c < 4; ++c) {
    if (pairs || c == 0) {
      if (split) header.emplace_back("Date"), below.emplace_back("-");
      header.push_back(clock_name), below.push_back(clock_unit.empty() ? "-" : clock_unit);
    }
    header.push_back(name(c)), below.push_back(units[c]);
  }
  line(header);
  if (spelling.unit_row) line(below);
  for (std::size_t row = 0; row < rows; ++row) {
    std::vector<std::string> fields;
    for (std::size_t c = 0; c < 4; ++c) {
      if ((pairs || c == 0) && split) fields.emplace_back("14.05.2026");
      if (pairs || c == 0) fields.push_back(time(row));
      fields.push_back(cell(c, row));
    }
    line(fields);
  }
  return encoded(text, spelling.encoding);
}

void check_read_back(std::mt19937& chance, Spelling spelling) {
  const auto draw = [&](std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(chance); };
  spelling.separator = std::vector<char>{',', ';', '\t'}[spelling.decimal == ',' ? 1 + draw(2) : draw(3)];
  spelling.line_end = std::vector<std::string>{"\n", "\r\n", "\r\r\n"}[draw(3)];
  spelling.preamble = std::vector<std::string>{"", "Warm-up of machine 7\n", "Operator: lab\nDate: 14.05.2026\n\n",
                                               std::string("sep=") + spelling.separator + "\n"}[draw(4)];
  spelling.units_in_cells = draw(4) == 0;
  spelling.unit_row = !spelling.units_in_cells && spelling.shape == "wide" && draw(3) == 0;
  spelling.quoted = draw(4) == 0;
  if (draw(3) == 0) spelling.thousands = std::vector<char>{' ', '\'', spelling.decimal == ',' ? '.' : ','}[draw(3)];
  const Truth truth = made(chance, spelling);
  CsvOptions options;
  if (spelling.encoding == "latin1") options.encoding = "latin1";
  if (spelling.thousands == '.' || spelling.thousands == ',') options.thousands = spelling.thousands;
  options.decimal_mark = spelling.decimal;
  if (spelling.separator == '\t' || options.thousands) options.decimal_mark = options.thousands ? 0 : spelling.decimal;
  const std::string text = written(truth, spelling);
  INFO(spelling.clock << ' ' << spelling.encoding << ' ' << spelling.shape << " thousands " << int(spelling.thousands));
  INFO(text);
  const Batch batch = read_text(text, options).batches.front();
  REQUIRE(batch.rows() == static_cast<Index>(truth.time_s.size()));
  REQUIRE(batch.temperatures.names == std::vector<std::string>{"T1", "T2"});
  REQUIRE(batch.inputs.names == std::vector<std::string>{"n"});
  for (Index row = 0; row < batch.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    CHECK(batch.time_s(row) == Approx(truth.time_s[r]).margin(2e-5));
    CHECK(std::abs(batch.temperatures.values(row, 0) - truth.columns[0][r]) < 1e-9);
    CHECK(std::abs(batch.temperatures.values(row, 1) - truth.columns[1][r]) < 1e-9);
    CHECK(std::abs(batch.errors.values(row, 0) - truth.columns[2][r]) < 1e-9);
    CHECK(batch.inputs.values(row, 0) == truth.columns[3][r]);
  }
}

}  // namespace

TEST_CASE("what is written in any clock, encoding, decimal mark and shape is read back", "[io]") {
  std::mt19937 chance(20260514);
  for (const std::string& clock : clocks)
    for (const std::string& encoding : encodings)
      for (const char decimal : {'.', ','})
        for (const std::string shape : {"wide", "pairs", "long"}) {
          const bool needs_one_clock = clock == "minutes" || clock == "split" || clock == "day";
          if (shape != "wide" && needs_one_clock) continue;
          Spelling spelling;
          spelling.clock = clock;
          spelling.encoding = encoding;
          spelling.shape = shape;
          spelling.decimal = decimal;
          check_read_back(chance, spelling);
        }
}
