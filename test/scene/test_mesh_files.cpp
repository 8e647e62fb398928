// Mesh files of users: other formats, broken ones, and what is no file at all. Each ends in one
// line, and none of them ends the program.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <cstdint>
#include <cstring>
#include <random>

#include "../core/mesh_fixtures.h"
#include "mesh_files.h"
#include "robot_tissue/mesh/mesh_file.h"
#include "robot_tissue/scene/readers.h"

namespace robot_tissue::test_mesh_files {
namespace {

namespace fs = std::filesystem;

std::string path(const std::string& name) { return meshFolder() + "/" + name; }

TriangleMesh load(const std::string& name) {
  return loadMeshFile("file://" + path(name), Vec3::Ones());
}

// Of the loader; empty when the file is taken.
std::string refusal(const std::string& address) {
  try {
    loadMeshFile(address, Vec3::Ones());
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

void expectRefused(const std::string& name, const std::string& fragment) {
  const std::string message = refusal("file://" + path(name));
  EXPECT_NE(message.find(fragment), std::string::npos) << name << ": " << message;
}

TriangleMesh box() { return boxMesh(Vec3(0.0, 0.0, 0.0), Vec3(0.1, 0.2, 0.3)); }

std::string binaryStl(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  const auto add = [&bytes](std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
  };
  add(static_cast<std::uint32_t>(mesh.triangles.size()), 4);
  for (const MeshTriangle& triangle : mesh.triangles) {
    bytes.append(12, '\0');
    for (const int corner : triangle) {
      for (const double coordinate : mesh.vertices[at(corner)]) {
        const auto value = static_cast<float>(coordinate);
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof(bits));
        add(bits, 4);
      }
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

// A scene of nodes in nodes, with a polygon that is not convex in place of triangles.
const std::string kPlacedDae = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="15">0 0 0  2 0 0  2 2 0  1 0.5 0  0 2 0</float_array>
<technique_common><accessor source="#a" count="5" stride="3"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="NORMAL" source="#p" offset="1"/>
<input semantic="VERTEX" source="#v" offset="0"/><vcount>5</vcount><p>0 0 1 0 2 0 3 0 4 0</p>
</polylist></mesh></geometry></library_geometries>
<library_nodes><node id="twice"><scale>2 2 2</scale><instance_geometry url="#g"/></node></library_nodes>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>1 0 0</translate>
<node><rotate>0 0 1 90</rotate><instance_geometry url="#g"/></node>
<node><matrix>1 0 0 0  0 1 0 0  0 0 1 5  0 0 0 1</matrix><instance_node url="#twice"/></node>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";

double areaOf(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const MeshTriangle& t : mesh.triangles) area += 0.5 * doubleArea(mesh.vertices, t).norm();
  return area;
}

TEST(MeshFiles, BinaryStlIsTakenAndMustBeAsLongAsItsCountSays) {
  const std::string bytes = binaryStl(box());
  writeFile("binary.stl", bytes);
  EXPECT_EQ(load("binary.stl").triangles.size(), 12U);
  EXPECT_NEAR(volumeOf(welded(load("binary.stl"))), 0.006, 1e-9);
  for (const std::string& text :
       {bytes.substr(0, bytes.size() - 1), bytes + " ", bytes.substr(0, 84)}) {
    writeFile("binary.stl", text);
    expectRefused("binary.stl", "is neither a binary STL, whose size is that of its triangles");
  }
}

TEST(MeshFiles, AByteOrderMarkBeforeATextIsPassedOver) {
  const std::string mark = "\xEF\xBB\xBF";
  writeFile("mark.stl", mark + stlText(box()));
  EXPECT_EQ(load("mark.stl").triangles.size(), 12U);
  writeFile("mark.obj", mark + objText(box()));
  EXPECT_EQ(load("mark.obj").triangles.size(), 12U);
  writeFile("mark.obj", mark + mark + objText(box()));
  expectRefused("mark.obj", "line 1: begins with no word of an OBJ file");
}

TEST(MeshFiles, ContentOfAnotherFormatThanTheNameIsRefused) {
  for (const char* name : {"binary.obj", "binary.dae", "binary.STL.obj"}) {
    writeFile(name, binaryStl(box()));
    expectRefused(name, "cannot be loaded (");
  }
  writeFile("other.stl", objText(box()));
  expectRefused("other.stl", "'solid' is missing");
  writeFile("other.obj", stlText(box()));
  expectRefused("other.obj", "line 1: begins with no word of an OBJ file");
  writeFile("other.dae", "<svg/>");
  expectRefused("other.dae", "root is COLLADA");
}

TEST(MeshFiles, NamesOfOtherFormatsAreRefusedUnread) {
  writeFile("tri.ply", "ply\nformat ascii 1.0\nelement vertex 3\nend_header\n0 0 0\n");
  writeFile("tri.glb", "glTF");
  writeFile("tri", stlText(box()));
  for (const char* name : {"tri.ply", "tri.glb", "tri"}) {
    expectRefused(name, "its name ends neither in .stl nor .obj nor .dae");
  }
  writeFile("box.STL", stlText(box()));
  EXPECT_EQ(load("box.STL").triangles.size(), 12U);
}

TEST(MeshFiles, AnAddressSpellsBytesAndAPathDoesNot) {
  fs::create_directories(path("my tools"));
  writeFile("my tools/box 1.stl", stlText(box()));
  EXPECT_EQ(refusal("file://" + path("my%20tools/box%201.stl")), "");
  EXPECT_EQ(refusal("file://" + path("my tools/box 1.stl")), "");
  writeFile("100% %20.stl", stlText(box()));
  const std::string address = fileAddressOf(path("100% %20.stl"));
  EXPECT_EQ(refusal(address), "");
  EXPECT_EQ(pathOfFileAddress(address), path("100% %20.stl"));
  EXPECT_NE(refusal("file://" + path("box%00.stl")), "");
  EXPECT_NE(refusal("package://robot_tissue/%2e%2e/%2e%2e/box.stl").find("leaves the package"),
            std::string::npos);
}

TEST(MeshFiles, ADaeFileInOtherUnitsOrAxesIsRemarkedOn) {
  const auto remark = [](const std::string& up_axis, double unit, double scale) {
    writeFile("asset.dae", daeText(box(), up_axis, unit));
    std::string told;
    loadMeshFile("file://" + path("asset.dae"), Vec3::Constant(scale), &told);
    return told;
  };
  EXPECT_EQ(remark("Z_UP", 1.0, 1.0), "");
  EXPECT_EQ(remark("Z_UP", 1.0, 0.3), "") << "meters need no heed, however they are scaled";
  EXPECT_EQ(remark("Z_UP", 0.001, 0.001), "");
  for (const std::string& text :
       {remark("Z_UP", 0.001, 1.0), remark("Y_UP", 1.0, 1.0), remark("Y_UP", 0.001, 0.001)}) {
    EXPECT_NE(text.find("the unit "), std::string::npos) << text;
    EXPECT_NE(text.find("_UP"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
  EXPECT_NE(remark("Y_UP", 0.0254, 1.0).find("unit 0.0254 m and the up axis Y_UP"),
            std::string::npos);
}

TEST(MeshFiles, OnlyRegularFilesAndLinksToThemAreRead) {
  for (const char* name : {"pipe.stl", "zero.stl", "linked.stl", "away.stl"})
    fs::remove(path(name));
  ASSERT_EQ(mkfifo(path("pipe.stl").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", path("zero.stl"));
  fs::create_symlink("nowhere.stl", path("away.stl"));
  fs::create_directories(path("folder.stl"));
  writeFile("box.stl", stlText(box()));
  fs::create_symlink(path("box.stl"), path("linked.stl"));
  expectRefused("pipe.stl", "is a pipe or a device");
  expectRefused("zero.stl", "is a pipe or a device");
  expectRefused("folder.stl", "is a folder");
  expectRefused("away.stl", "No such file");
  EXPECT_EQ(load("linked.stl").triangles.size(), 12U);
  for (const char* name : {"pipe.stl", "zero.stl", "folder.stl"}) {
    const Entry entry(YAML::Node(name), "tissue.shape.resource", "scene.yaml");
    EXPECT_THROW(readResource(entry, meshFolder()), InputError) << name;
  }
}

TEST(MeshFiles, EmptyFilesAndPackagesWithoutAFileAreRefused) {
  for (const char* name : {"empty.stl", "empty.obj", "empty.dae"}) {
    writeFile(name, "");
    expectRefused(name, "is empty");
  }
  EXPECT_NE(refusal("package://robot_tissue").find("names a package, but no file of it"),
            std::string::npos);
}

// Of a name in a file: any bytes, and any number of them.
TEST(MeshFiles, WhatAFileSaysStaysOnOneShortLine) {
  std::string dae = daeText(box(), "Z_UP", 1.0);
  const std::size_t place = dae.find("<mesh>");
  ASSERT_NE(place, std::string::npos);
  dae.insert(place, "<\xf6\x1b" + std::string(5000, 'x') + ">");
  writeFile("named.dae", dae);
  const std::string message = refusal("file://" + path("named.dae"));
  EXPECT_NE(message.find("is no XML"), std::string::npos) << message;
  EXPECT_LT(message.size(), 400U);
  for (const char c : message) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << message;
}

TEST(MeshFiles, LargeFilesAreRefusedWithTheLimit) {
  writeFile("large.stl", "solid");
  fs::resize_file(path("large.stl"), kLargestMeshFile + 1);
  expectRefused("large.stl", "has more than 100 MB");
}

// A few bytes a triangle: many more than the files' own limit allows in other formats.
TEST(MeshFiles, TooManyTrianglesAreRefusedWithTheLimit) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i <= 2000000; ++i) text += "f 1 2 3\n";
  writeFile("many.obj", text);
  expectRefused("many.obj", "has more than 2000000 triangles");
  fs::remove(path("many.obj"));
}

TEST(MeshFiles, AddressOfAPackageDoesNotLeaveIt) {
  fs::create_directories(path("soft_parts/meshes"));
  writeFile("soft_parts/package.xml", "<package><name>soft_parts</name></package>");
  writeFile("soft_parts/meshes/box.stl", stlText(box()));
  writeFile("outside.stl", stlText(box()));
  const char* search_path = getenv("ROS_PACKAGE_PATH");
  const std::string before = search_path != nullptr ? search_path : "";
  setenv("ROS_PACKAGE_PATH", meshFolder().c_str(), 1);
  EXPECT_EQ(refusal("package://soft_parts/meshes/box.stl"), "");
  EXPECT_EQ(refusal("package://soft_parts/meshes/../meshes/box.stl"), "");
  for (const char* inner : {"../outside.stl", "meshes/../../outside.stl", "../../etc/passwd"}) {
    const std::string message = refusal(std::string("package://soft_parts/") + inner);
    EXPECT_NE(message.find("its path leaves the package"), std::string::npos) << message;
  }
  setenv("ROS_PACKAGE_PATH", before.c_str(), 1);
}

TEST(MeshFiles, DaePlacesGeometriesByTheirNodes) {
  writeFile("placed.dae", kPlacedDae);
  const TriangleMesh mesh = load("placed.dae");
  EXPECT_EQ(mesh.triangles.size(), 6U);
  EXPECT_NEAR(areaOf(mesh), 2.5 * (1.0 + 4.0), 1e-12);  // the notch is not filled
  const Box bounds = boundsOf(mesh.vertices);
  EXPECT_NEAR((bounds.min() - Vec3(-1.0, 0.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((bounds.max() - Vec3(5.0, 4.0, 5.0)).norm(), 0.0, 1e-12);
}

TEST(MeshFiles, ObjHasPolygonsIndicesFromTheEndAndLinesThatGoOn) {
  writeFile("free.obj",
            "# made\nmtllib none.mtl\no part\nv 0 0 0\nv +2 0 0 1.0\nv 2 2 0\nv 1 5e-1 0\nv 0 2 0\n"
            "vn 0 0 1\nusemtl red\nf 1//1 2//1 \\\n 3//1 4//1 5//1\nf -5/1 -4/2 -3/3\nl 1 2\n");
  const TriangleMesh mesh = load("free.obj");
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_NEAR(areaOf(mesh), 2.5 + 2.0, 1e-12);
  for (const char* face : {"f 1 2 4", "f 0 1 2", "f -4 1 2", "f 1 2 x", "f 1 2 99999999999"}) {
    writeFile("bad.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\n") + face + "\n");
    expectRefused("bad.obj", "line 4: ");
  }
}

TEST(MeshFiles, BrokenDaeIsRefused) {
  const struct {
    const char* from;
    const char* to;
    const char* fragment;
  } cases[] = {
      {"count=\"5\" stride", "count=\"6\" stride", "reaches beyond its 15 numbers"},
      {"stride=\"3\"", "stride=\"0\"", "reaches beyond"},
      {"stride=\"3\"", "stride=\"-3\"", "reaches beyond"},
      {"count=\"5\" stride", "count=\"2000000000\" stride", "reaches beyond"},
      {"3 0 4 0</p>", "3 0 5 0</p>", "vertex 5 of 5"},
      {"3 0 4 0</p>", "3 0 4</p>", "ends within a corner"},
      {"<vcount>5", "<vcount>6", "beyond its <p>"},
      {"offset=\"1\"", "offset=\"1000000000\"", "offset 1000000000"},
      {"semantic=\"VERTEX\"", "semantic=\"TEXCOORD\"", "without the input VERTEX"},
      {"<scale>2 2 2</scale>", "<instance_node url=\"#twice\"/>", "within itself"},
      {"<scale>2 2 2</scale>", "<scale>2 2</scale>", "should"},
      {"<scale>2 2 2</scale>", "<skew>45 0 1 0 1 0 0</skew>", "lookat or skew"},
      {"url=\"#g\"", "url=\"#h\"", "has no <geometry> 'h'"},
      {"url=\"#g\"", "url=\"other.dae#g\"", "not in the file"},
      {"url=\"#s\"", "url=\"#t\"", "has no <visual_scene> 't'"},
      {"<scene>", "<scenes>", "is no XML"},
  };
  for (const auto& bad : cases) {
    std::string text = kPlacedDae;
    const std::size_t place = text.find(bad.from);
    ASSERT_NE(place, std::string::npos) << bad.from;
    writeFile("bad.dae", text.replace(place, std::string(bad.from).size(), bad.to));
    expectRefused("bad.dae", bad.fragment);
  }
}

TEST(MeshFiles, DeepDaeIsRefused) {
  std::string text = "<COLLADA>";
  for (int i = 0; i < 100000; ++i) text += "<node>";
  writeFile("deep.dae", text);
  expectRefused("deep.dae", "is no XML");
}

// Each node places the next one: flat in the file, deep where they stand.
std::string chainOfNodes(int length) {
  std::string text = kPlacedDae;
  const std::string library = "<library_nodes>";
  std::string nodes;
  for (int i = 0; i < length; ++i) {
    const std::string next = i + 1 < length ? "n" + std::to_string(i + 1) : "twice";
    nodes +=
        "<node id=\"n" + std::to_string(i) + "\"><instance_node url=\"#" + next + "\"/></node>";
  }
  text.insert(text.find(library) + library.size(), nodes);
  const std::string link = "<instance_node url=\"#twice\"/></node>\n</node>";
  return text.replace(text.find(link), link.size(), "<instance_node url=\"#n0\"/></node></node>");
}

TEST(MeshFiles, DaeWhoseNodesPlaceOneAnotherInAChainIsReadUpToADepth) {
  writeFile("chain.dae", chainOfNodes(400));
  EXPECT_EQ(load("chain.dae").triangles.size(), 6U);
  writeFile("chain.dae", chainOfNodes(30000));
  expectRefused("chain.dae", "has more than 500 nodes in one another");
}

// Nodes that place nodes that place nodes: 2^30 geometries in a few lines.
TEST(MeshFiles, DaeThatPlacesTooMuchIsRefused) {
  std::string nodes;
  for (int i = 1; i <= 30; ++i) {
    const std::string below = "<instance_node url=\"#n" + std::to_string(i - 1) + "\"/>";
    nodes += "<node id=\"n" + std::to_string(i) + "\">" + below + below + "</node>";
  }
  std::string text = kPlacedDae;
  const std::string link = "<instance_node url=\"#twice\"/>";
  text.replace(text.find(link), link.size(), "<instance_node url=\"#n30\"/>");
  const std::string library = "<library_nodes>";
  text.insert(text.find(library) + library.size(),
              "<node id=\"n0\"><instance_geometry url=\"#g\"/></node>" + nodes);
  writeFile("bomb.dae", text);
  expectRefused("bomb.dae", "more than 100000 nodes");
}

std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&random](std::size_t bound) {
    return bound == 0 ? 0 : static_cast<std::size_t>(random()) % bound;
  };
  static const std::vector<std::string> kWords = {
      "-1", "4294967295", "99999999999999999999", "nan", "1e999", "#g", "\"", "<node>", "/>", " "};
  for (std::size_t i = 1 + below(4); i-- > 0 && !text.empty();) {
    const std::size_t place = below(text.size());
    const std::string part = text.substr(place, below(80));
    switch (below(6)) {
      case 0:
        text.resize(place);
        break;
      case 1:
        text[place] = static_cast<char>(random());
        break;
      case 2:
        text.erase(place, below(40));
        break;
      case 3:
        text.insert(below(text.size()), part);
        break;
      case 4:
        text.insert(place, kWords[below(kWords.size())]);
        break;
      default:
        text.replace(place, below(6), kWords[below(kWords.size())]);
    }
  }
  return text;
}

// Taken or refused in one line; a crash or a hang would end the test itself.
TEST(MeshFiles, CorruptedFilesAreReadSafely) {
  std::mt19937 random(16);
  const std::vector<std::pair<std::string, std::string>> seeds = {
      {"m.stl", stlText(box())},
      {"m.stl", binaryStl(box())},
      {"m.obj", objText(box())},
      {"m.dae", daeText(box(), "Z_UP", 1.0)},
      {"m.dae", kPlacedDae}};
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    for (const auto& [name, text] : seeds) {
      writeFile(name, mutated(text, random));
      const std::string message = refusal("file://" + path(name));
      if (message.empty()) {
        for (const MeshTriangle& t : load(name).triangles) {
          for (const int corner : t) ASSERT_LT(at(corner), load(name).vertices.size());
        }
      }
      EXPECT_LT(message.size(), 300U) << message;
      refused += message.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace robot_tissue::test_mesh_files
