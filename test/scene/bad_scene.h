// A place of a good scene made bad, and what the refusal must say.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "scene_texts.h"

namespace robot_tissue {

struct BadScene {
  std::string name;
  std::string from;  // this place of the good scene ...
  std::string to;    // ... becomes this
  std::vector<std::string> fragments;
};

inline void PrintTo(const BadScene& bad, std::ostream* out) { *out << bad.name; }

inline std::string caseName(const ::testing::TestParamInfo<BadScene>& info) {
  return info.param.name;
}

// One line that names file, key's path, value and what is allowed.
inline void expectRefusal(const std::string& good_scene, SceneUser user, const BadScene& bad) {
  ASSERT_EQ(refusal(good_scene, user), "") << "the scene to start from is refused itself";
  const std::string text = replaced(good_scene, bad.from, bad.to);
  ASSERT_NE(text, "") << "the scene has no place '" << bad.from << "'";
  const std::string message = refusal(text, user);
  EXPECT_EQ(message.rfind("block.yaml:", 0), 0U) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_LT(message.size(), 400U) << message;
  for (const std::string& fragment : bad.fragments) {
    EXPECT_NE(message.find(fragment), std::string::npos)
        << "'" << fragment << "' is not in: " << message;
  }
}

}  // namespace robot_tissue
