#include "output_bag.h"

#include <filesystem>

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {

OutputBag::OutputBag(const std::string& path) : path_(path), part_(path + ".active") {
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored) &&
      !std::filesystem::is_regular_file(path_, ignored)) {
    refuse("is no file");
  }
  try {
    bag_.open(part_, rosbag::bagmode::Write);
  } catch (const std::exception& error) {
    refuse(error.what());
  }
}

OutputBag::~OutputBag() {
  if (part_.empty()) return;
  try {
    bag_.close();
  } catch (const std::exception&) {
    // it goes all the same
  }
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void OutputBag::commit() {
  try {
    bag_.close();
    std::filesystem::rename(part_, path_);
  } catch (const std::exception& error) {
    refuse(error.what());
  }
  part_.clear();
}

void OutputBag::refuse(const std::string& why) const {
  throw InputError(onOneLine(path_) + ": cannot be written (" + onOneLine(why) +
                   "); allowed: a file in a folder that is there and may be written");
}

}  // namespace robot_tissue
