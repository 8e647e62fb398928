#include "output_bag.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {

OutputBag::OutputBag(const std::string& path) : path_(path) {
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored) &&
      !std::filesystem::is_regular_file(path_, ignored)) {
    refuse("is no file");
  }
  makePart();
  try {
    bag_->open(part_, rosbag::bagmode::Write);
  } catch (const std::exception& error) {
    leaveBag();
    std::filesystem::remove(part_, ignored);
    refuse(error.what());
  }
}

// As on a full disk: its destructor would close it again, and throw where nothing may be thrown. It
// stays until the program ends.
void OutputBag::leaveBag() { static_cast<void>(bag_.release()); }

// A new file: one that is there already is another's, as of a recording that goes on.
void OutputBag::makePart() {
  const std::string first = path_ + ".active";
  for (int number = 1; part_.empty(); ++number) {
    const std::string name = number == 1 ? first : first + std::to_string(number);
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno != EEXIST) refuse(std::strerror(errno));
    if (file < 0) continue;
    ::close(file);
    part_ = name;
  }
}

OutputBag::~OutputBag() {
  if (part_.empty()) return;
  try {
    if (bag_) bag_->close();
  } catch (const std::exception&) {
    leaveBag();
  }
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void OutputBag::commit() {
  try {
    bag_->close();
    std::filesystem::rename(part_, path_);
  } catch (const std::exception& error) {
    leaveBag();
    refuse(error.what());
  }
  part_.clear();
}

void OutputBag::refuse(const std::string& why) const {
  throw InputError(onOneLine(path_) + ": cannot be written (" + onOneLine(why) +
                   "); allowed: a file in a folder that is there and may be written");
}

}  // namespace robot_tissue
