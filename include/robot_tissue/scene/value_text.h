// Text of values in messages: always one line, never long.
#pragma once

#include <yaml-cpp/yaml.h>

#include <exception>
#include <optional>
#include <string>

namespace robot_tissue {

// The value in YAML's flow style, cut short after some 60 characters.
std::string valueText(const YAML::Node& node);

// In quotes, or said to be one by its tag (!!str): "0.005" is no number.
bool isText(const YAML::Node& scalar);

// Control characters and bytes that are no UTF-8 written as \n or ?: the text stays on its line,
// and every reader of a message or log can decode it.
std::string onOneLine(const std::string& text);

// Whether all of its bytes are valid UTF-8: no overlong forms, no surrogates.
bool isUtf8(const std::string& text);

// On one line and cut short after some 60 characters.
std::string shortText(const std::string& text);

// What a library says went wrong: on one line, without blanks at its end.
std::string reasonText(const std::exception& error);

// Short decimal text, up to nine digits.
std::string numberText(double value);

// Decimal numbers as YAML has them; empty for anything else, also for inf, nan and 010 (which one
// YAML version reads as 10 and another as 8).
std::optional<double> parseNumber(const std::string& text);

}  // namespace robot_tissue
