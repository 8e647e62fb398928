// A folder that gets all its files at once or none: they are written to a hidden folder inside it
// and moved when all are complete.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace robot_tissue {

class OutputFolder {
 public:
  // Makes the folder where it is missing. Throws InputError when it cannot be made or written, or
  // when one of `files`, of which commit() moves those that were written, is there but no plain
  // file.
  OutputFolder(const std::string& path, std::vector<std::string> files);
  // Without commit() all is as before.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // Throws InputError, e.g. on a full disk.
  void write(const std::string& file, const std::string& content);
  // On the disk before commit() puts it in place.
  void writeState(const std::string& file, const std::string& bytes);
  // One of an earlier run, which would be taken for this one's, goes with commit().
  void drop(const std::string& file) { dropped_.push_back(file); }
  void commit();

  // Takes away what those that are not committed have made; for an end by a signal.
  static void discardAll();

 private:
  void makeFolders();
  void discard();
  [[noreturn]] void refuse(const std::string& why) const;

  std::filesystem::path path_;
  std::vector<std::string> files_;
  std::vector<std::string> dropped_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> made_;  // outermost first
  bool committed_ = false;
};

}  // namespace robot_tissue
