#include "robot_tissue/mesh/quiet_console.h"

#include <console_bridge/console.h>

namespace robot_tissue {

class QuietConsole::Handler : public console_bridge::OutputHandler {
 public:
  Handler() { console_bridge::useOutputHandler(this); }
  ~Handler() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*filename*/,
           int /*line*/) override {
    const std::string line = text.substr(0, text.find('\n'));
    if (first_line.empty()) first_line = line;
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors.push_back(line);
  }

  std::string first_line;
  std::vector<std::string> errors;
};

QuietConsole::QuietConsole() : handler_(std::make_unique<Handler>()) {}
QuietConsole::~QuietConsole() = default;

const std::vector<std::string>& QuietConsole::errors() const { return handler_->errors; }

std::string QuietConsole::reason() const {
  const std::string& line = errors().empty() ? handler_->first_line : errors().front();
  return line.empty() ? "" : " (" + line + ")";
}

}  // namespace robot_tissue
