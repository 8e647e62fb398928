// Bad tools of the node are refused.
#include "bad_scene.h"

namespace robot_tissue {
namespace {

class BadTools : public ::testing::TestWithParam<BadScene> {};

TEST_P(BadTools, IsRefusedInOneLine) { expectRefusal(kNodeScene, SceneUser::kNode, GetParam()); }

const std::vector<BadScene> kBadTools = {
    {"NodeWithSteps",
     "tools:",
     "steps: [{settle: {}}]\ntools:",
     {"steps = [{settle: {}}]", "only the offline runner"}},
    {"ToolKey",
     "    role: push",
     "    rolle: push",
     {"tools[0].rolle = push", "did you mean role?"}},
    {"ToolFriction",
     "    role: push",
     "    friction: 0.3",
     {"tools[0].friction = 0.3", "sliding contact is not available yet", "left out"}},
    {"ToolBlade", "role: push", "role: blade", {"tools[0].role = blade", "not available yet"}},
    {"ToolRole", "role: push", "role: poke", {"tools[0].role = poke", "must be push"}},
    {"ToolLinkMissing", "    link: tool_tip\n", "", {"tools[0].link is missing", "of the URDF"}},
    {"ToolName", "name: probe", "name: my-probe", {"tools[0].name = my-probe", "letters, digits"}},
    {"ToolNameDigit", "name: probe", "name: 1probe", {"tools[0].name = 1probe", "a letter"}},
    {"ToolLinkAsName",
     "{link: other_tip}",
     "{link: other/tip}",
     {"tools[1].link = other/tip", "needs a name"}},
    {"ToolNameTwice", "{link: other_tip}", "{link: probe}", {"tools[1] = {link: probe}", "unique"}},
    {"ToolPadding",
     "padding: 0.001",
     "padding: -0.001",
     {"tools[0].padding = -0.001", ">= 0 in m"}},
    {"ShapeType",
     "type: sphere",
     "type: cone",
     {"tools[0].shapes[0].type = cone", "one of sphere, cylinder, box, mesh"}},
    {"SphereLength",
     "radius: 0.01,",
     "radius: 0.01, length: 1,",
     {"tools[0].shapes[0].length = 1", "unknown key"}},
    {"SphereRadius", "radius: 0.01,", "radius: 0,", {"tools[0].shapes[0].radius = 0", "> 0 in m"}},
    {"CylinderLength", ", length: 0.05", "", {"tools[0].shapes[1].length is missing", "> 0 in m"}},
    {"BoxSize",
     "[0.01, 0.02, 0.04]",
     "[0.01, 0.0, 0.04]",
     {"tools[0].shapes[2].size[1] = 0.0", "> 0 in m"}},
    {"ShapeXyz",
     "[0.1, 0.2, 0.3], rpy",
     "[0.1, 0.2], rpy",
     {"tools[0].shapes[0].xyz = [0.1, 0.2]", "a list of 3 numbers"}},
    {"ShapeRpy",
     "rpy: [0.1, 0.2, 0.3]",
     "rpy: [0.1, up, 0.3]",
     {"tools[0].shapes[0].rpy[1] = up", "in rad"}},
    {"MeshScale",
     "scale: 0.001",
     "scale: [1, 1, -1]",
     {"tools[0].shapes[3].scale[2] = -1", "a number > 0"}},
    {"MeshScaleMap",
     "scale: 0.001",
     "scale: {x: 1}",
     {"tools[0].shapes[3].scale = {x: 1}", "a number > 0 or a list of 3"}},
    {"MeshMissing",
     "resource: package://robot_tissue/tip.stl, ",
     "",
     {"tools[0].shapes[3].resource is missing", "package://"}},
    {"MeshAddress",
     "package://robot_tissue/tip.stl",
     "http://a.org/tip.stl",
     {"tools[0].shapes[3].resource = http://a.org/tip.stl", "package://"}},
    {"MeshRelative",
     "package://robot_tissue/tip.stl",
     "tip.stl",
     {"tools[0].shapes[3].resource = tip.stl", "a relative path"}},
    {"MeshNotThere",
     "package://robot_tissue/tip.stl",
     "file:///no/such/tip.stl",
     {"tools[0].shapes[3].resource = file:///no/such/tip.stl", "an existing file"}},
};

INSTANTIATE_TEST_SUITE_P(Tools, BadTools, ::testing::ValuesIn(kBadTools), caseName);

}  // namespace
}  // namespace robot_tissue
