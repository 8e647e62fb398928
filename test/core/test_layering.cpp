// Who may include whom: read from the sources, so that a shortcut between layers does not pass.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace robot_tissue::test_layering {
namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;
  std::string header;
};

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

// Header named by an #include line; empty for any other line.
std::string includedBy(const std::string& line) {
  std::size_t from = line.find_first_not_of(" \t");
  if (from == std::string::npos || line[from] != '#') return "";
  from = line.find_first_not_of(" \t", from + 1);
  if (from == std::string::npos || line.compare(from, 7, "include") != 0) return "";
  const std::size_t open = line.find_first_of("<\"", from);
  if (open == std::string::npos) return "";
  const std::size_t close = line.find_first_of(">\"", open + 1);
  return line.substr(open + 1, close - open - 1);
}

// Folders are relative to the project's root.
std::vector<fs::path> filesIn(const std::string& folder) {
  std::vector<fs::path> files;
  const fs::path root = fs::path(ROBOT_TISSUE_SOURCE_DIR) / folder;
  if (!fs::is_directory(root)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".h" || extension == ".cpp") files.push_back(entry.path());
  }
  return files;
}

std::vector<Include> includesOf(const fs::path& path) {
  std::vector<Include> includes;
  std::ifstream file(path);
  EXPECT_TRUE(file.good()) << path;
  for (std::string line; std::getline(file, line);) {
    const std::string header = includedBy(line);
    if (!header.empty()) includes.push_back({path.string(), header});
  }
  return includes;
}

std::vector<Include> includesIn(const std::string& folder) {
  std::vector<Include> includes;
  const std::vector<fs::path> files = filesIn(folder);
  EXPECT_FALSE(files.empty()) << "no source in " << folder;
  for (const fs::path& path : files) {
    const std::vector<Include> found = includesOf(path);
    includes.insert(includes.end(), found.begin(), found.end());
  }
  EXPECT_FALSE(includes.empty()) << "no #include in " << folder;
  return includes;
}

// The standard library's and the system's: no folder; <vector> or <unistd.h>.
bool isStandard(const std::string& header) {
  static const std::vector<std::string> c_headers = {"fcntl.h",        "malloc.h",   "stdlib.h",
                                                     "sys/resource.h", "sys/stat.h", "unistd.h"};
  if (header.find('.') == std::string::npos && header.find('/') == std::string::npos) return true;
  return std::find(c_headers.begin(), c_headers.end(), header) != c_headers.end();
}

// A header beside the file that includes it.
bool isBeside(const Include& include) {
  return include.header.find('/') == std::string::npos &&
         fs::exists(fs::path(include.file).parent_path() / include.header);
}

void expectOnly(const std::string& folder, const std::vector<std::string>& allowed) {
  for (const Include& include : includesIn(folder)) {
    const bool named = std::any_of(allowed.begin(), allowed.end(), [&](const std::string& prefix) {
      return startsWith(include.header, prefix);
    });
    EXPECT_TRUE(named || isStandard(include.header) || isBeside(include))
        << include.file << " includes " << include.header;
  }
}

void expectNone(const std::string& folder, const std::vector<std::string>& forbidden) {
  for (const Include& include : includesIn(folder)) {
    for (const std::string& part : forbidden) {
      EXPECT_EQ(include.header.find(part), std::string::npos)
          << include.file << " includes " << include.header;
    }
  }
}

// A room of core and the rooms that it may include.
struct Room {
  std::string name;
  std::set<std::string> uses;
  std::set<std::string> files;  // "robot_tissue/core/types.h", "simd/workers.h"

  bool operator==(const Room& other) const { return name == other.name && uses == other.uses; }
};

