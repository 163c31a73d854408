#pragma once

/// Plain text that reads well at 80 columns.

#include <string>
#include <string_view>
#include <vector>

namespace thermfit::cli {

/// Rows of cells, printed in aligned columns. The first column is flush left, the others flush right unless told.
class Table {
 public:
  explicit Table(std::vector<std::string> header);
  void add(std::vector<std::string> row);
  void rule() { rules_.push_back(rows_.size()); }             ///< a line between the rows before and after
  void left(std::size_t column) { left_.push_back(column); }  ///< sets a column flush left
  /// The table with `indent` blanks before each line. Where it is wider than `width`, the columns after the first are
  /// folded into several tables below each other, each with the first column repeated.
  std::string text(std::size_t indent = 0, std::size_t width = 80) const;

 private:
  std::vector<std::vector<std::string>> rows_;
  std::vector<std::size_t> rules_, left_;
};

/// `value` with `decimals` digits after the point, or "-" where it is not known.
std::string known_text(double value, int decimals);

/// Columns `text` takes on a terminal: UTF-8 sequences count one, ANSI colours none.
std::size_t display_width(std::string_view text);

/// Folds paragraphs at `width`; continuation lines start with `hanging` blanks. Lines that begin with two or more
/// blanks in a multi-line text are kept as they are. Ends with a newline.
std::string wrap(std::string_view text, std::size_t width, std::size_t hanging);

}  // namespace thermfit::cli
