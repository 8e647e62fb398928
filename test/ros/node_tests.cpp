// The tests of the running node, in one program: each launch file starts those that its filter
// names.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cstdio>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "node_tests");
  const ros::NodeHandle keep_alive;
  const int result = RUN_ALL_TESTS();
  const bool any = testing::UnitTest::GetInstance()->test_to_run_count() > 0;
  if (!any) std::fprintf(stderr, "node_tests: the filter names no test\n");
  return any ? result : 1;
}
