// Parameters that change while the node runs: what each does, and what is refused.
#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <rosgraph_msgs/Log.h>

#include <cstdlib>
#include <set>
#include <utility>

#include "documents.h"
#include "node_fixture.h"

namespace robot_tissue::test_reconfigure {
namespace {

using dynamic_reconfigure::Config;
using Values = std::map<std::string, double>;

constexpr double kDepth = 0.003;  // m

Values valuesOf(const Config& config) {
  Values values;
  for (const auto& each : config.doubles) values[each.name] = each.value;
  return values;
}

Config configOf(const Values& values) {
  Config config;
  for (const auto& [name, value] : values) {
    dynamic_reconfigure::DoubleParameter parameter;
    parameter.name = name;
    parameter.value = value;
    config.doubles.push_back(parameter);
  }
  return config;
}

class Reconfigure : public NodeTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ros::service::waitForService("/tissue/set_parameters", ros::Duration(kDeadline)));
    subscribe<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", descriptions_);
    subscribe<Config>("parameter_updates", updates_);
    subscribers_.push_back(node_.subscribe<rosgraph_msgs::Log>(
        "/rosout", 100, [this](const rosgraph_msgs::LogConstPtr& log) {
          if (log->name == "/tissue" && log->level >= rosgraph_msgs::Log::WARN) {
            warnings_.push_back(log->msg);
          }
        }));
    ASSERT_TRUE(waitFor([this] { return descriptions_ && updates_; }));
    at_start_ = valuesOf(descriptions_->dflt);
    set(at_start_);
    press(-0.01);
    warnings_.clear();
  }

  // The values that the node answers with.
  static Values send(const Config& config) {
    dynamic_reconfigure::Reconfigure call;
    call.request.config = config;
    EXPECT_TRUE(ros::service::call("/tissue/set_parameters", call));
    return valuesOf(call.response.config);
  }
  static Values set(const Values& values) { return send(configOf(values)); }

  std::vector<geometry_msgs::TransformStamped> transforms() const override {
    auto all = NodeTest::transforms();
    all[1].transform.translation.x += x_;
    return all;
  }

  // Drags the probe along x.
  void dragTo(double x) {
    while (x - x_ > 1e-9) {
      x_ += 0.0005;
      follow();
    }
  }

  // Of the tool's touches: sum of their friction over that of their normal forces. The wrench
  // itself has a part across the way without friction, too: the lattice is no smooth plane.
  double frictionRatio() {
    contacts_.reset();
    if (!waitForContacts()) return std::nan("");
    double friction = 0.0, normal = 0.0;
    for (const Touch& touch : contacts_->contacts[0].touches) {
      const auto& force = touch.friction_force;
      friction += std::hypot(force.x, std::hypot(force.y, force.z));
      normal += touch.normal_force;
    }
    return friction / normal;
  }

  void expectRefused(const Config& config, const std::string& key, const std::string& allowed) {
    warnings_.clear();
    EXPECT_EQ(send(config), at_start_);
    ASSERT_TRUE(waitFor([this] { return !warnings_.empty(); }));
    EXPECT_EQ(warnings_.size(), 1U);
    EXPECT_EQ(warnings_[0].find('\n'), std::string::npos) << warnings_[0];
    EXPECT_NE(warnings_[0].find(key), std::string::npos) << warnings_[0];
    EXPECT_NE(warnings_[0].find(allowed), std::string::npos) << warnings_[0];
    EXPECT_EQ(valuesOf(*updates_), at_start_);
  }

  // Three wrenches in a row that are farther apart than a tenth of a second, or none of them.
  bool waitForGaps(bool long_ones) {
    std::vector<ros::Time> stamps;
    const ros::Subscriber listener = node_.subscribe<geometry_msgs::WrenchStamped>(
        "/tissue/probe/measured_cf", 100, [&](const geometry_msgs::WrenchStampedConstPtr& message) {
          stamps.push_back(message->header.stamp);
        });
    return waitFor([&] {
      if (stamps.size() < 4) return false;
      bool all = true;
      for (std::size_t i = stamps.size() - 3; i < stamps.size(); ++i) {
        all = all && ((stamps[i] - stamps[i - 1]).toSec() >= 0.1) == long_ones;
      }
      return all;
    });
  }

  double arrowLength() {
    const Points& ends = markers_["contact_forces"].points;
    return ends.size() < 2 ? 0.0
                           : std::hypot(ends[1].x - ends[0].x,
                                        std::hypot(ends[1].y - ends[0].y, ends[1].z - ends[0].z));
  }

  boost::shared_ptr<const dynamic_reconfigure::ConfigDescription> descriptions_;
  boost::shared_ptr<const Config> updates_;
  std::vector<std::string> warnings_;
  Values at_start_;
  double x_ = 0.0;  // m
};

