#include "dae_geometry.h"

#include <algorithm>
#include <array>
#include <vector>

#include "mesh_formats.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {
namespace {

using tinyxml2::XMLElement;

constexpr int kMostInputs = 64;  // of a corner: position, normal, textures, ...

const XMLElement& sourceOf(const XMLElement& mesh, const std::string& id) {
  for (const XMLElement* source = mesh.FirstChildElement("source"); source != nullptr;
       source = source->NextSiblingElement("source")) {
    if (source->Attribute("id", id.c_str()) != nullptr) return *source;
  }
  throw InputError("has no <source> '" + id + "'");
}

int wholeOr(const XMLElement& element, const char* name, int otherwise) {
  return element.Attribute(name) != nullptr ? toWhole(element.Attribute(name)) : otherwise;
}

std::vector<double> realsOf(const XMLElement& element) {
  const std::string text = textOf(element);
  std::string_view rest = text;
  std::vector<double> reals;
  for (auto word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
    reals.push_back(toReal(word));
  }
  return reals;
}

// Where x, y, z stand in an entry; the first three where its numbers have no such names.
std::array<int, 3> axesOf(const XMLElement& accessor) {
  std::array<int, 3> axes = {0, 1, 2};
  int place = 0;
  for (const XMLElement* param = accessor.FirstChildElement("param"); param != nullptr;
       param = param->NextSiblingElement("param"), ++place) {
    const std::string name = param->Attribute("name") != nullptr ? param->Attribute("name") : "";
    if (name == "X") axes[0] = place;
    if (name == "Y") axes[1] = place;
    if (name == "Z") axes[2] = place;
  }
  return axes;
}

std::vector<Vec3> placesOf(const XMLElement& source) {
  const XMLElement& accessor = requiredChild(requiredChild(source, "technique_common"), "accessor");
  const std::vector<double> reals = realsOf(requiredChild(source, "float_array"));
  const int count = toWhole(attributeOf(accessor, "count"));
  const int stride = wholeOr(accessor, "stride", 1);
  const int offset = wholeOr(accessor, "offset", 0);
  const std::array<int, 3> axes = axesOf(accessor);
  const int width = 1 + *std::max_element(axes.begin(), axes.end());
  // In this order nothing overflows.
  if (count < 0 || offset < 0 || stride < width || stride > kMostInputs ||
      static_cast<std::size_t>(count) > reals.size() / at(stride) + 1 ||
      (count > 0 && at(offset) + at(stride) * at(count - 1) + at(width) > reals.size())) {
    throw InputError("has an <accessor> that reaches beyond its " + std::to_string(reals.size()) +
                     " numbers");
  }
  std::vector<Vec3> places;
  for (int i = 0; i < count; ++i) {
    const double* entry = &reals[at(offset) + at(stride) * at(i)];
    places.emplace_back(entry[axes[0]], entry[axes[1]], entry[axes[2]]);
  }
  return places;
}

const XMLElement& inputOf(const XMLElement& element, const char* semantic) {
  for (const XMLElement* input = element.FirstChildElement("input"); input != nullptr;
       input = input->NextSiblingElement("input")) {
    if (input->Attribute("semantic", semantic) != nullptr) return *input;
  }
  throw InputError("has a <" + std::string(element.Name()) + "> without the input " + semantic);
}

// Reads what <triangles>, <polylist> and their like have in common: lists of indices, some of them
// of positions.
class Corners {
 public:
  Corners(const XMLElement& primitive, int vertex_count) : vertex_count_(vertex_count) {
    place_ = wholeOr(inputOf(primitive, "VERTEX"), "offset", 0);
    for (const XMLElement* input = primitive.FirstChildElement("input"); input != nullptr;
         input = input->NextSiblingElement("input")) {
      const int offset = wholeOr(*input, "offset", 0);
      if (offset < 0 || offset >= kMostInputs) {
        throw InputError("has an input of offset " + std::to_string(offset));
      }
      inputs_ = std::max(inputs_, offset + 1);
    }
  }

  std::vector<int> read(const XMLElement& p) const {
    const std::string text = textOf(p);
    std::string_view rest = text;
    std::vector<int> vertices;
    int place = 0;
    for (auto word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
      const int index = toWhole(word);
      if (place == place_) vertices.push_back(checked(index));
      place = (place + 1) % inputs_;
    }
    if (place != 0) throw InputError("has a <p> that ends within a corner");
    return vertices;
  }

