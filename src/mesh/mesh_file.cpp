#include "robot_tissue/mesh/mesh_file.h"

#include <rospack/rospack.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <locale>
#include <sstream>

#include "mesh_formats.h"
#include "robot_tissue/mesh/regular_file.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kLongestReason = 200;  // characters; names in a file may have any number

const std::string kPackage = "package://";
const std::string kFile = "file://";

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

// By the ending of the name, whatever its case; null for other files.
TriangleMesh (*meshReaderFor(const std::string& path))(const std::string& bytes) {
  std::string ending = std::filesystem::path(path).extension();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".stl") return readStl;
  if (ending == ".obj") return readObj;
  return ending == ".dae" ? readDae : nullptr;
}

int digitOf(char c) {  // hexadecimal; -1: none
  const std::string digits = "0123456789abcdef";
  const std::size_t place =
      digits.find(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  return place == std::string::npos ? -1 : static_cast<int>(place);
}

// %XX as the byte that it stands for, but for the end of a text; a % before anything else stays.
std::string decoded(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool may_stand = text[i] == '%' && i + 2 < text.size();
    const int high = may_stand ? digitOf(text[i + 1]) : -1;
    const int low = may_stand ? digitOf(text[i + 2]) : -1;
    const bool stands = high >= 0 && low >= 0 && high + low > 0;
    bytes += stands ? static_cast<char>(16 * high + low) : text[i];
    if (stands) i += 2;
  }
  return bytes;
}

std::string packageFolder(const std::string& name) {
  rospack::Rospack packages;
  packages.setQuiet(true);
  std::vector<std::string> search_path;
  std::string folder;
  if (packages.getSearchPathFromEnv(search_path)) {
    packages.crawl(search_path, false);
    packages.find(name, folder);
  }
  if (folder.empty()) throw InputError("no ROS package " + name + " is found");
  return folder;
}

std::string pathInPackage(const std::string& place) {
  const std::size_t slash = place.find('/');
  if (slash == std::string::npos) throw InputError("names a package, but no file of it");
  const std::string inner = std::filesystem::path("." + place.substr(slash)).lexically_normal();
  if (inner == ".." || startsWith(inner, "../")) throw InputError("its path leaves the package");
  return packageFolder(place.substr(0, slash)) + "/" + inner;
}

std::string pathOf(const std::string& resource) {
  if (!startsWith(resource, kPackage)) return pathOfFileAddress(resource);
  return pathInPackage(decoded(resource.substr(kPackage.size())));
}

// Meters need no heed, and a scale that is the unit heeds it.
std::string remarkOn(const DaeAsset& asset, const Vec3& scale) {
  const double off = (scale.cwiseAbs().array() - asset.unit).abs().maxCoeff();
  const bool counts = std::abs(asset.unit - 1.0) <= 1e-6 || off <= 1e-6 * asset.unit;
  if (counts && asset.up_axis == "Z_UP") return "";
  std::ostringstream remark;
  remark.imbue(std::locale::classic());
  remark << "names the unit " << asset.unit << " m and the up axis " << asset.up_axis
         << ", which do not count: its coordinates times `scale` are meters, in axes as they are; "
            "export it in meters and Z_UP, or give `scale` and a pose";
  return remark.str();
}

TriangleMesh readByName(const std::string& path, const Vec3& scale, std::string* remark) {
  TriangleMesh (*const read)(const std::string&) = meshReaderFor(path);
  if (read == nullptr) throw InputError("its name ends neither in .stl nor .obj nor .dae");
  const std::string bytes = readRegularFile(path, kLargestMeshFile);
  if (bytes.empty()) throw InputError("is empty");
  TriangleMesh mesh = read(bytes);
  if (mesh.triangles.empty()) throw InputError("has no triangles");
  if (remark != nullptr && read == readDae) *remark = remarkOn(readDaeAsset(bytes), scale);
  return mesh;
}

}  // namespace

std::string pathOfFileAddress(const std::string& address) {
  return decoded(address.substr(kFile.size()));
}

std::string fileAddressOf(const std::string& path) {
  std::string address = kFile;
  for (const char c : path) address += c == '%' ? "%25" : std::string(1, c);
  return address;
}

TriangleMesh loadMeshFile(const std::string& resource, const Vec3& scale, std::string* remark) {
  // Anything else would be looked for on the network.
  if (!startsWith(resource, kPackage) && !startsWith(resource, kFile + "/")) {
    throw InputError("is no package:// or file:// address");
  }
  try {
    TriangleMesh mesh = readByName(pathOf(resource), scale, remark);
    for (Vec3& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale);
    return mesh;
  } catch (const InputError& error) {
    throw InputError("cannot be loaded (" + printable(error.what(), kLongestReason) + ")");
  }
}

}  // namespace robot_tissue