TEST_F(Reconfigure, IsAsDocumented) {
  std::set<std::string> documented, described, ranged;
  for (const DocumentedWord& each :
       documentedWords(std::string(ROBOT_TISSUE_SOURCE_DIR) + "/doc/node.md", "live parameter")) {
    documented.insert(each.word);
  }
  ASSERT_EQ(descriptions_->groups.size(), 1U);
  for (const auto& each : descriptions_->groups[0].parameters) described.insert(each.name);
  EXPECT_EQ(described, documented);
  const Values least = valuesOf(descriptions_->min), most = valuesOf(descriptions_->max);
  for (const auto& [name, value] : at_start_) {
    EXPECT_GE(value, least.at(name)) << name;
    EXPECT_LE(value, most.at(name)) << name;
  }
  EXPECT_EQ(at_start_.at("young_modulus"), 1e4);
  EXPECT_EQ(at_start_.at("friction"), 0.3);
}

// As near as forces of one pose are, whichever way touches came to it.
TEST_F(Reconfigure, TwiceTheModulusIsTwiceTheForce) {
  constexpr double kSame = 0.05;  // of the force
  const double soft = press(kDepth).wrench.force.z;
  ASSERT_GT(std::abs(soft), 0.01);
  EXPECT_EQ(set({{"young_modulus", 2e4}}).at("young_modulus"), 2e4);
  EXPECT_NEAR(follow().wrench.force.z, 2.0 * soft, kSame * std::abs(2.0 * soft));
  double kept = 0.0;
  EXPECT_TRUE(node_.getParam("/tissue/tissue/material/young_modulus", kept));
  EXPECT_EQ(kept, 2e4);
  set({{"young_modulus", 1e4}});
  EXPECT_NEAR(follow().wrench.force.z, soft, kSame * std::abs(soft));
}

TEST_F(Reconfigure, OneWrongValueLeavesAllAsItIs) {
  const auto before = press(kDepth).wrench;
  expectRefused(configOf({{"young_modulus", -1.0}, {"force_scale", 0.05}}), "young_modulus = -1",
                "must be a number from 0.001 to 1e+13 in Pa");
  expectRefused(configOf({{"rate", std::nan("")}}), "rate = ", "must be a number from 0.01");
  expectRefused(
      configOf({{"spacing", 0.01}, {"friction", 0.1}}), "spacing = 0.01",
      "young_modulus, tolerance, max_ms, friction, rate, marker_rate, force_scale, color");
  Config word;
  word.strs.resize(1);
  word.strs[0].name = "friction";
  word.strs[0].value = "much";
  expectRefused(word, "friction = much", "must be a number from 0 to 1000");
  EXPECT_EQ(follow().wrench.force.z, before.force.z);
  double kept = 0.0;
  EXPECT_TRUE(node_.getParam("/tissue/tissue/material/young_modulus", kept));
  EXPECT_EQ(kept, 1e4);
  EXPECT_FALSE(node_.hasParam("/tissue/force_scale"));
}

TEST_F(Reconfigure, WithoutFrictionNothingIsDragged) {
  press(kDepth);
  dragTo(0.005);
  EXPECT_NEAR(frictionRatio(), 0.3, 0.05);
  set({{"friction", 0.0}});
  follow();
  EXPECT_LT(frictionRatio(), 1e-9);  // of a tool that stands
  dragTo(0.008);
  EXPECT_LT(frictionRatio(), 1e-9);
  set({{"friction", 0.2}});
  dragTo(0.012);
  EXPECT_NEAR(frictionRatio(), 0.2, 0.05);
}

TEST_F(Reconfigure, PosesAreFollowedAtTheRate) {
  EXPECT_TRUE(waitForGaps(false));
  set({{"rate", 5.0}});
  EXPECT_TRUE(waitForGaps(true));
  set({{"rate", 100.0}});
  EXPECT_TRUE(waitForGaps(false));
}

