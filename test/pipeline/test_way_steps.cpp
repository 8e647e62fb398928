// Load steps are the way's alone, not those of the updates that it is asked for in.
#include <gtest/gtest.h>

#include "pipeline_fixtures.h"

namespace robot_tissue {
namespace {

TEST(LoadSteps, RoundingMakesNoLoadStep) {
  Pipeline pipeline(block(), methodOf("elastic"), {probe()});
  const double step = pipeline.tissue().stepLength();
  const auto place = [&](double down) {
    RobotPose pose;
    pose.links.push_back(Pose(Eigen::Translation3d(kMiddle, kMiddle, kTop + kRadius - down)));
    return pose;
  };
  pipeline.step(place(step));
  pipeline.step(place(2.0 * step + 1e-12));
  EXPECT_EQ(pipeline.report().substeps, 1);
}

}  // namespace
}  // namespace robot_tissue
