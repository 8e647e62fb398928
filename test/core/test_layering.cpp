// Who may include whom: read from the sources, so that a shortcut between layers does not pass.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace robot_tissue {
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

std::vector<Include> includesIn(const std::string& folder) {
  std::vector<Include> includes;
  const std::vector<fs::path> files = filesIn(folder);
  EXPECT_FALSE(files.empty()) << "no source in " << folder;
  for (const fs::path& path : files) {
    std::ifstream file(path);
    EXPECT_TRUE(file.good()) << path;
    for (std::string line; std::getline(file, line);) {
      const std::string header = includedBy(line);
      if (!header.empty()) includes.push_back({path.string(), header});
    }
  }
  EXPECT_FALSE(includes.empty()) << "no #include in " << folder;
  return includes;
}

// The standard library's and the system's: no folder; <vector> or <unistd.h>.
bool isStandard(const std::string& header) {
  static const std::vector<std::string> c_headers = {"fcntl.h", "stdlib.h", "sys/resource.h",
                                                     "sys/stat.h", "unistd.h"};
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

TEST(Layering, IncludeLinesAreRead) {
  EXPECT_EQ(includedBy("#include <vector>"), "vector");
  EXPECT_EQ(includedBy("  #  include \"robot_tissue/core/types.h\"  // why"),
            "robot_tissue/core/types.h");
  EXPECT_EQ(includedBy("// #include <ros/ros.h>"), "");
  EXPECT_EQ(includedBy("int include = 0;"), "");
  EXPECT_TRUE(filesIn("no_such_folder").empty());
}

TEST(Layering, CoreStandsOnEigenAlone) {
  for (const char* folder : {"include/robot_tissue/core", "src/core"}) {
    expectOnly(folder, {"Eigen/", "robot_tissue/core/"});
    expectNone(folder, {"CholmodSupport", "cholmod"});
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

TEST(Layering, PipelineJoinsCoreAndContact) {
  for (const char* folder : {"include/robot_tissue/pipeline", "src/pipeline"}) {
    expectOnly(folder,
               {"Eigen/", "robot_tissue/core/", "robot_tissue/contact/", "robot_tissue/pipeline/"});
  }
}

TEST(Layering, RosKnowsNeitherFclNorTheSolversInsides) {
  for (const char* folder : {"include/robot_tissue/ros", "src/ros"}) {
    expectNone(folder, {"fcl/", "paper_method.h", "six_spring_model.h", "solver_method.h"});
  }
}

TEST(Layering, ProgramsForTheCommandLineKnowNoRos) {
  for (const char* folder : {"src/simulate", "src/fidelity"}) {
    expectNone(folder, {"ros/", "tf2", "_msgs/", "fcl/"});
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
}  // namespace robot_tissue