std::string textOf(const std::string& file) {
  std::ifstream stream(fs::path(ROBOT_TISSUE_SOURCE_DIR) / file);
  EXPECT_TRUE(stream.good()) << file;
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// From the calls robot_tissue_room(NAME USES ... PUBLIC ... FILES ... VECTOR_LOOPS ...).
std::vector<Room> roomsOfTheBuild() {
  std::vector<Room> rooms;
  const std::string text = textOf("src/core/rooms.cmake");
  const std::string call = "robot_tissue_room(";
  for (std::size_t at = text.find(call); at != std::string::npos; at = text.find(call, at)) {
    at += call.size();
    std::istringstream words(text.substr(at, text.find(')', at) - at));
    Room room;
    words >> room.name;
    std::string list;
    for (std::string word; words >> word;) {
      if (word == "USES" || word == "PUBLIC" || word == "FILES" || word == "VECTOR_LOOPS") {
        list = word;
      } else if (list == "USES") {
        room.uses.insert(word);
      } else {
        room.files.insert((list == "PUBLIC" ? "robot_tissue/core" : room.name) + "/" + word);
      }
    }
    rooms.push_back(room);
  }
  return rooms;
}

// From the table of doc/architecture.md: | room | what it holds | uses |.
std::vector<Room> roomsOfThePage() {
  std::vector<Room> rooms;
  std::istringstream lines(textOf("doc/architecture.md"));
  std::string line;
  while (std::getline(lines, line) && line != "| room | what it holds | uses |") continue;
  std::getline(lines, line);  // |---|
  while (std::getline(lines, line) && startsWith(line, "| ")) {
    std::vector<std::string> cells;
    std::istringstream row(line.substr(2));
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    Room room;
    std::istringstream(cells.at(0)) >> room.name;
    std::string uses = cells.at(2);
    std::replace(uses.begin(), uses.end(), ',', ' ');
    std::istringstream names(uses);
    for (std::string name; names >> name;) room.uses.insert(name);
    rooms.push_back(room);
  }
  return rooms;
}

// The room whose file a header is; empty: none's.
std::string roomOf(const std::string& header, const std::vector<Room>& rooms) {
  for (const Room& room : rooms) {
    if (room.files.count(header) > 0) return room.name;
  }
  return "";
}

TEST(Layering, ThePageHasTheTableOfRooms) {
  const std::vector<Room> rooms = roomsOfTheBuild();
  ASSERT_GT(rooms.size(), 10U);
  EXPECT_EQ(rooms, roomsOfThePage()) << "doc/architecture.md, src/core/rooms.cmake";
}

TEST(Layering, ARoomUsesRoomsBeforeIt) {
  std::set<std::string> before;
  for (const Room& room : roomsOfTheBuild()) {
    for (const std::string& used : room.uses) {
      EXPECT_EQ(before.count(used), 1U) << room.name << " uses " << used;
    }
    before.insert(room.name);
  }
}

TEST(Layering, ARoomIncludesTheRoomsOfItsRow) {
  const std::vector<Room> rooms = roomsOfTheBuild();
  for (const Room& room : rooms) {
    std::set<std::string> included;
    for (const std::string& file : room.files) {
      const std::string folder = startsWith(file, "robot_tissue/") ? "include/" : "src/core/";
      for (const Include& include :
           includesOf(fs::path(ROBOT_TISSUE_SOURCE_DIR) / (folder + file))) {
        if (isStandard(include.header) || startsWith(include.header, "Eigen/")) continue;
        const std::string used = roomOf(include.header, rooms);
        if (used.empty()) continue;  // CoreStandsOnEigenAlone
        if (used != room.name) included.insert(used);
        EXPECT_TRUE(used == room.name || room.uses.count(used) > 0)
            << include.file << " includes " << include.header << " of room " << used;
      }
    }
    EXPECT_EQ(included, room.uses) << "the row of room " << room.name << " names more";
  }
}

TEST(Layering, EveryFileOfCoreIsInOneRoom) {
  const std::vector<Room> rooms = roomsOfTheBuild();
  std::size_t there = 0, listed = 0;
  for (const char* folder : {"include/robot_tissue/core", "src/core"})
    there += filesIn(folder).size();
  for (const Room& room : rooms) listed += room.files.size();
  EXPECT_EQ(there, listed);
}

TEST(Layering, IncludeLinesAreRead) {
  EXPECT_EQ(includedBy("#include <vector>"), "vector");
  EXPECT_EQ(includedBy("  #  include \"robot_tissue/core/types.h\"  // why"),
            "robot_tissue/core/types.h");
  EXPECT_EQ(includedBy("// #include <ros/ros.h>"), "");
  EXPECT_EQ(includedBy("int include = 0;"), "");
  EXPECT_TRUE(filesIn("no_such_folder").empty());
}

TEST(Layering, CoreStandsOnEigenAlone) {
  expectOnly("include/robot_tissue/core", {"Eigen/", "robot_tissue/core/"});
  std::vector<std::string> allowed = {"Eigen/", "robot_tissue/core/"};
  for (const Room& room : roomsOfTheBuild()) allowed.push_back(room.name + "/");
  expectOnly("src/core", allowed);
}

TEST(Layering, CouplingStandsOnCore) {
  for (const char* folder : {"include/robot_tissue/coupling", "src/coupling"}) {
    expectOnly(folder,
               {"Eigen/", "unsupported/Eigen/BVH", "robot_tissue/core/", "robot_tissue/coupling/"});
  }
}

TEST(Layering, MeshKeepsItsLibrariesBehindItsHeaders) {
  expectOnly("include/robot_tissue/mesh", {"Eigen/", "robot_tissue/core/", "robot_tissue/mesh/"});
  expectOnly("src/mesh", {"Eigen/", "tinyxml2.h", "console_bridge/", "rospack/",
                          "robot_tissue/core/", "robot_tissue/mesh/"});
}

TEST(Layering, SceneAddsYaml) {
  for (const char* folder : {"include/robot_tissue/scene", "src/scene"}) {
    expectOnly(folder, {"Eigen/", "yaml-cpp/", "robot_tissue/core/", "robot_tissue/mesh/",
                        "robot_tissue/scene/"});
  }
}

TEST(Layering, ContactKeepsItsLibrariesBehindItsHeaders) {
  expectOnly("include/robot_tissue/contact",
             {"Eigen/", "robot_tissue/core/", "robot_tissue/contact/"});
  expectOnly("src/contact", {"Eigen/", "fcl/", "urdf_model/", "urdf_parser/", "robot_tissue/core/",
                             "robot_tissue/mesh/", "robot_tissue/contact/"});
}

TEST(Layering, PipelineJoinsCoreContactAndCoupling) {
  for (const char* folder : {"include/robot_tissue/pipeline", "src/pipeline"}) {
    expectOnly(folder, {"Eigen/", "robot_tissue/core/", "robot_tissue/contact/",
                        "robot_tissue/coupling/", "robot_tissue/pipeline/"});
  }
}

TEST(Layering, RosKnowsNoFcl) {
  for (const char* folder : {"include/robot_tissue/ros", "src/ros"}) {
    expectNone(folder, {"fcl/"});
  }
}

TEST(Layering, ProgramsForTheCommandLineKnowNoRos) {
  for (const char* folder : {"src/simulate", "src/fidelity"}) {
    expectNone(folder, {"ros/", "tf2", "_msgs/", "fcl/"});
  }
}

// It asks a master only where it is started: what it checks is the scene and the description.
TEST(Layering, CheckSetupSpeaksToRosInItsMainAlone) {
  int found = 0;
  for (const Include& include : includesIn("src/check_setup")) {
    const bool is_of_ros = startsWith(include.header, "ros/") || startsWith(include.header, "tf2");
    if (!is_of_ros) continue;
    ++found;
    EXPECT_EQ(fs::path(include.file).filename(), "main.cpp") << include.header;
  }
  EXPECT_GT(found, 0);
}

TEST(Layering, CholmodKnowsCoreAlone) {
  for (const Include& include : includesIn("src/cholmod")) {
    for (const char* other : {"ros/", "fcl/", "robot_tissue/"}) {
      const bool is_core = startsWith(include.header, "robot_tissue/core/");
      EXPECT_TRUE(is_core || !startsWith(include.header, other))
          << include.file << " includes " << include.header;
    }
  }
}

TEST(Layering, FclIsIncludedInContactsSourcesOnly) {
  int found = 0;
  for (const char* folder : {"include", "src"}) {
    const fs::path allowed = fs::path(ROBOT_TISSUE_SOURCE_DIR) / "src" / "contact";
    for (const Include& include : includesIn(folder)) {
      if (!startsWith(include.header, "fcl/")) continue;
      ++found;
      EXPECT_TRUE(startsWith(include.file, allowed.string()))
          << include.file << " includes " << include.header;
    }
  }
  EXPECT_GT(found, 0);
}

}  // namespace
}  // namespace robot_tissue::test_layering
