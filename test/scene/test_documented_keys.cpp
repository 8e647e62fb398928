// doc/scene.md has every key of a scene and no other, and its examples are scenes.
//
// What the parser knows is asked of the parser: a key that no map has is put into each map of the
// examples in turn, and the refusal lists what is allowed there. Each key has to be in an example,
// so that no map stays unasked; maps that are the last on their paths by one name have the same
// keys.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "documents.h"
#include "scene_texts.h"

namespace robot_tissue::test_documented_keys {
namespace {

using Keys = std::set<std::string>;  // full paths, "[]" for any entry of a list

const std::string kDocument = std::string(ROBOT_TISSUE_SOURCE_DIR) + "/doc/scene.md";
const std::string kNoKey = "no_such_key_anywhere";

std::string joinedPath(const std::string& place, const std::string& key) {
  return place.empty() ? key : place + "." + key;
}

Keys documentedKeys() {
  Keys keys;
  for (const DocumentedWord& documented : documentedWords(kDocument, "key")) {
    if (documented.places.empty()) keys.insert(documented.word);
    for (const std::string& place : documented.places) {
      keys.insert(joinedPath(place, documented.word));
    }
  }
  return keys;
}

// `over` in place of what `under` has: maps key by key, all else as a whole.
YAML::Node merged(const YAML::Node& under, const YAML::Node& over) {
  if (!under.IsDefined() || !under.IsMap() || !over.IsMap()) return YAML::Clone(over);
  YAML::Node both = YAML::Clone(under);
  for (const auto& item : over) {
    const std::string key = item.first.Scalar();
    both[key] = merged(under[key], item.second);
  }
  return both;
}

// Examples with a shape are whole scenes, the others are added to the first.
std::vector<YAML::Node> documentedScenes() {
  std::vector<YAML::Node> scenes;
  for (const std::string& text : documentExamples(kDocument, "yaml")) {
    const YAML::Node example = YAML::Load(text);
    const bool whole = example["tissue"] && example["tissue"]["shape"];
    scenes.push_back(whole ? example : merged(scenes.at(0), example));
  }
  return scenes;
}

// The refusal of a scene, empty when it is accepted.
std::string refusal(const YAML::Node& scene) {
  SceneSource source;
  source.name = "example";
  source.folder = std::string(ROBOT_TISSUE_SOURCE_DIR) + "/config";
  try {
    parseScene(scene, source);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// "... must be one of a, b" -> a, b. Empty where any key is allowed, or none.
std::vector<std::string> allowedKeys(const std::string& message) {
  std::vector<std::string> keys;
  for (const std::string lead : {"must be one of ", "exactly one key of "}) {
    const std::size_t at = message.find(lead);
    if (at == std::string::npos) continue;
    std::istringstream list(message.substr(at + lead.size()));
    for (std::string key; std::getline(list >> std::ws, key, ',');) keys.push_back(key);
    break;
  }
  return keys;
}

// "tools[].links[].shapes[].radius" -> "shapes[].radius"
std::string lastTwo(const std::string& path) {
  const std::size_t last = path.rfind('.');
  const std::size_t before = last == std::string::npos ? last : path.rfind('.', last - 1);
  return before == std::string::npos ? path : path.substr(before + 1);
}

Keys lastTwo(const Keys& paths) {
  Keys ends;
  for (const std::string& path : paths) ends.insert(lastTwo(path));
  return ends;
}

struct Asked {
  Keys known;  // by the parser
  Keys used;   // by the examples
};

// Asks the parser in every map of `node`, a part of `scene` that stands at `place`.
void ask(const YAML::Node& scene, YAML::Node node, const std::string& place, Asked& asked) {
  if (node.IsSequence()) {
    for (YAML::Node entry : node) ask(scene, entry, place + "[]", asked);
  }
  if (!node.IsMap()) return;
  node[kNoKey] = 1;
  const std::vector<std::string> allowed = allowedKeys(refusal(scene));
  node.remove(kNoKey);
  for (const std::string& key : allowed) asked.known.insert(joinedPath(place, key));
  for (const auto& item : node) {
    const std::string path = joinedPath(place, item.first.Scalar());
    if (!allowed.empty()) asked.used.insert(path);
    ask(scene, item.second, path, asked);
  }
}

Asked askAll() {
  Asked asked;
  for (const YAML::Node& scene : documentedScenes()) ask(scene, scene, "", asked);
  return asked;
}

Keys without(const Keys& all, const Keys& those) {
  Keys rest;
  std::set_difference(all.begin(), all.end(), those.begin(), those.end(),
                      std::inserter(rest, rest.end()));
  return rest;
}

TEST(DocumentedKeys, ExamplesAreScenes) {
  const std::vector<YAML::Node> scenes = documentedScenes();
  ASSERT_GT(scenes.size(), 1U);
  for (const YAML::Node& scene : scenes) {
    EXPECT_EQ(refusal(scene), "") << YAML::Dump(scene);
  }
}

TEST(DocumentedKeys, AreThoseThatTheParserKnows) {
  const Asked asked = askAll();
  const Keys documented = documentedKeys();
  ASSERT_GT(asked.known.size(), 50U);
  EXPECT_EQ(without(asked.known, documented), Keys()) << "known, but in no table of doc/scene.md";
  EXPECT_EQ(without(documented, asked.known), Keys()) << "in a table of doc/scene.md, but unknown";
  EXPECT_EQ(without(lastTwo(asked.known), lastTwo(asked.used)), Keys())
      << "in no example of doc/scene.md";
}

}  // namespace
}  // namespace robot_tissue::test_documented_keys
