#include "robot_tissue/scene/value_text.h"

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

}  // namespace

// yaml-cpp's tag of what stands in quotes, and YAML's own.
bool isText(const YAML::Node& scalar) {
  return scalar.Tag() == "!" || scalar.Tag() == "tag:yaml.org,2002:str";
}

std::string onOneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c == '\n') {
      line += "\\n";
    } else {
      line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    }
  }
  return line;
}

// Whether the bytes are UTF-8 by RFC 3629: no longer forms than needed, no surrogates, nothing
// beyond U+10FFFF.
bool isUtf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
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
    if (length == 0) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte(k) & 0xC0U) != 0x80U) return false;
    }
    const bool wrong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ||
                       (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F);
    if (wrong) return false;
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
