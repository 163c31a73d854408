#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/files/byte_source.hpp"
#include "thermfit/io/files/transcoder.hpp"
#include "thermfit/io/problems.hpp"

namespace thermfit::detail {

inline std::string place(const std::string& name, std::size_t line, std::size_t column = 0) {
  std::string text = name + ':' + std::to_string(line);
  return column == 0 ? text : text + ':' + std::to_string(column);
}

/// Blank lines and comments (`#` first) carry no data.
inline bool is_content(std::string_view line) {
  for (const char c : line) {
    if (c == ' ' || c == '\t' || c == '\r') continue;
    return c != '#';
  }
  return false;
}

inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// The lines of a file, read in blocks: constant memory, whatever the size of the file. Refuses at once what is no
/// text: other encodings, workbooks, NUL bytes, lone carriage returns, endless lines.
class CsvLines {
 public:
  /// `encoding`: empty for UTF-8, and UTF-16 where a byte order mark says so.
  CsvLines(const std::string& path, std::size_t max_line_bytes, const std::string& encoding = {})
      : source_(path), max_line_bytes_(max_line_bytes), buffer_(block_bytes), encoding_(encoding) {
    while ((end_ < head_bytes || (!holds_two_content_lines() && end_ < 2 * max_line_bytes_)) && fill()) {
    }
    if (!at_end_ && text().find('\n') == std::string_view::npos) refuse_long(end_);
    if (text().substr(0, byte_order_mark.size()) == byte_order_mark) {
      begin_ = byte_order_mark.size();
      bom_ = true;
    }
    const std::string_view start = head();
    const std::size_t feed = start.find('\n');
    crlf_ = feed != std::string_view::npos && feed > 0 && start[feed - 1] == '\r';
    if (feed == std::string_view::npos && start.find('\r') < start.size() - 1)
      throw problem(place(name(), 1, start.find('\r') + 1), {"lines that end in a lone carriage return"},
                    {"line feed, or carriage return and line feed"}, {"convert: tr '\\r' '\\n' <FILE"});
  }

  /// Takes what has been read, and what follows, for text of `encoding`; before the first line is taken.
  void decode(const std::string& encoding) {
    encoding_ = encoding;
    const std::size_t size = end_ - begin_;
    end_ = begin_;
    end_ += transcode(size);
  }

  /// Puts `text` in the place of all that has not been taken; its first line is number 1.
  void replace(const std::string& text) {
    buffer_.assign(text.begin(), text.end());
    begin_ = line_number_ = 0;
    end_ = text.size();
    at_end_ = true;
  }

  const std::string& name() const { return source_.name(); }
  bool compressed() const { return source_.compressed(); }
  const std::string& encoding() const { return encoding_; }  ///< as told or found; empty: UTF-8
  bool has_bom() const { return bom_; }
  bool has_crlf() const { return crlf_; }
  std::size_t line_number() const { return line_number_; }  ///< of the line that next() gave last, from 1

  /// Whole lines of the first 64 kB that have not been taken yet: the evidence for dialect and kinds of columns.
  std::string_view head() const {
    const std::string_view all = text();
    if (all.size() < head_bytes) return all;
    const std::size_t last = all.rfind('\n', head_bytes);
    const std::string_view lines = all.substr(0, last + 1);
    if (last != std::string_view::npos && content_lines(lines) > 1) return lines;
    return at_end_ ? all : all.substr(0, all.rfind('\n') + 1);
  }

  /// The next line without its end; false behind the last. The view holds until the next call.
  bool next(std::string_view& line) {
    const char* feed = nullptr;
    for (std::size_t searched = 0;;) {
      const std::string_view rest = text();
      if (rest.size() > searched)
        feed = static_cast<const char*>(std::memchr(rest.data() + searched, '\n', rest.size() - searched));
      if (feed || at_end_) break;
      searched = rest.size();
      refuse_long(searched);
      fill();
    }
    const std::string_view rest = text();
    if (rest.empty()) return false;
    const std::size_t size = feed ? static_cast<std::size_t>(feed - rest.data()) : rest.size();
    refuse_long(size);
    begin_ += size + (feed ? 1 : 0);
    line = rest.substr(0, size);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++line_number_;
    return true;
  }

