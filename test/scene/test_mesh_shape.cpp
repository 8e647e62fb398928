// Shapes of type mesh: files of every kind, and the refusals of those that enclose no tissue.
#include <gtest/gtest.h>

#include <limits>

#include "../core/mesh_fixtures.h"
#include "geometry/mesh_slicing.h"
#include "mesh_files.h"
#include "robot_tissue/core/mesh_checks.h"
#include "robot_tissue/scene/readers.h"

namespace robot_tissue::test_mesh_shape {
namespace {

Entry shapeEntry(const std::string& keys) {
  return Entry(YAML::Load("{type: mesh, " + keys + "}"), "tissue.shape", "scene.yaml");
}

TriangleMesh read(const std::string& keys, const std::string& folder = meshFolder()) {
  return readMeshShape(MapReader(shapeEntry(keys), {"type", "resource", "scale"}), folder);
}

std::string refusal(const std::string& keys, const std::string& folder = meshFolder()) {
  testing::internal::CaptureStderr();
  std::string message;
  try {
    read(keys, folder);
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  return message;
}

void expectRefusal(const std::string& message, const std::vector<std::string>& fragments) {
  EXPECT_EQ(message.rfind("scene.yaml:1: tissue.", 0), 0U) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_LT(message.size(), 400U) << message;
  for (const std::string& fragment : fragments) {
    EXPECT_NE(message.find(fragment), std::string::npos)
        << "'" << fragment << "' is not in: " << message;
  }
}

void expectMeshRefused(const TriangleMesh& mesh, const std::string& fragment) {
  writeFile("bad.stl", stlText(mesh));
  expectRefusal(refusal("resource: bad.stl"),
                {"tissue.shape.resource = bad.stl: the mesh ", fragment, "must be closed"});
}

const Vec3 kBoxMin(0.01, -0.02, 0.03);
const Vec3 kBoxMax(0.11, 0.03, 0.09);

void expectBox(const TriangleMesh& mesh, double scale) {
  EXPECT_EQ(mesh.vertices.size(), 8U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_FALSE(meshFault(mesh));
  const Box bounds = boundsOf(mesh.vertices);
  EXPECT_NEAR((bounds.min() - scale * kBoxMin).norm(), 0.0, scale * 1e-7);
  EXPECT_NEAR((bounds.max() - scale * kBoxMax).norm(), 0.0, scale * 1e-7);
  EXPECT_GT(volumeOf(mesh), 0.0);
}

TEST(MeshShape, StlObjAndDaeAreTheSameBox) {
  const TriangleMesh box = boxMesh(kBoxMin, kBoxMax);
  writeFile("box.stl", stlText(box));
  writeFile("box.obj", objText(box));
  writeFile("box.dae", daeText(box, "Z_UP", 1.0));
  writeFile("turned.dae", daeText(box, "Y_UP", 0.01));  // its own unit and axis count for nothing
  for (const char* name : {"box.stl", "box.obj", "box.dae", "turned.dae"}) {
    SCOPED_TRACE(name);
    expectBox(read(std::string("resource: ") + name), 1.0);
    expectBox(read("resource: file://" + meshFolder() + "/" + name, ""), 1.0);
    expectBox(read(std::string("scale: 0.001, resource: ") + name), 0.001);
  }
}

TEST(MeshShape, ScaleMayDifferAlongTheAxes) {
  writeFile("box.stl", stlText(boxMesh(kBoxMin, kBoxMax)));
  const TriangleMesh mesh = read("resource: box.stl, scale: [1, 2, 0.5]");
  EXPECT_NEAR(boundsOf(mesh.vertices).max().y(), 0.06, 1e-7);
  EXPECT_NEAR(volumeOf(mesh), 0.1 * 0.05 * 0.06, 1e-9);
}

TEST(MeshShape, InsideOutMeshIsTurned) {
  writeFile("box.stl", stlText(insideOut(boxMesh(kBoxMin, kBoxMax))));
  expectBox(read("resource: box.stl"), 1.0);
}

TEST(MeshShape, OrgansAreClosedAndOfTheStatedSize) {
  struct Organ {
    const char* name;
    double volume;  // m^3
    Vec3 size;      // m
  };
  // The volumes are those of the committed files.
  for (const Organ& organ : {Organ{"liver", 1.01487e-3, {0.200, 0.139, 0.080}},
                             Organ{"kidney", 1.26753e-4, {0.058, 0.040, 0.107}}}) {
    SCOPED_TRACE(organ.name);
    const std::string file = std::string(organ.name) + ".stl";
    const TriangleMesh mesh =
        read("scale: 0.001, resource: config/meshes/" + file, ROBOT_TISSUE_SOURCE_DIR);
    EXPECT_FALSE(meshFault(mesh));
    EXPECT_NEAR(volumeOf(mesh), organ.volume, 1e-5 * organ.volume);
    const Box bounds = boundsOf(mesh.vertices);
    EXPECT_NEAR((bounds.max() - bounds.min() - organ.size).norm(), 0.0, 0.001);
    EXPECT_NEAR((bounds.max() + bounds.min()).norm(), 0.0, 1e-6);
    EXPECT_EQ(2 * mesh.vertices.size(), mesh.triangles.size() + 4);  // like a ball, no handles
    double filled = 0.0;
    for (const double share : sliced(mesh, gridAround(mesh, 0.005)).filled) filled += share;
    EXPECT_NEAR(filled * 0.005 * 0.005 * 0.005 / volumeOf(mesh), 1.0, 1e-6);
  }
}

TEST(MeshShape, EntriesThatAreNotAllowed) {
  writeFile("box.stl", stlText(boxMesh(kBoxMin, kBoxMax)));
  expectRefusal(refusal("resource: box.stl, min: [0, 0, 0]"), {"shape.min = [0, 0, 0]", "unknown"});
  expectRefusal(refusal("scale: 1"), {"tissue.shape.resource is missing", "package://"});
  expectRefusal(refusal("resource: [a]"), {"tissue.shape.resource = [a]", "a path"});
  expectRefusal(refusal("resource: none.stl"),
                {"tissue.shape.resource = none.stl", "must be an existing file", meshFolder()});
  expectRefusal(refusal("resource: box.stl", ""), {"a relative path has no start"});
  expectRefusal(refusal("resource: 'http://localhost/box.stl'"), {"must be package://"});
  expectRefusal(refusal("resource: package://no_such_package/box.stl"),
                {"tissue.shape.resource = package://no_such_package/box.stl: cannot be loaded (no ",
                 "package no_such_package", "STL, OBJ or DAE"});
  expectRefusal(refusal("resource: package://no_such_package"), {"names a package, but no file"});
  for (const char* scale : {"0", "-0.001", ".nan", "large", "{}", "[1, 1, 0]"}) {
    expectRefusal(refusal(std::string("resource: box.stl, scale: ") + scale),
                  {"tissue.shape.scale", "a number from 1e-09 to 1e+09"});
  }
}

TEST(MeshShape, FileThatIsNoMeshIsRefused) {
  for (const char* name : {"bad.stl", "bad.obj", "bad.dae", "bad.txt"}) {
    for (const char* text : {"", "no mesh at all"}) {
      writeFile(name, text);
      const std::string message = refusal(std::string("resource: ") + name);
      expectRefusal(message, {std::string("tissue.shape.resource = ") + name, "cannot be loaded",
                              "must be a mesh file: STL, OBJ or DAE, up to 100 MB"});
    }
  }
}

TEST(MeshShape, MeshWithoutAnInsideIsRefused) {
  TriangleMesh open = boxMesh(kBoxMin, kBoxMax);
  open.triangles.pop_back();
  expectMeshRefused(open, "is not closed: 3 edges with one triangle or more than two");
  TriangleMesh turned = boxMesh(kBoxMin, kBoxMax);
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  expectMeshRefused(turned, "has 3 edges whose two triangles face opposite sides");
  expectMeshRefused(turned, "its triangles all facing outwards or all inwards");
  expectMeshRefused(boxMesh(kBoxMin, Vec3(kBoxMax.x(), kBoxMax.y(), kBoxMin.z())), "has no volume");
  const TriangleMesh crossing =
      joined(boxMesh(kBoxMin, kBoxMax), moved(boxMesh(kBoxMin, kBoxMax), Vec3(0.05, 0.01, 0.01)));
  expectMeshRefused(crossing, "intersects itself: ");
}

TEST(MeshShape, CoordinatesOutOfReachAreRefused) {
  TriangleMesh box = boxMesh(kBoxMin, kBoxMax);
  box.vertices[0].x() = 1e30;
  writeFile("huge.stl", stlText(box));
  expectRefusal(refusal("resource: huge.stl"), {"huge.stl", "not finite or beyond 1e+15 m"});
  box.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  writeFile("nan.obj", objText(box));
  expectRefusal(refusal("resource: nan.obj"), {"nan.obj", "not finite or beyond 1e+15 m"});
}

TEST(MeshShape, SpacingIsAtMostTheSmallestExtent) {
  const TriangleMesh box = boxMesh(kBoxMin, kBoxMax);
  const auto spacing = [](const std::string& text) {
    return Entry(YAML::Load(text), "tissue.spacing", "scene.yaml");
  };
  EXPECT_NO_THROW(requireSpacingWithin(spacing("0.0499"), box));
  try {
    requireSpacingWithin(spacing("0.0501"), box);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    expectRefusal(error.what(), {"tissue.spacing = 0.0501", "smallest extent, 0.05 m"});
  }
  EXPECT_THROW(requireSpacingWithin(spacing("-1"), box), InputError);
}

}  // namespace
}  // namespace robot_tissue::test_mesh_shape
