// Bad steps of tools are refused.
#include "bad_scene.h"

namespace robot_tissue::test_bad_tool_steps {
namespace {

class BadToolSteps : public ::testing::TestWithParam<BadScene> {};

TEST_P(BadToolSteps, IsRefusedInOneLine) {
  expectRefusal(kToolScene, SceneUser::kRunner, GetParam());
}

const std::string kFirstPlace =
    "from: {xyz: [0.05, 0.05, 0.07], rpy: [0.0, 0.0, 1.5707963267948966]}, ";

const std::vector<BadScene> kBadMoves = {
    {"MoveKey",
     "increments: 20",
     "increment: 20",
     {"steps[0].move.increment = 20", "did you mean"}},
    {"MoveToolMissing",
     "{tool: probe, from",
     "{from",
     {"steps[0].move.tool is missing", "probe, fork, forceps"}},
    {"MoveToolUnknown",
     "{tool: probe, from",
     "{tool: prob, from",
     {"steps[0].move.tool = prob", "one of the tools that have shapes: probe, fork, forceps"}},
    {"MoveToolWithoutShapes",
     "{tool: probe, from",
     "{tool: wrist, from",
     {"steps[0].move.tool = wrist", "has no shapes", "probe, fork, forceps"}},
    {"MoveGrasperWithoutShapes",
     "{tool: probe, from",
     "{tool: gripper, from",
     {"steps[0].move.tool = gripper", "a jaw has no shapes", "probe, fork, forceps"}},
    {"MoveFromNowhere",
     kFirstPlace,
     "",
     {"steps[0].move.from is missing", "stands nowhere", "a map of xyz, rpy, opening"}},
    {"MoveAfterReset",
     "- reset: {}",
     "- reset: {}\n  - move: {tool: probe, to: {xyz: [0, 0, 0.1]}}",
     {"steps[7].move.from is missing", "stands nowhere"}},
    {"MoveToMissing",
     ", to: {xyz: [0.05, 0.05, 0.055]}",
     "",
     {"steps[0].move.to is missing", "a map of xyz"}},
    {"MoveXyzMissing",
     "to: {xyz: [0.05, 0.05, 0.055]}",
     "to: {rpy: [0, 0, 0]}",
     {"steps[0].move.to.xyz is missing", "a list of 3 numbers"}},
    {"MovePlaceKey",
     "to: {xyz: [0.05, 0.05, 0.055]}",
     "to: {xyzz: [0.05, 0.05, 0.055]}",
     {"steps[0].move.to.xyzz = [0.05", "did you mean xyz?"}},
    {"MoveInTimeWithoutTime",
     "increments: 20",
     "increments: 20, duration: 0.5",
     {"steps[0].move.duration = 0.5: must be left out unless the scene has tissue.time"}},
    {"MoveXyzNan",
     "[0.05, 0.05, 0.055]",
     "[0.05, 0.05, .nan]",
     {"steps[0].move.to.xyz[2] = .nan", "a number from -1000 to 1000 in m"}},
    {"MoveRpy",
     "rpy: [0.0, 0.0, 1.5707963267948966]",
     "rpy: [0.0, 0.0]",
     {"steps[0].move.from.rpy = [0.0, 0.0]", "a list of 3 numbers"}},
    {"MoveOpeningOfPush",
     "[0.05, 0.05, 0.055]",
     "[0.05, 0.05, 0.055], opening: 0.01",
     {"steps[0].move.to.opening = 0.01", "only role grasper"}},
    {"MoveOpeningNegative",
     "opening: 0.01",
     "opening: -0.01",
     {"steps[2].move.from.opening = -0.01", "a number from 0 to 1000 in m"}},
    {"MoveIncrementsZero",
     "increments: 20",
     "increments: 0",
     {"steps[0].move.increments = 0", "from 1 to 100000"}},
};

const std::vector<BadScene> kBadPushes = {
    {"PushToolUnknown",
     "push: {tool: probe",
     "push: {tool: prob",
     {"steps[1].push.tool = prob", "probe, fork, forceps"}},
    {"PushToolStandsNowhere",
     "push: {tool: probe",
     "push: {tool: fork",
     {"steps[1].push.tool = fork", "stands nowhere", "one that does: probe"}},
    {"PushForceMissing",
     ", force: [0.0, 0.5, -1.0]",
     "",
     {"steps[1].push.force is missing", "in N"}},
    {"PushForceZero",
     "force: [0.0, 0.5, -1.0]",
     "force: [0.0, 0.0, 0]",
     {"steps[1].push.force = [0.0, 0.0, 0]", "must not be zero"}},
    {"PushIncrements",
     "increments: 4",
     "increments: 1.5",
     {"steps[1].push.increments = 1.5", "a whole number"}},
    {"PushKey", "push: {tool", "push: {to: 1, tool", {"steps[1].push.to = 1", "unknown key"}},
};

const std::vector<BadScene> kBadGrasps = {
    {"GraspOfPush",
     "grasp: {tool: forceps}",
     "grasp: {tool: probe}",
     {"steps[3].grasp.tool = probe", "role grasper: forceps"}},
    {"GraspStandsNowhere",
     "- push: {tool: probe, force: [0.0, 0.5, -1.0], increments: 4}",
     "- grasp: {tool: forceps}",
     {"steps[1].grasp.tool = forceps", "stands nowhere", "one that does: probe"}},
    {"GraspWord",
     "grasp: {tool: forceps}",
     "grasp: forceps",
     {"steps[3].grasp = forceps", "must be a map of tool"}},
    {"ReleaseToolUnknown",
     "[forceps, probe]",
     "[forceps, fork]",
     {"steps[5].release.tools[1] = fork", "stands nowhere", "one that does: forceps, probe"}},
    {"ReleaseToolTwice",
     "[forceps, probe]",
     "[forceps, forceps]",
     {"steps[5].release.tools[1] = forceps", "twice"}},
    {"ReleaseToolAfterReset",
     "- reset: {}",
     "- reset: {}\n  - release: {tools: [probe]}",
     {"steps[7].release.tools[0] = probe", "no tool stands"}},
};

INSTANTIATE_TEST_SUITE_P(Moves, BadToolSteps, ::testing::ValuesIn(kBadMoves), caseName);
INSTANTIATE_TEST_SUITE_P(Pushes, BadToolSteps, ::testing::ValuesIn(kBadPushes), caseName);
INSTANTIATE_TEST_SUITE_P(Grasps, BadToolSteps, ::testing::ValuesIn(kBadGrasps), caseName);

}  // namespace
}  // namespace robot_tissue::test_bad_tool_steps
