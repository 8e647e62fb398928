// Small mesh files for the tests of the gate, written to a folder of their own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

inline std::string meshFolder() {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / "robot_tissue_meshes";
  std::filesystem::create_directories(folder);
  return folder.string();
}

inline void writeFile(const std::string& name, const std::string& text) {
  std::ofstream file(meshFolder() + "/" + name, std::ios::binary);
  file << text;
  ASSERT_TRUE(file.flush().good()) << name;
}

inline std::string stlText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(9);
  text << "solid made\n";
  for (const MeshTriangle& triangle : mesh.triangles) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const int corner : triangle) {
      text << "vertex " << mesh.vertices[at(corner)].transpose() << "\n";
    }
    text << "endloop\nendfacet\n";
  }
  text << "endsolid made\n";
  return text.str();
}

inline std::string objText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(9);
  for (const Vec3& vertex : mesh.vertices) text << "v " << vertex.transpose() << "\n";
  for (const auto& [a, b, c] : mesh.triangles) {
    text << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  }
  return text.str();
}

// COLLADA; `up_axis` as in its asset, e.g. Z_UP.
inline std::string daeText(const TriangleMesh& mesh, const std::string& up_axis,
                           double meters_per_unit) {
  std::ostringstream points;
  points.precision(9);
  for (const Vec3& vertex : mesh.vertices) points << vertex.transpose() << " ";
  std::ostringstream corners;
  for (const auto& [a, b, c] : mesh.triangles) corners << a << " " << b << " " << c << " ";
  std::ostringstream text;
  text << R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="unit" meter=")"
       << meters_per_unit << "\"/><up_axis>" << up_axis << R"(</up_axis></asset>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="a" count=")"
       << 3 * mesh.vertices.size() << "\">" << points.str() << R"(</float_array>
<technique_common><accessor source="#a" count=")"
       << mesh.vertices.size() << R"(" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count=")"
       << mesh.triangles.size() << R"("><input semantic="VERTEX" source="#v" offset="0"/><p>)"
       << corners.str() << R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
  return text.str();
}

}  // namespace robot_tissue
