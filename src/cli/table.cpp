#include "cli/table.hpp"

#include <algorithm>
#include <cmath>

#include "thermfit/number.hpp"

namespace thermfit::cli {

std::string known_text(double value, int decimals) { return std::isnan(value) ? "-" : fixed_text(value, decimals); }

std::size_t display_width(std::string_view text) {
  std::size_t width = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\033') {
      while (i < text.size() && text[i] != 'm') ++i;
      continue;
    }
    if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) ++width;
  }
  return width;
}

Table::Table(std::vector<std::string> header) : rows_{std::move(header)}, rules_{1}, left_{0} {}

void Table::add(std::vector<std::string> row) {
  row.resize(rows_.front().size());
  rows_.push_back(std::move(row));
}

std::string Table::text(std::size_t indent, std::size_t width) const {
  const std::size_t columns = rows_.front().size();
  std::vector<std::size_t> widths(columns, 0);
  for (const auto& row : rows_)
    for (std::size_t c = 0; c < columns; ++c) widths[c] = std::max(widths[c], display_width(row[c]));

  std::string text;
  for (std::size_t first = 1, last = 1; first < std::max<std::size_t>(columns, 2); first = last) {
    std::size_t total = indent + widths[0];
    for (last = first; last < columns && (last == first || total + 2 + widths[last] <= width); ++last)
      total += 2 + widths[last];
    if (columns == 1) last = 2;
    if (first > 1) text += '\n';
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      if (std::find(rules_.begin(), rules_.end(), r) != rules_.end() && r > 0)
        text += std::string(indent, ' ') + std::string(total - indent, '-') + '\n';
      std::string line(indent, ' ');
      const auto cell = [&](std::size_t c) {
        const std::string& value = rows_[r][c];
        const std::string pad(widths[c] - display_width(value), ' ');
        const bool flush_left = std::find(left_.begin(), left_.end(), c) != left_.end();
        line += flush_left ? value + pad : pad + value;
      };
      cell(0);
      for (std::size_t c = first; c < std::min(last, columns); ++c) {
        line += "  ";
        cell(c);
      }
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + '\n';
    }
  }
  return text;
}

std::string wrap(std::string_view text, std::size_t width, std::size_t hanging) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view paragraph = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t blanks = std::min(paragraph.find_first_not_of(' '), paragraph.size());
    if (blanks >= 2 && hanging == 0) {
      result.append(paragraph).append("\n");
      continue;
    }
    std::string line(paragraph.substr(0, blanks));
    bool fresh = true;
    paragraph.remove_prefix(blanks);
    while (!paragraph.empty()) {
      const std::size_t space = std::min(paragraph.find(' '), paragraph.size());
      const std::string_view word = paragraph.substr(0, space);
      if (!fresh && display_width(line) + 1 + display_width(word) > width) {
        result += line + '\n';
        line.assign(hanging, ' ');
        fresh = true;
      }
      if (!fresh) line += ' ';
      line += word;
      fresh = false;
      paragraph.remove_prefix(std::min(space + 1, paragraph.size()));
    }
    result += line + '\n';
  }
  return result;
}

}  // namespace thermfit::cli
