// Holds back what third-party libraries (urdfdom, geometric_shapes) print through console_bridge
// while it lives, and keeps it for our own message.
#pragma once

#include <console_bridge/console.h>

#include <string>
#include <vector>

namespace robot_tissue {

class QuietConsole : public console_bridge::OutputHandler {
 public:
  QuietConsole() { console_bridge::useOutputHandler(this); }
  ~QuietConsole() override { console_bridge::restorePreviousOutputHandler(); }
  QuietConsole(const QuietConsole&) = delete;
  QuietConsole& operator=(const QuietConsole&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*filename*/,
           int /*line*/) override {
    const std::string line = text.substr(0, text.find('\n'));
    if (first_line_.empty()) first_line_ = line;
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors_.push_back(line);
  }

  const std::vector<std::string>& errors() const { return errors_; }

  // " (reason)", or nothing when no reason was printed.
  std::string reason() const {
    const std::string& line = errors_.empty() ? first_line_ : errors_.front();
    return line.empty() ? "" : " (" + line + ")";
  }

 private:
  std::string first_line_;
  std::vector<std::string> errors_;
};

}  // namespace robot_tissue
