// Holds back what urdfdom prints through console_bridge
// while it lives, and keeps it for our own message.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace robot_tissue {

class QuietConsole {
 public:
  QuietConsole();
  ~QuietConsole();
  QuietConsole(const QuietConsole&) = delete;
  QuietConsole& operator=(const QuietConsole&) = delete;

  // First line of each error.
  const std::vector<std::string>& errors() const;

  // " (reason)", or nothing when no reason was printed.
  std::string reason() const;

 private:
  class Handler;
  std::unique_ptr<Handler> handler_;
};

}  // namespace robot_tissue
