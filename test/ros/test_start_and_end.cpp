// A node's first and last moments, of a process of its own.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "node_fixture.h"

namespace robot_tissue::test_start_and_end {
namespace {

// s, wall time; of a node that does not stop while it settles.
constexpr double kLongDeadline = 90.0;

class NodeProcess {
 public:
  // Of this test's master, or of another one.
  explicit NodeProcess(const std::string& master = "") {
    int ends[2];
    if (pipe(ends) != 0) return;
    pid_ = fork();
    if (pid_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      close(ends[0]);
      if (!master.empty()) setenv("ROS_MASTER_URI", master.c_str(), 1);
      execl(NODE_PATH, NODE_PATH, "__name:=tissue", static_cast<char*>(nullptr));
      _exit(127);
    }
    close(ends[1]);
    output_ = ends[0];
    fcntl(output_, F_SETFL, O_NONBLOCK);
  }
  ~NodeProcess() {
    if (pid_ > 0 && !hasEnded()) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(output_);
  }
  NodeProcess(const NodeProcess&) = delete;
  NodeProcess& operator=(const NodeProcess&) = delete;

  void signal(int number) const { kill(pid_, number); }
  bool hasEnded() {
    read();
    if (!ended_) ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
    return ended_;
  }
  int status() const { return status_; }
  const std::string& read() {
    char buffer[4096];
    for (ssize_t count = 0; (count = ::read(output_, buffer, sizeof(buffer))) > 0;) {
      said_.append(buffer, static_cast<std::size_t>(count));
    }
    return said_;
  }

 private:
  pid_t pid_ = -1;
  int output_ = -1, status_ = -1;
  bool ended_ = false;
  std::string said_;
};

bool isRegistered(const std::string& name) {
  ros::V_string nodes;
  return ros::master::getNodes(nodes) && std::find(nodes.begin(), nodes.end(), name) != nodes.end();
}

class Start : public NodeTest {};
class StartAndEnd : public NodeTest, public ::testing::WithParamInterface<int> {};

// Beside a robot that is there, nothing is wrong at any moment.
TEST_P(StartAndEnd, AreQuietAndInOrder) {
  NodeProcess node;
  ASSERT_TRUE(waitFor([&] { return state_ && state_->status == "OK"; })) << node.read();
  ASSERT_TRUE(isRegistered("/tissue"));
  node.signal(GetParam());
  ASSERT_TRUE(waitFor([&] { return node.hasEnded(); }));
  EXPECT_TRUE(WIFEXITED(node.status())) << "ended by a signal";
  EXPECT_EQ(WEXITSTATUS(node.status()), 0);
  EXPECT_FALSE(isRegistered("/tissue"));
  EXPECT_EQ(node.read().find("WARN"), std::string::npos) << node.read();
  EXPECT_EQ(node.read().find("ERROR"), std::string::npos) << node.read();
}

INSTANTIATE_TEST_SUITE_P(Node, StartAndEnd, ::testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const ::testing::TestParamInfo<int>& signal) {
                           return std::string(signal.param == SIGINT    ? "SigInt"
                                              : signal.param == SIGTERM ? "SigTerm"
                                                                        : "SigHup");
                         });

// Less than one wrench in the time that this waits for the end.
TEST_F(Start, BesideSeldomWrenchesTheEndComesAtOnce) {
  ros::param::set("/tissue/wrench_rate", 0.01);
  NodeProcess node;
  int told = 0;
  const ros::Subscriber listener = node_.subscribe<geometry_msgs::WrenchStamped>(
      "/tissue/probe/measured_cf", 10,
      [&told](const geometry_msgs::WrenchStampedConstPtr&) { ++told; });
  EXPECT_TRUE(waitFor([&] {
    return state_ && state_->status == "OK" && listener.getNumPublishers() > 0;
  })) << node.read();
  node.signal(SIGTERM);
  EXPECT_TRUE(waitFor([&] { return node.hasEnded(); }));
  EXPECT_TRUE(WIFEXITED(node.status())) << "ended by a signal";
  EXPECT_LE(told, 1);
  ros::param::del("/tissue/wrench_rate");
}

// Tissue that takes long to come to lie, in the place of the other tests' scene.
class Settling : public Start {
 protected:
  void SetUp() override {
    XmlRpc::XmlRpcValue loose;
    ASSERT_TRUE(ros::param::get("/tissue", scene_));
    ASSERT_TRUE(ros::param::get("/loose", loose));
    ros::param::set("/tissue", loose);
  }
  void TearDown() override { ros::param::set("/tissue", scene_); }

  bool isTold() {
    const std::string& of_solver = diagnostics_["tissue: solver"].message;
    return state_ && state_->status == "SETTLING" && of_solver.find("settles") != std::string::npos;
  }

 private:
  XmlRpc::XmlRpcValue scene_;
};

TEST_F(Settling, IsToldAndTheNodeCanBeStoppedMeanwhile) {
  NodeProcess node;
  ASSERT_TRUE(waitFor([this] { return isTold(); })) << node.read();
  EXPECT_NE(state_->message.find("supports"), std::string::npos) << state_->message;
  for (const char* service : {"/tissue/reset", "/tissue/apply_load", "/tissue/save_state"}) {
    EXPECT_TRUE(ros::service::exists(service, false)) << service;
  }
  node.signal(SIGINT);
  ASSERT_TRUE(waitFor([&] { return node.hasEnded(); }, kLongDeadline)) << node.read();
  EXPECT_TRUE(WIFEXITED(node.status())) << "ended by a signal";
  EXPECT_EQ(WEXITSTATUS(node.status()), 0);
  EXPECT_NE(node.read().find("the tissue settles on its supports"), std::string::npos);
  EXPECT_EQ(node.read().find("the tissue has settled"), std::string::npos) << node.read();
}

TEST_F(Start, WithoutAMasterTheEndIsInOrderToo) {
  NodeProcess node("http://localhost:1");  // nobody's port
  ASSERT_TRUE(waitFor([&] { return node.read().find("master") != std::string::npos; }));
  node.signal(SIGINT);
  ASSERT_TRUE(waitFor([&] { return node.hasEnded(); })) << node.read();
  EXPECT_TRUE(WIFEXITED(node.status())) << "ended by a signal";
  EXPECT_EQ(WEXITSTATUS(node.status()), 0) << node.read();
}

// A robot that never comes is warned about, once.
TEST_F(Start, ARobotThatDoesNotComeIsWarnedAbout) {
  publishes_transform_ = false;
  NodeProcess node;
  const auto warning = [&] { return node.read().find("NO_TRANSFORM"); };
  ASSERT_TRUE(waitFor([&] { return warning() != std::string::npos; }));
  EXPECT_EQ(node.read().find("NO_TRANSFORM", warning() + 1), std::string::npos);
  node.signal(SIGTERM);
  EXPECT_TRUE(waitFor([&] { return node.hasEnded(); }));
}

}  // namespace
}  // namespace robot_tissue::test_start_and_end