 private:
  static constexpr std::size_t block_bytes = std::size_t{1} << 18;
  static constexpr std::size_t head_bytes = std::size_t{1} << 16;

  void refuse_long(std::size_t size) const {
    if (size > max_line_bytes_)
      throw problem(place(name(), line_number_ + 1), {"a line longer than ", std::to_string(max_line_bytes_), " bytes"},
                    {"lines of a table"}, {"is this the right file?"});
  }

  static std::size_t content_lines(std::string_view lines) {
    std::size_t count = 0;
    for (std::size_t end; count < 2 && (end = lines.find('\n')) != std::string_view::npos; lines.remove_prefix(end + 1))
      count += is_content(lines.substr(0, end));
    return count;
  }

  bool holds_two_content_lines() const { return content_lines(text()) > 1; }

  std::string_view text() const { return {buffer_.data() + begin_, end_ - begin_}; }

  /// Reads one more block behind what is left. False at the end of the file.
  bool fill() {
    if (begin_ > 0) {
      std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
      end_ -= begin_;
      begin_ = 0;
    }
    if (end_ == buffer_.size()) buffer_.resize(2 * buffer_.size());
    std::size_t count = source_.read(buffer_.data() + end_, buffer_.size() - end_);
    at_end_ = count == 0;
    if (line_number_ == 0 && end_ == 0) {
      const std::string_view start(buffer_.data(), count);
      if (encoding_.empty() && (start.substr(0, 2) == "\xFF\xFE" || start.substr(0, 2) == "\xFE\xFF"))
        encoding_ = "UTF-16";
      refuse_foreign_content(start);
    }
    if (!encoding_.empty()) count = transcode(count);
    if (const void* nul = std::memchr(buffer_.data() + end_, '\0', count)) {
      const auto offset = static_cast<std::size_t>(static_cast<const char*>(nul) - buffer_.data());
      const std::string_view before(buffer_.data(), offset);
      const auto lines = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
      const std::size_t line_begin = lines == 0 ? 0 : before.rfind('\n') + 1;
      throw problem(place(name(), line_number_ + lines + 1, offset - line_begin + 1), {"a NUL byte"}, {"text in UTF-8"},
                    {"a logger that lost power may leave such bytes: cut them out; a binary file is not read"});
    }
    end_ += count;
    return !at_end_;
  }

  /// Puts UTF-8 in the place of `count` bytes behind the text; how many bytes that is.
  std::size_t transcode(std::size_t count) {
    if (!transcoder_) transcoder_ = std::make_unique<Transcoder>(encoding_, name());
    std::string text;
    transcoder_->append({buffer_.data() + end_, count}, text);
    if (end_ + text.size() > buffer_.size()) buffer_.resize(end_ + text.size());
    std::copy(text.begin(), text.end(), buffer_.begin() + static_cast<std::ptrdiff_t>(end_));
    return text.size();
  }

  void refuse_foreign_content(std::string_view start) const {
    if (start.substr(0, 4) == "PK\x03\x04")
      throw problem(name(), {"is an Excel workbook or a zip archive"}, {"text in UTF-8"}, {"save the sheet as CSV"});
    if (start.substr(0, 4) == "\xD0\xCF\x11\xE0")
      throw problem(name(), {"is an old Excel workbook"}, {"text in UTF-8"}, {"save the sheet as CSV"});
  }

  ByteSource source_;
  std::size_t max_line_bytes_;
  std::vector<char> buffer_;
  std::string encoding_;
  std::unique_ptr<Transcoder> transcoder_;
  std::size_t begin_ = 0, end_ = 0;
  std::size_t line_number_ = 0;
  bool at_end_ = false, bom_ = false, crlf_ = false;
};

}  // namespace thermfit::detail
