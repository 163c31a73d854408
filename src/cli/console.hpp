#pragma once

/// Where commands speak: results to stdout (or the file of -o), remarks to stderr, never a lost write.

#include <cstdint>
#include <string>
#include <string_view>

namespace thermfit::cli {

class Console {
 public:
  /// Puts a remark into the words of the program that prints it.
  using Wording = std::string (*)(std::string_view);

  explicit Console(Wording wording = nullptr) : wording_(wording) {}

  /// Adds to the result. Nothing is written before finish(), unless streaming.
  void print(std::string_view text) { result_ += text; }
  void line(std::string_view text = {}) {
    result_ += text;
    result_ += '\n';
  }

  /// A remark on stderr, `thermfit: text` in the console's wording, at once.
  void note(std::string_view text) const;

  /// A transient progress line on stderr, only where stderr is a terminal; an empty text clears it.
  void progress(std::string_view text) const;

  /// Bold or coloured text where stdout is a terminal and NO_COLOR is unset; plain elsewhere.
  std::string strong(std::string_view text) const;

  /// Sends the result to `path` instead of stdout: a temporary file beside it, then a rename.
  void write_to(std::string path) { path_ = std::move(path); }

  /// Writes what has been printed so far to stdout now (for `run`, line by line); false when the reader has closed the
  /// pipe. Throws Error on a failed write.
  bool flush();

  /// Writes the result. Throws thermfit::Error when not every byte arrived; a pipe closed by its reader is no error.
  void finish();

 private:
  Wording wording_;
  std::string result_;
  std::string path_;
};

}  // namespace thermfit::cli
