#include "robot_tissue/mesh/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "robot_tissue/core/types.h"

namespace robot_tissue {
namespace {

class Descriptor {
 public:
  // Not blocking: to open a pipe must not wait for its writer.
  explicit Descriptor(const std::string& path)
      : number_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

[[noreturn]] void failBySystem() { throw InputError(std::strerror(errno)); }

void requireRegular(const struct stat& status) {
  if (S_ISDIR(status.st_mode)) throw InputError("is a folder");
  if (!S_ISREG(status.st_mode)) throw InputError("is a pipe or a device, no regular file");
}

[[noreturn]] void failBySize(std::size_t most_bytes) {
  throw InputError("has more than " + std::to_string(most_bytes / 1000000) + " MB");
}

}  // namespace

std::string readRegularFile(const std::string& path, std::size_t most_bytes) {
  if (path.find('\0') != std::string::npos) throw InputError("has a name with a zero byte");
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) failBySystem();
  requireRegular(status);  // before it is opened: to open a device may do something
  const Descriptor file(path);
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0) failBySystem();
  requireRegular(status);
  if (static_cast<std::size_t>(status.st_size) > most_bytes) failBySize(most_bytes);
  std::string bytes;
  constexpr std::size_t kBlock = 1 << 16;
  bytes.reserve(static_cast<std::size_t>(status.st_size) + kBlock);
  while (true) {  // to the end and not by the size told, which is 0 for files of /proc
    const std::size_t filled = bytes.size();
    bytes.resize(filled + kBlock);
    const ssize_t got = ::read(file.number(), &bytes[filled], kBlock);
    if (got < 0 && errno != EINTR) failBySystem();
    bytes.resize(filled + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (bytes.size() > most_bytes) failBySize(most_bytes);
    if (got == 0) return bytes;
  }
}

}  // namespace robot_tissue
