#include "robot_tissue/scene/value_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <locale>
#include <sstream>

#include "tuning.h"

namespace robot_tissue {
namespace {

void append(const YAML::Node& node, std::string& text);

void appendSequence(const YAML::Node& node, std::string& text) {
  text += '[';
  bool first = true;
  for (const auto& item : node) {
    if (text.size() > tuning::kLongestValue) return;  // also ends a list that contains itself
    if (!first) text += ", ";
    first = false;
    append(item, text);
  }
  text += ']';
}

void appendMap(const YAML::Node& node, std::string& text) {
  text += '{';
  bool first = true;
  for (const auto& item : node) {
    if (text.size() > tuning::kLongestValue) return;
    if (!first) text += ", ";
    first = false;
    append(item.first, text);
    text += ": ";
    append(item.second, text);
  }
  text += '}';
}

void append(const YAML::Node& node, std::string& text) {
  if (!node.IsDefined() || node.IsNull()) {
    text += "(nothing)";
  } else if (node.IsScalar()) {
    const bool quoted = isText(node) || node.Scalar().empty();
    text += quoted ? '"' + node.Scalar() + '"' : node.Scalar();
  } else if (node.IsSequence()) {
    appendSequence(node, text);
  } else {
    appendMap(node, text);
  }
}

bool hasAmbiguousLeadingZero(const std::string& digits) {
  return digits.size() > 1 && digits.front() == '0' &&
         digits.find_first_not_of("0123456789") == std::string::npos;
}

// Bytes of the character that begins at `i`; 0 where it is no UTF-8 by RFC 3629: longer forms than
// needed, surrogates, what is beyond U+10FFFF, bytes that are missing.
std::size_t lengthOfCharacter(const std::string& text, std::size_t i) {
  const auto byte = [&](std::size_t k) {
    return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0U;
  };
  const unsigned first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) return 0;
  }
  const bool wrong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ||
                     (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F);
  return wrong ? 0 : length;
}

// Of a terminal (C0, DEL, C1), or one that ends a line or paragraph (U+2028, U+2029).
bool isControl(const std::string& character) {
  const auto first = static_cast<unsigned char>(character.front());
  if (character.size() == 1) return first < 0x20 || first == 0x7f;
  const auto second = static_cast<unsigned char>(character[1]);
  return (first == 0xC2 && second < 0xA0) || character == "\xE2\x80\xA8" ||
         character == "\xE2\x80\xA9";
}

}  // namespace

// yaml-cpp's tag of what stands in quotes, and YAML's own.
bool isText(const YAML::Node& scalar) {
  return scalar.Tag() == "!" || scalar.Tag() == "tag:yaml.org,2002:str";
}

std::string onOneLine(const std::string& text) {
  std::string line;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = lengthOfCharacter(text, i);
    const std::string character = text.substr(i, std::max<std::size_t>(length, 1));
    i += character.size();
    if (character == "\n") {
      line += "\\n";
    } else {
      line += length == 0 || isControl(character) ? "?" : character;
    }
  }
  return line;
}

bool isUtf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = lengthOfCharacter(text, i);
    if (length == 0) return false;
    i += length;
  }
  return true;
}

std::string shortText(const std::string& text) {
  std::string line = onOneLine(text);
  if (line.size() <= tuning::kLongestValue) return line;
  std::size_t end = tuning::kLongestValue;
  while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xC0) == 0x80) --end;  // whole UTF-8
  return line.substr(0, end) + "...";
}

std::string reasonText(const std::exception& error) {
  const std::string text = error.what();
  return onOneLine(text.substr(0, text.find_last_not_of(" \t\r\n") + 1));
}

std::string valueText(const YAML::Node& node) {
  std::string text;
  append(node, text);
  return shortText(text);
}

std::string numberText(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", value);
  return text;
}

std::optional<double> parseNumber(const std::string& text) {
  std::string digits = text;
  if (!digits.empty() && digits.front() == '+') digits.erase(0, 1);
  const bool negative = !digits.empty() && digits.front() == '-';
  if (text.size() > digits.size() && negative) return std::nullopt;  // "+-1"
  if (hasAmbiguousLeadingZero(negative ? digits.substr(1) : digits)) return std::nullopt;
  double value = 0.0;
  // A stream of the classic locale: a point is a point in every country.
  std::istringstream stream(digits);
  stream.imbue(std::locale::classic());
  stream >> std::noskipws >> value;
  if (stream.fail() || stream.peek() != std::istringstream::traits_type::eof()) return std::nullopt;
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

}  // namespace robot_tissue
