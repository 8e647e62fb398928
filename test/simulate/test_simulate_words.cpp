// The runner as a program: what it refuses, and what it says on the way.
#include <gtest/gtest.h>

#include "core/mesh_fixtures.h"
#include "scene/mesh_files.h"
#include "simulate.h"
#include "simulate_program.h"

namespace robot_tissue::test_simulate_words {
namespace {

TEST_F(Simulate, BadArgumentsAreRefusedInOneLineAndNothingIsWritten) {
  expectRefused("", "SCENE.yaml is missing");
  expectRefused("block.yaml", "--out is missing");
  expectRefused("--out out", "SCENE.yaml is missing");
  expectRefused("block.yaml --out", "--out: must be followed by a value");
  expectRefused("block.yaml --out=", "--out: must be followed by a value");
  expectRefused("block.yaml --out --quiet", "--out: must be followed by a value, not by --quiet");
  expectRefused("block.yaml other.yaml --out out", "\"other.yaml\"");
  expectRefused("block.yaml --out out --metod paper", "did you mean --method?");
  expectRefused("block.yaml --out out --quiet=1", "--quiet: must stand without a value");
  expectRefused("block.yaml --out out --out out", "--out: stands twice");
  expectRefused("block.yaml --out out --method magic",
                "--method = magic: must be one of layered, newton, paper, vbd, "
                "xpbd, explicit");
  expectRefused("block.yaml --out out --tolerance 1",
                "--tolerance = 1: must be a number from 1e-09 to 0.5");
  expectRefused("block.yaml --out out --tolerance=nan", "--tolerance = nan");
  expectRefused("block.yaml --out out --threads 0", "--threads = 0: must be a whole number");
  expectRefused("none.yaml --out out", "none.yaml: No such file");
}

TEST_F(Simulate, BadScenesAreRefusedAndOldResultsStay) {
  write("bad.yaml", kScene + "  - suture: {}\n");
  expectRefused("bad.yaml --out out", "bad.yaml:23: steps[6].suture");
  ASSERT_EQ(program("block.yaml --out kept").code, 0);
  const std::string nodes = readText(folder_ / "kept/nodes.csv");
  EXPECT_EQ(program("bad.yaml --out kept").code, 2);
  EXPECT_EQ(readText(folder_ / "kept/nodes.csv"), nodes);
  EXPECT_EQ(entries("kept"), kFiles);
}

TEST_F(Simulate, FoldersThatCannotBeWrittenAreRefused) {
  write("file", "");
  expectRefused("block.yaml --out file", "is no folder");
  expectRefused("block.yaml --out file/out", "is no folder");
  expectRefused("block.yaml --out /proc/none/out", "--out = /proc/none/out");
  fs::create_directories(folder_ / "odd/nodes.csv");
  expectRefused("block.yaml --out odd", "is no plain file");
  EXPECT_EQ(entries("odd"), std::vector<std::string>({"nodes.csv"}));
}

TEST_F(Simulate, ResultsAreNotWrittenOverWhatTheSceneIsReadFrom) {
  const std::string saving = kScene + "  - save: {file: block.yaml}\n";
  write("block.yaml", saving);
  expectRefused("block.yaml --out .", "block.yaml would be written over block.yaml");
  EXPECT_EQ(readText(folder_ / "block.yaml"), saving);
  write("surface.stl", stlText(boxMesh(Vec3::Zero(), Vec3(0.04, 0.03, 0.02))));
  write("block.yaml",
        "tissue:\n  shape: {type: mesh, resource: surface.stl}\n  spacing: 0.01\n"
        "  material: {young_modulus: 10000.0}\nsteps: [{settle: {}}]\n");
  expectRefused("block.yaml --out .", "surface.stl would be written over");
  EXPECT_EQ(entries("."),
            std::vector<std::string>({"block.yaml", "stderr.txt", "stdout.txt", "surface.stl"}));
  EXPECT_EQ(program("block.yaml --out other").code, 0) << readText(folder_ / "stderr.txt");
}

TEST_F(Simulate, AFolderThatIsGoneIsNoFailureOfTheProgram) {
  const std::string gone = (folder_ / "gone").string(), err = (folder_ / "err.txt").string();
  fs::create_directory(gone);
  const std::string command = "cd '" + gone + "' && rmdir '" + gone + "' && '" + SIMULATE_PATH +
                              "' block.yaml --out out 2> '" + err + "'";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 2) << status;
  const std::string told = readText(err);
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1) << told;
}

