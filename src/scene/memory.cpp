#include "robot_tissue/scene/memory.h"

#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "robot_tissue/core/compat.h"
#include "robot_tissue/core/grid.h"
#include "robot_tissue/core/method_names.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// The number that the file holds; `otherwise` where there is no such file, or "max" in it.
double numberIn(const std::string& path, double otherwise) {
  std::ifstream file(path);
  double number = 0.0;
  return file >> number ? number : otherwise;
}

// The number after a key, in lines such as "MemAvailable:   20885936 kB" or "inactive_file 4096".
double namedNumberIn(const std::string& path, const std::string& name, double otherwise) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    double number = 0.0;
    if (words >> word >> number && word == name) return number;
  }
  return otherwise;
}

struct GroupFiles {
  const char* limit;
  const char* used;
  const char* cache;  // in memory.stat: of what is used, given back on demand
};

// Bytes that the limits of a control group and of all around it leave. From within a container the
// group's own folder is not there; its limits are then in the top folder.
double leftInGroups(const std::string& top, std::string group, const GroupFiles& files) {
  double left = kUnlimited;
  while (true) {
    const std::string folder = top + group + "/";
    const double limit = numberIn(folder + files.limit, kUnlimited);
    const double used = numberIn(folder + files.used, 0.0);
    const double cache = namedNumberIn(folder + "memory.stat", files.cache, 0.0);
    left = std::min(left, limit - std::max(0.0, used - cache));
    if (group.empty()) return left;
    group.resize(group.rfind('/'));
  }
}

double leftByGroups(const std::string& root) {
  double left = kUnlimited;
  std::ifstream file(root + "/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {  // "4:memory:/a/b", "0::/a/b"
    const std::size_t first = std::min(line.find(':'), line.size());
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    std::string group = line.substr(second + 1);
    if (group.empty() || group.front() != '/') continue;
    if (group == "/") group.clear();
    const std::string kinds = "," + line.substr(first + 1, second - first - 1) + ",";
    if (kinds == ",,") {
      left = std::min(left, leftInGroups(root + "/sys/fs/cgroup", group,
                                         {"memory.max", "memory.current", "inactive_file"}));
    } else if (kinds.find(",memory,") != std::string::npos) {
      left = std::min(left, leftInGroups(root + "/sys/fs/cgroup/memory", group,
                                         {"memory.limit_in_bytes", "memory.usage_in_bytes",
                                          "total_inactive_file"}));
    }
  }
  return left;
}

double leftByLimit(int resource, double used) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0) return kUnlimited;
  if (limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  return static_cast<double>(limit.rlim_cur) - used;
}

double leftByLimits(const std::string& root) {
  constexpr double kKilobyte = 1024.0;
  const std::string status = root + "/proc/self/status";
  const double space = namedNumberIn(status, "VmSize:", 0.0) * kKilobyte;
  const double data = namedNumberIn(status, "VmData:", 0.0) * kKilobyte;
  return std::min(leftByLimit(RLIMIT_AS, space), leftByLimit(RLIMIT_DATA, data));
}

MethodTraits traitsOfAny(const std::string& method) {
  return method.empty() ? MethodTraits() : traitsOf(method);
}

double factorBytes(double nodes, const std::string& method) {
  return traitsOfAny(method).factor_bytes * std::pow(nodes, 4.0 / 3.0);
}

double trianglesOf(const TriangleMesh& mesh, double spacing) {
  double triangles = 0.0;
  for (const MeshTriangle& t : mesh.triangles) {
    const double squares = 0.5 * doubleArea(mesh.vertices, t).norm() / (spacing * spacing);
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 edge = mesh.vertices[at(t[i])] - mesh.vertices[at(t[(i + 1) % 3])];
      longest = std::max(longest, edge.norm() / spacing);
    }
    triangles += 1.0 + 4.0 * squares + 4.0 * longest;
  }
  return triangles;
}

double trianglesOf(const Box& box, double spacing) {
  const Vec3 size = (box.max() - box.min()) / spacing;
  return 4.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
}

}  // namespace

double freeMemory(const std::string& root) {
  constexpr double kKilobyte = 1024.0;
  const double machine =
      namedNumberIn(root + "/proc/meminfo", "MemAvailable:", kUnlimited) * kKilobyte;
  return std::max(0.0, std::min({machine, leftByGroups(root), leftByLimits(root)}));
}

double residentMemory() {
  constexpr double kKilobyte = 1024.0;
  return namedNumberIn("/proc/self/status", "VmRSS:", 0.0) * kKilobyte;
}

double heapInUse() { return compat::heapInUse(); }

void keepFreeMemory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, tuning::kLargestKept);
  mallopt(M_TRIM_THRESHOLD, tuning::kMostKept);
#endif
}

void giveBackFreeMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

double memoryOf(double nodes, const std::string& method) {
  return tuning::kBytesPerNode * nodes + factorBytes(nodes, method);
}

double mostNodes(double bytes, const std::string& method) {
  double low = 0.0;
  double high = tuning::kMostNodes;
  if (memoryOf(high, method) <= bytes) return std::floor(high);
  while (high - low > 0.5) {
    const double middle = 0.5 * (low + high);
    (memoryOf(middle, method) <= bytes ? low : high) = middle;
  }
  return std::floor(low);
}

double nodesWithin(const TriangleMesh& mesh, double spacing) {
  double area = 0.0;
  for (const MeshTriangle& triangle : mesh.triangles) {
    area += 0.5 * doubleArea(mesh.vertices, triangle).norm();
  }
  // A surface reaches into up to three cells along each square of it.
  const double cells =
      std::abs(enclosedVolume(mesh.vertices, mesh.triangles)) / std::pow(spacing, 3) +
      3.0 * area / (spacing * spacing);
  const Box box = boundsOf(mesh.vertices);
  const Vec3 around = ((box.max() - box.min()) / spacing).array().ceil() + 1.0;
  return std::min(cells, around.prod());
}

double memoryAround(const TissueConfig& tissue, const std::string& method) {
  const double membrane = tissue.membranes.empty() ? 0.0 : tuning::kBytesPerMembraneTriangle;
  if (!tissue.mesh) return membrane * trianglesOf(tissue.shape, tissue.spacing);
  const Box box = boundsOf(tissue.mesh->vertices);
  const Vec3 around = ((box.max() - box.min()) / tissue.spacing).array().ceil() + 2.0;
  if (around.prod() > std::numeric_limits<int>::max()) return kUnlimited;  // numbered by int
  const double of_method = traitsOfAny(method).grid_bytes;
  return (tuning::kBytesPerGridCell + of_method) * around.prod() +
         (tuning::kBytesPerTriangle + membrane) * trianglesOf(*tissue.mesh, tissue.spacing);
}

}  // namespace robot_tissue