 private:
  int checked(int index) const {
    if (index >= 0 && index < vertex_count_) return index;
    throw InputError("has a corner at vertex " + std::to_string(index) + " of " +
                     std::to_string(vertex_count_));
  }

  int vertex_count_;
  int place_ = 0;
  int inputs_ = 1;
};

void appendTriangles(const std::vector<int>& corners, TriangleMesh& mesh) {
  if (corners.size() % 3 != 0) throw InputError("has <triangles> that end within a triangle");
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    appendPolygon({corners[i], corners[i + 1], corners[i + 2]}, mesh);
  }
}

void appendList(const XMLElement& polylist, const std::vector<int>& corners, TriangleMesh& mesh) {
  const std::string text = textOf(requiredChild(polylist, "vcount"));
  std::string_view rest = text;
  std::size_t used = 0;
  for (auto word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
    const int count = toWhole(word);
    if (count < 0 || at(count) > corners.size() - used) {
      throw InputError("has a <vcount> beyond its <p>");
    }
    const auto first = corners.begin() + static_cast<std::ptrdiff_t>(used);
    appendPolygon({first, first + count}, mesh);
    used += at(count);
  }
}

// Each corner after the second one makes a triangle with two before it.
void appendStrip(const std::vector<int>& corners, bool fan, TriangleMesh& mesh) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const bool turned = !fan && i % 2 == 1;
    const int first = corners[fan ? 0 : i - 2];
    const int second = corners[i - 1];
    appendPolygon({turned ? second : first, turned ? first : second, corners[i]}, mesh);
  }
}

void appendPrimitive(const XMLElement& primitive, TriangleMesh& mesh) {
  const std::string kind = primitive.Name();
  const bool fan = kind == "trifans";
  if (kind != "triangles" && kind != "polylist" && kind != "polygons" && kind != "tristrips" &&
      !fan) {
    return;  // lines, and what is no primitive
  }
  const XMLElement* p = primitive.FirstChildElement("p");
  if (p == nullptr && primitive.FirstChildElement("ph") != nullptr) {
    throw InputError("has polygons with holes, which are not read");
  }
  if (p == nullptr) return;
  const Corners corners(primitive, static_cast<int>(mesh.vertices.size()));
  if (kind == "triangles") return appendTriangles(corners.read(*p), mesh);
  if (kind == "polylist") return appendList(primitive, corners.read(*p), mesh);
  for (; p != nullptr; p = p->NextSiblingElement("p")) {
    if (kind == "polygons") {
      appendPolygon(corners.read(*p), mesh);
    } else {
      appendStrip(corners.read(*p), fan, mesh);
    }
  }
}

}  // namespace

const XMLElement& requiredChild(const XMLElement& element, const char* name) {
  const XMLElement* child = element.FirstChildElement(name);
  if (child != nullptr) return *child;
  throw InputError("has a <" + std::string(element.Name()) + "> without <" + name + ">");
}

std::string textOf(const XMLElement& element) {
  std::string text;
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node != nullptr;
       node = node->NextSibling()) {
    if (node->ToText() != nullptr) text.append(node->Value()).append(" ");
  }
  return text;
}

std::string attributeOf(const XMLElement& element, const char* name) {
  if (element.Attribute(name) != nullptr) return element.Attribute(name);
  throw InputError("has a <" + std::string(element.Name()) + "> without the attribute " + name);
}

std::string referenceOf(const XMLElement& element, const char* name) {
  const std::string reference = attributeOf(element, name);
  if (reference.size() > 1 && reference[0] == '#') return reference.substr(1);
  throw InputError("has a <" + std::string(element.Name()) + "> that refers to '" + reference +
                   "', which is not in the file");
}

TriangleMesh readDaeGeometry(const XMLElement& geometry) {
  TriangleMesh read;
  const XMLElement* mesh = geometry.FirstChildElement("mesh");
  if (mesh == nullptr) return read;
  const XMLElement& positions = inputOf(requiredChild(*mesh, "vertices"), "POSITION");
  read.vertices = placesOf(sourceOf(*mesh, referenceOf(positions, "source")));
  for (const XMLElement* part = mesh->FirstChildElement(); part != nullptr;
       part = part->NextSiblingElement()) {
    appendPrimitive(*part, read);
  }
  return read;
}

}  // namespace robot_tissue
