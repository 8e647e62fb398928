// A key, and a role, is known, read and named in refusals once its table has it.
#include <gtest/gtest.h>

#include <string>

#include "robot_tissue/scene/key_table.h"
#include "scene_texts.h"

namespace robot_tissue::test_key_table {
namespace {

struct Reading {
  double width = 0.0;
  double height = 0.0;
  std::string kind;
};

const Range kAny{0.0, 10.0, "m"};

const KeyTable<Reading> kKeys = {
    {"type"},
    {"width", [](const Entry& entry, Reading& reading) { reading.width = entry.number(kAny); }},
    {"height",
     [](const Entry& entry, Reading& reading) {
       reading.height = entry.numberOr(2.0 * reading.width, kAny);
     }},
};

const std::vector<MapType<Reading>> kTypes = {
    {"plain", {}, [](const MapReader&, Reading& reading) { reading.kind = "plain"; }},
    {"named",
     {{"name", [](const Entry& entry, Reading& reading) { reading.kind = entry.word("a name"); }}}},
};

Entry entryOf(const std::string& text) { return Entry(YAML::Load(text), "door", "scene.yaml"); }

Reading read(const std::string& text) {
  Reading reading;
  readTyped(entryOf(text), kKeys, kTypes, reading);
  return reading;
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(KeyTable, ReadsItsKeysInTheirOrder) {
  EXPECT_EQ(read("{height: 3, width: 2, type: plain}").height, 3.0);
  EXPECT_EQ(read("{width: 2, type: plain}").height, 4.0);
  EXPECT_EQ(read("{width: 2, type: plain}").kind, "plain");
  EXPECT_EQ(read("{width: 2, type: named, name: oak}").kind, "oak");
}

TEST(KeyTable, NamesItsKeysWhereOneIsUnknown) {
  EXPECT_NE(refusal("{width: 2, type: plain, widht: 1}").find("did you mean width?"),
            std::string::npos);
  const std::string of_other_type = refusal("{width: 2, type: plain, name: oak}");
  EXPECT_NE(of_other_type.find("must be one of type, width, height"), std::string::npos)
      << of_other_type;
  const std::string no_type = refusal("{width: 2, type: iron}");
  EXPECT_NE(no_type.find("must be one of plain, named"), std::string::npos) << no_type;
}

TEST(ToolRoles, EveryOneOfTheTableIsRead) {
  const std::string jaws =
      "[{shapes: [{type: sphere, radius: 0.003}]},"
      " {shapes: [{type: sphere, radius: 0.003}]}]";
  for (const ToolRole& role : toolRoles()) {
    const std::string line = "[[0, 0, 0], [0, 0, 0.02]]";
    const std::string edge = role.has_edge ? "edge: " + line + ", "
                             : role.shears ? "edges: [" + line + ", " + line + "], "
                                           : "";
    const std::string own =
        edge + (role.has_jaws ? "jaws: " + jaws : "shapes: [{type: sphere, radius: 0.003}]");
    const std::string text =
        "tissue:\n  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}\n  spacing: 0.01\n"
        "  material: {young_modulus: 1000}\n"
        "tools: [{name: probe, role: " +
        role.name + ", " + own + "}]\n";
    const Scene scene = parseText(text, SceneUser::kRunner);
    EXPECT_EQ(scene.tools.at(0).role.name, role.name);
    EXPECT_EQ(scene.tools.at(0).links.size(), role.has_jaws ? 3U : 1U);
  }
}

}  // namespace
}  // namespace robot_tissue::test_key_table
