// The scenes of README.md and of doc/recipes.md that have steps run, and all their increments are
// OK.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "documents.h"
#include "simulate_program.h"

namespace robot_tissue::test_recipes {
namespace {

class Recipes : public Simulate {
 protected:
  // Runs the scenes of a document, and returns how many there are.
  int runAll(const fs::path& document) {
    int count = 0;
    for (const std::string& recipe : documentExamples(document.string(), "yaml")) {
      if (recipe.find("\nsteps:") == std::string::npos) continue;  // the node's
      const std::string name = "recipe" + std::to_string(++count);
      write(name + ".yaml", recipe);
      const Outcome outcome = program(name + ".yaml --out " + name);
      EXPECT_EQ(outcome.code, 0) << outcome.err << recipe;
      EXPECT_EQ(outcome.err, "") << recipe;
    }
    return count;
  }

  const fs::path source_ = ROBOT_TISSUE_SOURCE_DIR;
};

TEST_F(Recipes, Run) {
  fs::create_directory_symlink(source_ / "config/meshes", folder_ / "meshes");
  EXPECT_GE(runAll(source_ / "doc/recipes.md"), 5);
}

TEST_F(Recipes, FirstSceneOfTheReadmeRuns) { EXPECT_EQ(runAll(source_ / "README.md"), 1); }

}  // namespace
}  // namespace robot_tissue::test_recipes
