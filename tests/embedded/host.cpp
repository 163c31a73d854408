#include <cstdio>

void write_text(const char* text) { std::fputs(text, stdout); }
