#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "dae_geometry.h"
#include "mesh_formats.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {
namespace {

using tinyxml2::XMLElement;

constexpr int kMostNodes = 100000;         // with those that are placed more than once
constexpr std::size_t kDeepestNode = 500;  // in one another; each takes some of the stack

template <std::size_t count>
std::array<double, count> realsIn(const XMLElement& element) {
  const std::string text = textOf(element);
  std::string_view rest = text;
  std::array<double, count> reals;
  for (double& real : reals) real = toReal(takeWord(rest));
  return reals;
}

// What one element does to the frame of its node; nothing when it is no transform that is read.
std::optional<Eigen::Affine3d> transformOf(const XMLElement& element) {
  const std::string kind = element.Name();
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (kind == "matrix") {
    const auto reals = realsIn<16>(element);
    for (std::size_t i = 0; i < 12; ++i) {
      transform(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = reals[i];
    }
  } else if (kind == "translate") {
    const auto reals = realsIn<3>(element);
    transform.translate(Vec3(reals[0], reals[1], reals[2]));
  } else if (kind == "scale") {
    const auto reals = realsIn<3>(element);
    transform.scale(Vec3(reals[0], reals[1], reals[2]));
  } else if (kind == "rotate") {
    const auto reals = realsIn<4>(element);
    const Vec3 axis(reals[0], reals[1], reals[2]);
    if (axis.norm() > 0.0) {
      transform.rotate(Eigen::AngleAxisd(reals[3] * M_PI / 180.0, axis.normalized()));
    }
  } else if (kind == "lookat" || kind == "skew") {
    return std::nullopt;
  }
  return transform;
}

class DaeReader {
 public:
  explicit DaeReader(const XMLElement& root) { collect(root); }

  TriangleMesh read(const XMLElement& root) {
    const XMLElement& instance =
        requiredChild(requiredChild(root, "scene"), "instance_visual_scene");
    placeChildren(elementOf("visual_scene", instance), Eigen::Affine3d::Identity());
    return std::move(whole_);
  }

 private:
  // The depth is bounded by tinyxml2.
  void collect(const XMLElement& element) {
    const std::string kind = element.Name();
    if (element.Attribute("id") != nullptr) {
      by_id_.emplace(std::make_pair(kind, element.Attribute("id")), &element);
    }
    if (kind == "mesh") return;
    for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      collect(*child);
    }
  }

  const XMLElement& elementOf(const char* kind, const XMLElement& instance) const {
    const std::string id = referenceOf(instance, "url");
    const auto found = by_id_.find({kind, id});
    if (found != by_id_.end()) return *found->second;
    throw InputError("has no <" + std::string(kind) + "> '" + id + "'");
  }

  void placeChildren(const XMLElement& node, const Eigen::Affine3d& outer) {
    if (++nodes_ > kMostNodes) {
      throw InputError("has more than " + std::to_string(kMostNodes) + " nodes");
    }
    if (!open_.insert(&node).second) throw InputError("has a <node> within itself");
    if (open_.size() > kDeepestNode) {
      throw InputError("has more than " + std::to_string(kDeepestNode) + " nodes in one another");
    }
    std::optional<Eigen::Affine3d> frame = outer;  // nothing: by a transform that is not read
    for (const XMLElement* child = node.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const std::string kind = child->Name();
      if (kind == "node" || kind == "instance_node") {
        const XMLElement& inner = kind == "node" ? *child : elementOf("node", *child);
        if (frame) placeChildren(inner, *frame);
      } else if (kind == "instance_geometry") {
        if (!frame) throw InputError("has a geometry placed by lookat or skew, which is not read");
        append(meshOf(elementOf("geometry", *child)), *frame);
      } else if (kind == "instance_controller") {
        throw InputError("has a skin (instance_controller), which is not read");
      } else if (frame) {
        const auto own = transformOf(*child);
        frame = own ? std::optional<Eigen::Affine3d>(*frame * *own) : std::nullopt;
      }
    }
    open_.erase(&node);
  }

  const TriangleMesh& meshOf(const XMLElement& geometry) {
    const auto known = meshes_.find(&geometry);
    if (known != meshes_.end()) return known->second;
    return meshes_.emplace(&geometry, readDaeGeometry(geometry)).first->second;
  }

  void append(const TriangleMesh& mesh, const Eigen::Affine3d& frame) {
    if (whole_.triangles.size() + mesh.triangles.size() > kMostTriangles ||
        whole_.vertices.size() + mesh.vertices.size() > 3 * kMostTriangles) {
      throw InputError("has more than " + std::to_string(kMostTriangles) + " triangles");
    }
    const int first = static_cast<int>(whole_.vertices.size());
    for (const Vec3& vertex : mesh.vertices) whole_.vertices.push_back(frame * vertex);
    for (const auto& [a, b, c] : mesh.triangles) {
      whole_.triangles.push_back({first + a, first + b, first + c});
    }
  }

  std::map<std::pair<std::string, std::string>, const XMLElement*> by_id_;
  std::map<const XMLElement*, TriangleMesh> meshes_;
  std::set<const XMLElement*> open_;  // on the way to the node that is placed
  int nodes_ = 0;
  TriangleMesh whole_;
};

}  // namespace

TriangleMesh readDae(const std::string& bytes) {
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS) {
    throw InputError("is no XML: " + std::string(document.ErrorStr()));
  }
  const XMLElement* root = document.RootElement();
  if (root == nullptr || std::string(root->Name()) != "COLLADA") {
    throw InputError("is no XML whose root is COLLADA");
  }
  return DaeReader(*root).read(*root);
}

// The rest of the file is not parsed a second time for it.
DaeAsset readDaeAsset(const std::string& bytes) {
  DaeAsset asset;
  const std::string end = "</asset>";
  const std::size_t from = bytes.find("<asset");
  const std::size_t to = bytes.find(end, from);
  if (from == std::string::npos || to == std::string::npos) return asset;
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data() + from, to + end.size() - from) != tinyxml2::XML_SUCCESS) {
    return asset;
  }
  const XMLElement& root = *document.RootElement();
  const XMLElement* unit = root.FirstChildElement("unit");
  const double meters = unit != nullptr ? unit->DoubleAttribute("meter", 1.0) : 1.0;
  if (std::isfinite(meters) && meters > 0.0) asset.unit = meters;
  const XMLElement* up_axis = root.FirstChildElement("up_axis");
  for (const char* axis : {"X_UP", "Y_UP"}) {
    if (up_axis != nullptr && textOf(*up_axis).find(axis) != std::string::npos)
      asset.up_axis = axis;
  }
  return asset;
}

}  // namespace robot_tissue
