#include "robot_tissue/scene/state_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "robot_tissue/core/types.h"
#include "robot_tissue/mesh/regular_file.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {

namespace fs = std::filesystem;

namespace {

constexpr mode_t kMode = 0666;                            // less the user's mask, as of any file
constexpr std::size_t kLongestFileName = 100;             // bytes
constexpr std::size_t kMostBytes = std::size_t{1} << 32;  // of a file; 30 million nodes have less

const std::string kAllowedToWrite = "; allowed: a file in a folder that can be made and written";

[[noreturn]] void refuse(const std::string& name, const std::string& reason) {
  throw InputError("file = '" + shortText(name) + "': " + onOneLine(reason));
}

void requireStateFileName(const std::string& name) {
  const std::string fault = stateFileFault(name);
  if (!fault.empty()) refuse(name, fault);
}

// The steps of a write, each by itself.
class NewFile {
 public:
  NewFile(const fs::path& folder, const std::string& name) : name_(name) {
    const std::string first = (folder / ("." + name + "-")).string() + std::to_string(::getpid());
    for (int count = 1; number_ < 0; ++count) {
      const std::string path = first + "-" + std::to_string(count);
      number_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
      if (number_ >= 0) path_ = path;
      if (number_ < 0 && errno != EEXIST) fail();
    }
  }
  ~NewFile() {
    if (number_ >= 0) ::close(number_);
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void write(const std::string& bytes) {
    for (std::size_t written = 0; written < bytes.size();) {
      const ssize_t more = ::write(number_, bytes.data() + written, bytes.size() - written);
      if (more < 0 && errno != EINTR) fail();
      written += static_cast<std::size_t>(std::max<ssize_t>(more, 0));
    }
    if (::fsync(number_) != 0) fail();
  }
  void moveTo(const fs::path& path) {
    if (::rename(path_.c_str(), path.c_str()) != 0) fail();
    path_.clear();
  }

 private:
  [[noreturn]] void fail() const { refuse(name_, std::strerror(errno) + kAllowedToWrite); }

  std::string name_;
  std::string path_;
  int number_ = -1;
};

// Flushes the folder's entries to the disk, so that the new name outlives a loss of power, too.
void keepFolder(const fs::path& folder) {
  const int number = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (number < 0) return;
  ::fsync(number);
  ::close(number);
}

}  // namespace

std::string stateFileFault(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  };
  const fs::path extension = fs::path(name).extension();  // the runner's results have these
  const bool fits = extension != ".csv" && extension != ".stl" && !name.empty() &&
                    name.size() <= kLongestFileName && name.front() != '.' &&
                    std::all_of(name.begin(), name.end(), allowed);
  if (fits) return "";
  return "must be a plain name of at most " + std::to_string(kLongestFileName) +
         " letters, digits, '.', '_' and '-' that neither begins with '.' nor ends in .csv or .stl";
}

bool writeStateFile(const std::string& folder, const std::string& name, const std::string& bytes) {
  requireStateFileName(name);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    refuse(name, "cannot make the folder " + folder + ", " + error.message() + kAllowedToWrite);
  const fs::file_status earlier = fs::symlink_status(fs::path(folder) / name, error);
  if (earlier.type() == fs::file_type::none) refuse(name, error.message() + kAllowedToWrite);
  if (fs::exists(earlier) && !fs::is_regular_file(earlier)) {
    refuse(name, "is there, and no regular file; allowed: a new file, or one to replace");
  }
  NewFile file(folder, name);
  file.write(bytes);
  file.moveTo(fs::path(folder) / name);
  keepFolder(folder);
  return fs::exists(earlier);
}

std::string readStateFile(const std::string& folder, const std::string& name) {
  requireStateFileName(name);
  try {
    return readRegularFile((fs::path(folder) / name).string(), kMostBytes);
  } catch (const InputError& error) {
    refuse(name, error.what() + ("; allowed: a saved state in the folder " + folder));
  }
}

}  // namespace robot_tissue