TEST_F(Simulate, RemarksGoToStderrUnlessQuiet) {
  EXPECT_EQ(program("block.yaml --out=out --threads=4 --method newton").err,
            "simulate: --threads = 4: ignored, method newton uses one thread\n");
  EXPECT_EQ(program("block.yaml --out out --threads 4 --method newton --quiet").err, "");
  EXPECT_EQ(program("block.yaml --out out --threads 2").err, "");
}

TEST_F(Simulate, ARefusalInTheRunIsToldWithoutRemarks) {
  std::string scene = kInvertingScene;
  scene.replace(scene.find("steps:"), 6, R"(
solver: {method: paper, threads: 4}
tools: [{name: plate, patch: rigid, shapes: [{type: box, size: [0.015, 0.015, 0.01]}]}]
steps:
  - move: {tool: plate, from: {xyz: [0.02, 0.02, 0.05]}, to: {xyz: [0.02, 0.02, 0.024]}})");
  write("held.yaml", scene);
  expectRefused("held.yaml --out out", "shares nodes with what tool 'plate' holds");
}

TEST_F(Simulate, RefusesNewtonOnTheSixSpringLattice) {
  std::string scene = kScene;
  const std::string place = "  material: {";
  scene.replace(scene.find(place), place.size(), "  model: six_spring\n" + place);
  write("springs.yaml", scene);
  expectRefused("springs.yaml --out out --method newton", "--method = newton: with tissue.model");
}

TEST_F(Simulate, ListsMethodsAndModels) {
  EXPECT_EQ(program("--list-methods").out, "layered\nnewton\npaper\nvbd\nxpbd\nexplicit\n");
  EXPECT_EQ(program("--list-models").out, "elastic\nsix_spring\n");
  EXPECT_EQ(program("--list-methods").code, 0);
  const Outcome help = program("--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("--tolerance X"), std::string::npos);
}

TEST_F(Simulate, AListThatCannotBeWrittenIsNoSuccess) {
  const std::string command =
      std::string("'") + SIMULATE_PATH + "' --list-methods > /dev/full 2> /dev/null";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 2) << status;
}

TEST_F(Simulate, ProgressIsShownOnATerminalOnlyAndNotWhenQuiet) {
  const std::string scene = (folder_ / "block.yaml").string();
  const std::string out = (folder_ / "out").string();
  const auto progress = [&](std::vector<std::string> arguments, bool terminal) {
    arguments.insert(arguments.end(), {scene, "--out", out});
    std::ostringstream out_stream;
    std::ostringstream err_stream;
    EXPECT_EQ(simulate(arguments, out_stream, err_stream, terminal), kExitOk);
    EXPECT_EQ(out_stream.str(), "");
    return err_stream.str();
  };
  EXPECT_NE(progress({}, true).find("increment 2 of 3: OK"), std::string::npos);
  EXPECT_EQ(progress({}, false), "");
  EXPECT_EQ(progress({"--quiet"}, true), "");
}

TEST_F(Simulate, WhatIsToldAfterTheProgressStandsOnALineOfItsOwn) {
  std::string refused = kInvertingScene;
  refused.replace(refused.find("steps:"), 6, R"(
solver: {method: paper}
tools: [{name: plate, patch: rigid, shapes: [{type: box, size: [0.015, 0.015, 0.01]}]}]
steps:
  - settle: {}
  - move: {tool: plate, from: {xyz: [0.02, 0.02, 0.05]}, to: {xyz: [0.02, 0.02, 0.024]}})");
  write("refused.yaml", refused);
  const auto told = [&](const std::string& scene, std::vector<std::string> more) {
    more.insert(more.end(), {(folder_ / scene).string(), "--out", (folder_ / "out").string()});
    std::ostringstream out_stream, err_stream;
    EXPECT_NE(simulate(more, out_stream, err_stream, true), kExitOk);
    return err_stream.str();
  };
  for (const std::string& text :
       {told("refused.yaml", {}), told("block.yaml", {"--max-seconds", "1e-9"})}) {
    EXPECT_NE(text.find(" ms\nsimulate: "), std::string::npos) << text;
    EXPECT_EQ(text.find("\n\n"), std::string::npos) << text;
    EXPECT_EQ(text.back(), '\n') << text;
  }
}

}  // namespace
}  // namespace robot_tissue::test_simulate_words
