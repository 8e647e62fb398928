// The recipes that the runner takes (doc/recipes.md) run, and all their increments are OK.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "documents.h"
#include "simulate_program.h"

namespace robot_tissue {
namespace {

TEST_F(Simulate, RunsTheRecipes) {
  const fs::path source = ROBOT_TISSUE_SOURCE_DIR;
  fs::create_directory_symlink(source / "config/meshes", folder_ / "meshes");
  int run = 0;
  for (const std::string& recipe : documentExamples((source / "doc/recipes.md").string(), "yaml")) {
    if (recipe.find("\nsteps:") == std::string::npos) continue;  // the node's
    const std::string name = "recipe" + std::to_string(++run);
    write(name + ".yaml", recipe);
    const Outcome outcome = program(name + ".yaml --out " + name);
    EXPECT_EQ(outcome.code, 0) << outcome.err << recipe;
    EXPECT_EQ(outcome.err, "") << recipe;
  }
  EXPECT_GE(run, 5);
}

}  // namespace
}  // namespace robot_tissue
