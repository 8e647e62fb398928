#include "output_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <utility>

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/state_file.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {

namespace fs = std::filesystem;

namespace {

// The folders there are, and who may write or discard them now.
std::mutex& guard() {
  static std::mutex mutex;
  return mutex;
}
std::set<OutputFolder*>& folders() {
  static std::set<OutputFolder*> all;
  return all;
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, std::vector<std::string> files)
    : path_(fs::absolute(path).lexically_normal()), files_(std::move(files)) {
  const std::lock_guard<std::mutex> lock(guard());
  if (!path_.has_filename()) path_ = path_.parent_path();  // "results/"
  makeFolders();
  std::string pattern = (path_ / ".simulate-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    const std::string why = std::strerror(errno);
    std::error_code ignored;
    for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder)
      fs::remove(*folder, ignored);
    refuse(why);
  }
  staging_ = pattern;
  folders().insert(this);
}

void OutputFolder::makeFolders() {
  std::error_code error;
  std::vector<fs::path> missing;
  fs::path folder = path_;
  while (!fs::exists(folder, error) && folder != folder.root_path()) {
    missing.push_back(folder);
    folder = folder.parent_path();
  }
  if (!fs::is_directory(folder, error)) refuse(folder.string() + " is no folder");
  for (const std::string& file : files_) {
    if (fs::exists(path_ / file, error) && !fs::is_regular_file(path_ / file, error)) {
      refuse((path_ / file).string() + " is no plain file");
    }
  }
  for (auto next = missing.rbegin(); next != missing.rend(); ++next) {
    if (fs::create_directory(*next, error)) {
      made_.push_back(*next);
    } else if (error) {  // else another run has made it meanwhile
      std::error_code ignored;
      for (auto made = made_.rbegin(); made != made_.rend(); ++made) fs::remove(*made, ignored);
      refuse(error.message());
    }
  }
}

OutputFolder::~OutputFolder() {
  const std::lock_guard<std::mutex> lock(guard());
  folders().erase(this);
  discard();
}

// The lock is held on to: nothing is written any more, as the program ends.
void OutputFolder::discardAll() {
  guard().lock();
  for (OutputFolder* folder : folders()) folder->discard();
}

void OutputFolder::discard() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (committed_) return;
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) fs::remove(*folder, ignored);
}

void OutputFolder::write(const std::string& file, const std::string& content) {
  const std::lock_guard<std::mutex> lock(guard());
  errno = 0;
  std::ofstream stream(staging_ / file, std::ios::binary);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  const int number = errno;  // of the call that failed, where one did
  if (stream) return;
  refuse("cannot write " + file + (number == 0 ? "" : std::string(", ") + std::strerror(number)));
}

void OutputFolder::writeState(const std::string& file, const std::string& bytes) {
  const std::lock_guard<std::mutex> lock(guard());
  writeStateFile(staging_.string(), file, bytes);
}

void OutputFolder::commit() {
  const std::lock_guard<std::mutex> lock(guard());
  for (const std::string& file : files_) {
    std::error_code error;
    if (!fs::exists(staging_ / file, error)) continue;
    fs::rename(staging_ / file, path_ / file, error);
    if (error) refuse("cannot write " + file + ", " + error.message());
  }
  for (const std::string& file : dropped_) {
    std::error_code error;
    if (!fs::is_regular_file(path_ / file, error)) continue;
    if (!fs::remove(path_ / file, error)) refuse("cannot remove " + file + " of an earlier run");
  }
  committed_ = true;
}

void OutputFolder::refuse(const std::string& why) const {
  throw InputError("--out = " + onOneLine(path_.string()) + ": " + onOneLine(why) +
                   ": must be a folder that can be made and written");
}

}  // namespace robot_tissue
