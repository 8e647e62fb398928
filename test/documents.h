// Documents as text for tests: the tables and examples of a Markdown file.
#pragma once

#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace robot_tissue {

inline std::string documentText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline std::vector<std::string> documentLines(const std::string& path) {
  std::vector<std::string> lines;
  std::istringstream text(documentText(path));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

// What stands between backquotes, in their order.
inline std::vector<std::string> quotedWords(const std::string& line) {
  std::vector<std::string> words;
  for (std::size_t begin = line.find('`'); begin != std::string::npos;) {
    const std::size_t end = line.find('`', begin + 1);
    if (end == std::string::npos) break;
    words.push_back(line.substr(begin + 1, end - begin - 1));
    begin = line.find('`', end + 1);
  }
  return words;
}

// "| a | b |" -> "a".
inline std::string firstCell(const std::string& row) {
  const std::size_t end = row.find('|', 1);
  const std::string cell = row.substr(1, end == std::string::npos ? end : end - 1);
  const std::size_t first = cell.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  return cell.substr(first, cell.find_last_not_of(' ') - first + 1);
}

// The quoted words in the first cells of all tables whose first column is called `column`. A word
// comes behind each of `places`, the quoted words of the heading above its table.
struct DocumentedWord {
  std::vector<std::string> places;
  std::string word;
};

inline std::vector<DocumentedWord> documentedWords(const std::string& path,
                                                   const std::string& column) {
  std::vector<DocumentedWord> all;
  std::vector<std::string> places;
  bool in_table = false, is_asked_for = false;
  for (const std::string& line : documentLines(path)) {
    const bool is_row = !line.empty() && line.front() == '|';
    if (is_row && !in_table) is_asked_for = firstCell(line) == column;
    if (is_row && in_table && is_asked_for) {
      for (const std::string& word : quotedWords(firstCell(line))) all.push_back({places, word});
    }
    in_table = is_row;
    if (line.rfind("#", 0) == 0) places = quotedWords(line);
  }
  return all;
}

// The blocks of code in a language.
inline std::vector<std::string> documentExamples(const std::string& path,
                                                 const std::string& language) {
  std::vector<std::string> examples;
  bool inside = false;
  for (const std::string& line : documentLines(path)) {
    if (inside && line == "```") {
      inside = false;
    } else if (inside) {
      examples.back() += line + '\n';
    } else if (line == "```" + language) {
      inside = true;
      examples.emplace_back();
    }
  }
  return examples;
}

}  // namespace robot_tissue
