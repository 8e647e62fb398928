// Parameters that change while a node runs, of scenes of several kinds: a node that is started
// again has them, and takes them.
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <memory>
#include <string>

#include "robot_tissue/ros/live_parameters.h"

namespace robot_tissue::test_live_parameters {
namespace {

// The place of a node, without the node.
class LiveScene : public ::testing::Test {
 protected:
  void SetUp() override {
    XmlRpc::XmlRpcValue scene;
    ASSERT_TRUE(ros::param::get("/good_scene", scene));
    ros::param::set(node_.getNamespace(), scene);
    spinner_.start();
  }
  void TearDown() override {
    spinner_.stop();
    ros::param::del(node_.getNamespace());
  }

  void start() {
    parameters_ = readNodeParameters(node_);
    live_ = std::make_unique<LiveParameters>(
        node_, parameters_, [this](const NodeParameters& wanted) { parameters_ = wanted; });
  }

  // The modulus that it is then.
  double setModulus(double young_modulus) {
    dynamic_reconfigure::Reconfigure call;
    call.request.config.doubles.resize(1);
    call.request.config.doubles[0].name = "young_modulus";
    call.request.config.doubles[0].value = young_modulus;
    EXPECT_TRUE(ros::service::call(node_.getNamespace() + "/set_parameters", call));
    for (const auto& each : call.response.config.doubles) {
      if (each.name == "young_modulus") return each.value;
    }
    return 0.0;
  }

  ros::NodeHandle node_{"/live"};
  ros::AsyncSpinner spinner_{1};
  NodeParameters parameters_;
  std::unique_ptr<LiveParameters> live_;
};

TEST_F(LiveScene, AModulusInThePlaceOfAPresetsIsThereAtTheNextStart) {
  XmlRpc::XmlRpcValue material;
  material["preset"] = "brain";
  material["tear_stretch"] = 1.5;
  node_.setParam("tissue/material", material);
  start();
  const Material before = parameters_.scene.tissue.material;
  EXPECT_EQ(setModulus(3000.0), 3000.0);
  const Material after = readNodeParameters(node_).scene.tissue.material;
  EXPECT_EQ(after.young_modulus, 3000.0);
  EXPECT_EQ(after.poisson_ratio, before.poisson_ratio);
  EXPECT_EQ(after.density, before.density);
  EXPECT_EQ(after.law, Material::Law::kFung);
  EXPECT_EQ(after.stiffening, before.stiffening);
  EXPECT_EQ(after.tear_stretch, 1.5);
}

// As at the start.
TEST_F(LiveScene, AModulusTooSoftForAMembraneIsRefused) {
  XmlRpc::XmlRpcValue membrane;
  membrane["thickness"] = 0.001;
  membrane["young_modulus"] = 1e9;
  XmlRpc::XmlRpcValue membranes;
  membranes[0] = membrane;
  node_.setParam("tissue/membranes", membranes);
  start();
  EXPECT_EQ(setModulus(1.0), 1e4);
  EXPECT_EQ(parameters_.scene.tissue.material.young_modulus, 1e4);
  EXPECT_EQ(setModulus(25.0), 25.0);
  EXPECT_EQ(readNodeParameters(node_).scene.tissue.material.young_modulus, 25.0);
}

TEST(LiveModulus, RegionsAndMembranesWithoutANameAreToldByTheirPlace) {
  TissueConfig tissue;
  tissue.spacing = 0.01;
  tissue.regions.resize(2);
  for (Region& region : tissue.regions) region.own_modulus = true;
  tissue.regions[0].name = "stone";
  tissue.regions[0].material.young_modulus = 1e5;
  tissue.regions[1].material.young_modulus = 1e3;
  tissue.membranes.resize(1);
  tissue.membranes[0].thickness = 1e-3;
  tissue.membranes[0].young_modulus = 1e8;
  const auto refusal = [&](double young_modulus) -> std::string {
    try {
      requireContrasts(young_modulus, tissue);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(1e4), "");
  EXPECT_NE(refusal(1e-2).find("of region 'stone', 100000 Pa"), std::string::npos);
  EXPECT_NE(refusal(1e10).find("of tissue.regions[1], 1000 Pa"), std::string::npos);
  EXPECT_NE(refusal(0.5).find("beside tissue.membranes[0] of 100000000 Pa"), std::string::npos);
}

}  // namespace
}  // namespace robot_tissue::test_live_parameters
