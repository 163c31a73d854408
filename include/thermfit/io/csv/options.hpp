#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace thermfit {

/// What to do with an empty cell, `NA`, `N/A`, `NaN` or `null` (any case) in a column that is used.
enum class MissingValues {
  error,  ///< say how many there are and where the first is
  drop,   ///< leave the row out; rises still count from the first row, and rows keep their numbers
  hold,   ///< repeat the last value of the column in its batch
  keep    ///< NaN in the batch: for tools that look for faults
};

/// How a clock is written where its cells leave that open.
enum class TimeFormat {
  from_file,    ///< what the cells say; it is an error when they do not
  day_first,    ///< 4/5/2026 is the 4th of May
  month_first,  ///< 4/5/2026 is the 5th of April
  unix_s,       ///< seconds since 1970
  unix_ms,      ///< milliseconds since 1970
  serial_days   ///< days, as spreadsheets count them
};

/// What a channel is between its samples, where channels have clocks of their own.
enum class BetweenSamples {
  linear,  ///< on the line from one to the next
  held     ///< the last one
};

/// What unit columns are in, whatever their titles say.
struct CsvUnit {
  std::string column;  ///< name or title, or a glob that finds columns in a unit of this kind only
  std::string unit;    ///< of time, temperature or length; -um: the column holds corrections, not errors
  bool otherwise =
      false;  ///< only where the file names no unit for it, if it has such a column; the sign counts always
};

/// How to read a CSV file. The defaults read what formats.md describes; each member overrides one guess.
/// A name may be a glob of `*` and `?`; a name that is spelled exactly as a column wins over the glob.
struct CsvOptions {
  std::string dialect;               ///< of named_dialects; empty: one that is told unmistakably; "none": none
  char separator = 0;                ///< `,` `;` tab, `|`, or a blank for any number of them; 0: from the file
  char decimal_mark = 0;             ///< `.` or `,`; 0: from the file
  char thousands = 0;                ///< what groups them: `.` `,` `'` or a blank; 0: from the file
  std::string encoding;              ///< as iconv calls it; empty: UTF-8, or UTF-16 where a mark says so
  std::vector<std::string> columns;  ///< names, in place of those of a header line if there is one
  std::size_t header_line = 0;       ///< of the names, from 1; 0: the first, or the one above the rows
  std::string
      names_begin;  ///< the names stand in the last line above the rows that begins so, what is between is left out
  std::string units_begin;  ///< units stand in the last line above the names that begins so, column by column
  std::vector<std::string> skip_columns;   ///< names or globs of columns that are not read
  std::vector<std::string> missing_marks;  ///< cells without a reading, besides those that instruments write
  std::string time_column;                 ///< empty: by name or content; "none": no time; a name that several columns
                                           ///< have, or a glob: each is the clock of the columns right of it
  TimeFormat time_format = TimeFormat::from_file;   ///< of the clock
  BetweenSamples between = BetweenSamples::linear;  ///< where channels have clocks of their own
  double time_step_s = 0;                           ///< rows are so far apart, whatever a clock says; 0: a clock tells
  std::string time_unit;                            ///< for a time column that does not name its unit; empty: min
  std::vector<std::string> temperatures;            ///< empty: `T` and digits
  std::vector<std::string> errors;                  ///< empty: those of `X`, `Y`, `Z` that there are
  bool errors_may_lack = false;                     ///< of `errors`, only those that a file has are read, and a cell
                                                    ///< without a value is NaN, whatever `missing` says
  std::optional<std::vector<std::string>> inputs;   ///< absent: every other column of numbers
  std::vector<CsvUnit> units;                       ///< win over the titles, which is told
  bool inputs_may_lack = false;         ///< a cell of an input without a value is NaN, whatever `missing` says
  std::vector<std::string> long_table;  ///< columns of names and of values, a line for each value; empty: where their
                                        ///< titles say so; {"none"}: never
  std::string batch_column;             ///< splits a file into batches by its value; empty: one batch
  std::vector<std::string> join;        ///< globs: the files that one of them names are parts of one batch
  MissingValues missing = MissingValues::error;  ///< what to do with a cell that has no value
  bool increasing_time = true;                   ///< false: time that repeats or goes back is left to the caller
  bool newest_first = false;                     ///< time may decrease instead; for who holds all rows of a batch
  bool plain = false;           ///< every column of numbers is an input, whatever its name: for read_table
  std::size_t max_errors = 20;  ///< problems told of in one pass
  std::size_t max_line_bytes = std::size_t{1} << 20;  ///< limits against files that are not what they seem
  std::size_t max_columns = 16384;                    ///< a header with more is an error
};

}  // namespace thermfit
