#include "src/app/command_line.h"

#include <cctype>
#include <fstream>
#include <iterator>
#include <string_view>

namespace dapple {

namespace {

/// In single quotes where a shell would see more in it than one word.
std::string Quoted(const std::string& word) {
  constexpr std::string_view kPlain = "-_./,:=+@%";
  bool isPlain = !word.empty();
  for (const char c : word)
    isPlain = isPlain && (std::isalnum(static_cast<unsigned char>(c)) || kPlain.find(c) != std::string_view::npos);
  if (isPlain) return word;
  std::string quoted = "'";
  for (const char c : word) {
    if (c == '\'') quoted += "'\\'";
    quoted += c;
  }
  quoted += '\'';
  return quoted;
}

}  // namespace

std::string CommandLine() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string line, word;
  for (const char c : std::string(std::istreambuf_iterator<char>(file), {})) {
    if (c != '\0') {
      word += c;
      continue;
    }
    // The program by its name alone: where it lies is of no use to others.
    if (line.empty()) {
      line = word.substr(word.rfind('/') + 1);
    } else {
      line += ' ';
      line += Quoted(word);
    }
    word.clear();
  }
  return line;
}

}  // namespace dapple
