#include "cli/command.hpp"
#include "options/field_flags.hpp"

int main(int count, char** words) { return thermfit::cli::run({words + 1, words + count}, thermfit::cli::with_flags); }
