#include "cli/command.hpp"

int main(int count, char** words) { return thermfit::cli::run({words + 1, words + count}); }