// A hundred seconds a pose: who waits for that does not see it before the deadline.
TEST_F(Reconfigure, ALostRobotIsToldOfAtALowRateToo) {
  set({{"rate", 0.01}});
  publishes_transform_ = false;
  EXPECT_TRUE(waitFor([this] { return state_->status == "STALE"; }));
  publishes_transform_ = true;
  EXPECT_TRUE(waitFor([this] { return state_->status == "OK"; }));
  diagnostics_.clear();
  EXPECT_TRUE(waitFor([this] { return diagnostics_.count("tissue: transforms") > 0; }));
  set({{"rate", 100.0}});
}

TEST_F(Reconfigure, ForceScaleIsTheLengthOfAnArrowOverItsForce) {
  const auto& force = press(kDepth).wrench.force;
  const double newtons = std::hypot(force.x, std::hypot(force.y, force.z));
  const auto is_long = [&](double scale) {
    return waitFor(
        [&] { return std::abs(arrowLength() - scale * newtons) < 1e-3 * newtons * scale; });
  };
  EXPECT_TRUE(is_long(at_start_.at("force_scale")));
  set({{"force_scale", 0.04}});
  EXPECT_TRUE(is_long(0.04)) << arrowLength() << " m for " << newtons << " N";
}

TEST_F(Reconfigure, TheColorTellsSomethingElse) {
  const auto color = [](const std::string& name) {
    Config config;
    config.strs.resize(1);
    config.strs[0].name = "color";
    config.strs[0].value = name;
    return config;
  };
  const auto described = std::find_if(descriptions_->groups[0].parameters.begin(),
                                      descriptions_->groups[0].parameters.end(),
                                      [](const auto& each) { return each.name == "color"; });
  ASSERT_NE(described, descriptions_->groups[0].parameters.end());
  EXPECT_EQ(described->type, "str");
  for (const char* name : {"'none'", "'displacement'", "'strain'", "'pressure'"}) {
    EXPECT_NE(described->edit_method.find(name), std::string::npos) << name;
  }
  press(kDepth);
  const auto has_legend = [this] { return !markers_["legend"].points.empty(); };
  EXPECT_FALSE(has_legend());
  send(color("displacement"));
  EXPECT_TRUE(waitFor(has_legend));
  std::string kept;
  EXPECT_TRUE(node_.getParam("/tissue/color", kept));
  EXPECT_EQ(kept, "displacement");
  dynamic_reconfigure::Reconfigure call;
  call.request.config = color("blue");
  warnings_.clear();
  EXPECT_TRUE(ros::service::call("/tissue/set_parameters", call));
  EXPECT_EQ(call.response.config.strs.at(0).value, "displacement");
  ASSERT_TRUE(waitFor([this] { return !warnings_.empty(); }));
  EXPECT_NE(warnings_[0].find("must be one of none, displacement, strain, pressure"),
            std::string::npos)
      << warnings_[0];
  send(color("none"));
  EXPECT_TRUE(waitFor([&] { return !has_legend(); }));
}

// The client of the documents, which reads the description of the choice.
TEST_F(Reconfigure, DynparamSetsTheColorByItsName) {
  const auto dynparam = [](const std::string& color) {
    const std::string command = "timeout 20 rosrun dynamic_reconfigure dynparam set /tissue color ";
    return std::system((command + color).c_str());
  };
  EXPECT_EQ(dynparam("strain"), 0);
  std::string kept;
  EXPECT_TRUE(node_.getParam("/tissue/color", kept));
  EXPECT_EQ(kept, "strain");
  EXPECT_EQ(dynparam("none"), 0);
}

TEST_F(Reconfigure, ToleranceHoldsFromTheNextSolveOn) {
  press(kDepth);
  set({{"tolerance", 1e-4}, {"max_ms", 5000.0}});
  EXPECT_TRUE(waitFor([this] {
    return state_->error_estimate > 0.0 && state_->error_estimate <= 1e-4;
  })) << state_->error_estimate;
  EXPECT_EQ(state_->status, "OK") << state_->message;
}

}  // namespace
}  // namespace robot_tissue::test_reconfigure
