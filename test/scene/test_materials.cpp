// Laws and materials by name.
#include <gtest/gtest.h>

#include "bad_scene.h"
#include "material_presets.h"
#include "scene_texts.h"

namespace robot_tissue::test_materials {
namespace {

std::string withMaterial(const std::string& material, const std::string& region = "") {
  const std::string regions =
      region.empty() ? ""
                     : "  regions: [{min: [0, 0, 0], max: [0.05, 0.05, 0.05], " + region + "}]\n";
  return "tissue:\n"
         "  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}\n"
         "  spacing: 0.01\n"
         "  material: {" +
         material + "}\n" + regions;
}

Scene parsed(const std::string& material, const std::string& region = "") {
  return parseText(withMaterial(material, region), SceneUser::kRunner);
}

TEST(Materials, LawIsNeoHookeanUnlessTold) {
  EXPECT_EQ(parsed("young_modulus: 1000").tissue.material.law, Material::Law::kNeoHookean);
  const Material fung = parsed("young_modulus: 1000, law: fung, stiffening: 7").tissue.material;
  EXPECT_EQ(fung.law, Material::Law::kFung);
  EXPECT_EQ(fung.stiffening, 7.0);
  EXPECT_EQ(parsed("young_modulus: 1000, law: fung").tissue.material.stiffening, 0.0);
}

TEST(Materials, RegionsInheritTheLawAndMayHaveAnother) {
  const std::string fung = "young_modulus: 1000, law: fung, stiffening: 7";
  const Material same = parsed(fung, "density: 900").tissue.regions[0].material;
  EXPECT_EQ(same.law, Material::Law::kFung);
  EXPECT_EQ(same.stiffening, 7.0);
  EXPECT_EQ(parsed(fung, "stiffening: 3").tissue.regions[0].material.stiffening, 3.0);
  EXPECT_EQ(parsed(fung, "law: neo_hookean").tissue.regions[0].material.law,
            Material::Law::kNeoHookean);
}

TEST(Materials, EveryPresetIsReadAndSaidWithItsSource) {
  ASSERT_EQ(materialPresets().size(), 6U);
  for (const MaterialPreset& preset : materialPresets()) {
    const Scene scene = parsed("preset: " + preset.name);
    EXPECT_EQ(scene.tissue.material.young_modulus, preset.material.young_modulus);
    EXPECT_EQ(scene.tissue.material.stiffening, preset.material.stiffening);
    EXPECT_GT(preset.material.young_modulus, 1000.0);
    ASSERT_EQ(scene.remarks.size(), 1U);
    EXPECT_NE(scene.remarks[0].find("tissue.material.preset = " + preset.name), std::string::npos);
    EXPECT_NE(scene.remarks[0].find(preset.source), std::string::npos);
    EXPECT_EQ(scene.remarks[0].find('\n'), std::string::npos);
  }
}

TEST(Materials, ARegionMayBeOfAPresetAndTear) {
  const Scene scene = parsed("young_modulus: 1000, tear_stretch: 2", "preset: brain");
  const Region& region = scene.tissue.regions[0];
  EXPECT_EQ(region.material.law, Material::Law::kFung);
  EXPECT_EQ(region.material.tear_stretch, 2.0);
  EXPECT_TRUE(region.own_modulus);
  EXPECT_EQ(scene.tissue.material.young_modulus, 1000.0);
}

TEST(Materials, SixSpringSaysThatItHasNoLaw) {
  const std::string text =
      withMaterial("young_modulus: 1000, law: fung, stiffening: 5") + "  model: six_spring\n";
  const Scene scene = parseText(text, SceneUser::kRunner);
  ASSERT_EQ(scene.remarks.size(), 1U);
  EXPECT_NE(scene.remarks[0].find("tissue.material.law = fung: ignored, model six_spring"),
            std::string::npos);
}

struct BadMaterial {
  std::string material;
  std::string region;
  std::vector<std::string> said;
};

TEST(Materials, WhatDoesNotGoTogetherIsRefusedInOneLine) {
  const std::vector<BadMaterial> all = {
      {"young_modulus: 1000, law: hooke", "", {"tissue.material.law = hooke", "neo_hookean, fung"}},
      {"young_modulus: 1000, stiffening: 3", "", {"stiffening = 3", "beside law: fung"}},
      {"young_modulus: 1000, law: neo_hookean, stiffening: 3", "", {"beside law: fung"}},
      {"young_modulus: 1000, law: fung, stiffening: -1", "", {"stiffening = -1", "0 to 1000"}},
      {"young_modulus: 1000, law: fung, stiffening: .nan", "", {"stiffening = .nan", "0 to 1000"}},
      {"preset: spleen", "", {"preset = spleen", "liver, kidney"}},
      {"preset: liver, young_modulus: 1000", "", {"preset = liver", "beside young_modulus"}},
      {"preset: liver, poisson_ratio: 0.4", "", {"beside poisson_ratio"}},
      {"preset: liver, density: 900", "", {"beside density"}},
      {"preset: liver, law: fung", "", {"beside law"}},
      {"preset: fat, stiffening: 1", "", {"beside stiffening"}},
      {"young_modulus: 1000", "stiffening: 2", {"tissue.regions[0].stiffening", "law: fung"}},
      {"young_modulus: 1000", "preset: fat, density: 3", {"regions[0].preset", "beside density"}},
      {"young_modulus: 0.001", "preset: silicone", {"regions[0].preset", "factor of 1000000"}},
  };
  for (const BadMaterial& bad : all) {
    try {
      parsed(bad.material, bad.region);
      ADD_FAILURE() << bad.material;
    } catch (const InputError& error) {
      const std::string line = error.what();
      EXPECT_EQ(line.find('\n'), std::string::npos);
      for (const std::string& part : bad.said) {
        EXPECT_NE(line.find(part), std::string::npos) << line;
      }
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_materials
