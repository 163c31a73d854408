#pragma once

/// Long names of batches and sensors, as tables can bear them.

#include <string>
#include <vector>

namespace thermfit::cli {

/// One label a name, in their order, at most `widest` columns each: the names themselves where they are short enough;
/// else the names without the words that all begin and end with; else `letter` and a number. What was done is told by
/// legend(), which belongs above the first table.
class Labels {
 public:
  Labels(std::vector<std::string> names, char letter, std::size_t widest);

  const std::string& operator[](std::size_t i) const { return labels_[i]; }
  const std::vector<std::string>& all() const { return labels_; }

  /// Which label stands for which name, in lines of 80 columns where names allow; empty when labels are names.
  std::string legend() const;

 private:
  void cut_common_words();
  void number(char letter);

  std::vector<std::string> names_, labels_;
  std::string before_, behind_;  ///< what was cut
  bool numbered_ = false;
};

/// What labels of batches and of temperature points stand for, under a heading each with an empty line
/// before it; empty when they are the names.
std::string legends(const Labels& batches, const Labels& points);

/// How wide a label may be where `count` of them head the columns of a table, so that it needs few blocks.
std::size_t label_width(std::size_t count);

}  // namespace thermfit::cli
