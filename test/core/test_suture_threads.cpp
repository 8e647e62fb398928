// The thread of a suture: its law, what it hangs on, and its bytes.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>

#include "elastic_fixtures.h"
#include "saving/saved_sutures.h"
#include "surface/nearest_point.h"
#include "suture_fixtures.h"
#include "tissue/threads.h"

namespace robot_tissue::test_suture_threads {
namespace {

// `from` is carried by nodes 0 and 1, `to` by nodes 1 and 2: node 1 has a share of both.
SutureThread threadOnNodes(double rest_length) {
  SutureThread thread;
  thread.name = "s1";
  thread.from = {Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, -0.001), {{0, 0.7}, {1, 0.3}}};
  thread.to = {Vec3(0.02, 0.0, 0.0), Vec3(0.02, 0.0, -0.001), {{1, 0.1}, {2, 0.9}}};
  thread.rest_length = thread.length = rest_length;
  thread.stiffness = 200.0;
  return thread;
}

std::vector<Vec3> shaken(unsigned seed) {
  Shaker shaker(seed);
  std::vector<Vec3> displacement;
  for (int node = 0; node < 3; ++node) displacement.push_back(shaker.displacement(0.01));
  return displacement;
}

TEST(Thread, PullsWithTheSlopeOfItsEnergy) {
  constexpr double kStep = 1e-7;
  for (const double rest_length : {0.0, 0.005, 1.0}) {
    const ContactSpring spring = springOf(threadOnNodes(rest_length));
    for (unsigned seed = 1; seed < 20; ++seed) {
      const std::vector<Vec3> at_rest = shaken(seed);
      for (const NodeWeight& carrier : spring.carriers) {
        for (int axis = 0; axis < 3; ++axis) {
          std::vector<Vec3> more = at_rest, less = at_rest;
          more[at(carrier.node)][axis] += kStep;
          less[at(carrier.node)][axis] -= kStep;
          const double slope = (energyOf(spring, more) - energyOf(spring, less)) / (2.0 * kStep);
          EXPECT_NEAR(carrier.weight * forceOf(spring, at_rest)[axis], -slope, 1e-6);
          const Vec3 bend = (forceOf(spring, more) - forceOf(spring, less)) / (2.0 * kStep);
          const Vec3 wanted = -carrier.weight * stiffnessOf(spring, at_rest).col(axis);
          EXPECT_LT((bend - wanted).norm(), 1e-3);
        }
      }
    }
  }
}

TEST(Thread, HasWeightsThatCancelAndAStiffnessThatIsNotNegative) {
  const ContactSpring spring = springOf(threadOnNodes(0.005));
  double sum = 0.0;
  for (const NodeWeight& carrier : spring.carriers) sum += carrier.weight;
  EXPECT_NEAR(sum, 0.0, 1e-15);
  EXPECT_NEAR(endsOf(spring), 0.7 + 0.2 + 0.9, 1e-15);
  for (unsigned seed = 1; seed < 20; ++seed) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(stiffnessOf(spring, shaken(seed)));
    EXPECT_GE(solver.eigenvalues().minCoeff(), -1e-9);
    EXPECT_LE(solver.eigenvalues().maxCoeff(), spring.stiffness * (1.0 + 1e-12));
  }
}

TEST(Thread, OfEndsAtOnePlaceStaysFinite) {
  for (const double rest_length : {0.0, 0.005}) {
    const ContactSpring spring = springOf(threadOnNodes(rest_length));
    EXPECT_EQ(forceAt(spring, Vec3::Zero()), Vec3(Vec3::Zero()));
    const double wanted = rest_length > 0.0 ? 0.0 : 200.0;
    EXPECT_EQ(stiffnessAt(spring, Vec3::Zero()),
              Eigen::Matrix3d(wanted * Eigen::Matrix3d::Identity()));
  }
}

// Both sides of the cut have a surface there; the end's own side is told by what is inside it.
TEST(Thread, StaysOnItsSideOfACut) {
  const TissueConfig config = barOf();
  Tissue tissue(config, solverWith("newton"));
  tissue.cut(planeAt(kCutAt));
  for (const double side : {-1.0, 1.0}) {
    SutureThread::End end;
    end.rest = Vec3(kCutAt, 0.01, 0.02);
    end.inside = end.rest + Vec3(side * 1e-3, 0.0, -1e-3);
    ASSERT_TRUE(bindEnd(tissue.surface(), kSutureSpacing, 0.0, end));
    double x = 0.0;
    for (const NodeWeight& carrier : end.carriers) {
      x += carrier.weight * restPosition(tissue.lattice(), *tissue.state().cells, carrier.node).x();
    }
    EXPECT_GT(side * (x - kCutAt), -1e-9);
    const std::vector<int> pieces = tissue.pieceOfNodes();
    const int piece = pieces[at(tissue.lattice().node(side < 0.0 ? 1 : 8, 2, 2))];
    for (const NodeWeight& carrier : end.carriers) EXPECT_EQ(pieces[at(carrier.node)], piece);
  }
}

// Also one that would reach across the cut; and it pulls in the middle of what it holds.
TEST(Thread, BitesOnItsSideOfACut) {
  Tissue tissue(barOf(), solverWith("newton"));
  tissue.cut(planeAt(kCutAt));
  for (const double bite : {1e-4, 2e-3, 6e-3}) {
    SutureThread::End end;
    end.rest = Vec3(kCutAt - 0.002, 0.01, 0.02);
    end.inside = end.rest - Vec3(0.0, 0.0, 1e-3);
    ASSERT_TRUE(bindEnd(tissue.surface(), kSutureSpacing, bite, end));
    double sum = 0.0;
    Vec3 middle = Vec3::Zero();
    for (const NodeWeight& carrier : end.carriers) {
      EXPECT_GT(carrier.weight, 0.0);
      sum += carrier.weight;
      middle +=
          carrier.weight * restPosition(tissue.lattice(), *tissue.state().cells, carrier.node);
      EXPECT_EQ(tissue.pieceOfNodes()[at(carrier.node)], 0);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_LT((middle - (end.rest + end.to_middle)).norm(), 1e-12);
    EXPECT_LT(end.to_middle.norm(), bite);
  }
}

TEST(Thread, IsDroppedWhereItsTissueIsGone) {
  const Tissue tissue(barOf(), solverWith("newton"));
  TissueConfig smaller = barOf();
  smaller.shape.max().x() = 0.03;
  const Tissue left(smaller, solverWith("newton"));
  const auto threadTo = [&](double x) {
    SutureThread thread;
    thread.from.rest = Vec3(0.01, 0.01, 0.02);
    thread.to.rest = Vec3(x, 0.01, 0.02);
    EXPECT_TRUE(bindEnd(tissue.surface(), kSutureSpacing, 0.0, thread.from));
    EXPECT_TRUE(bindEnd(tissue.surface(), kSutureSpacing, 0.0, thread.to));
    return thread;
  };
  Threads threads;
  threads.add(threadTo(0.025));
  threads.add(threadTo(0.04));
  EXPECT_TRUE(threads.rebind(tissue.surface(), kSutureSpacing).empty());
  EXPECT_EQ(threads.all().size(), 2U);
  EXPECT_FALSE(threads.rebind(left.surface(), kSutureSpacing).empty());
  ASSERT_EQ(threads.all().size(), 1U);
  EXPECT_EQ(threads.all()[0].to.rest, Vec3(0.025, 0.01, 0.02));
}

// Nodes that it was on may be gone since.
TEST(Thread, ThatIsBrokenIsLeftAloneByOtherShapes) {
  SutureThread broken = threadOnNodes(0.005);
  broken.broken = true;
  Threads threads;
  threads.add(broken);
  threads.loosen(shaken(1));
  threads.drawIn(0.5);
  EXPECT_EQ(threads.all()[0].length, broken.length);
}

std::string bytesOf(const std::vector<SutureThread>& threads) {
  ByteWriter out;
  putSutures(threads, out);
  return out.bytes();
}

TEST(Thread, ComesBackFromItsBytes) {
  SutureThread other = threadOnNodes(0.0);
  other.name = "s2";
  other.break_force = 0.5;
  other.broken = true;
  const std::string bytes = bytesOf({threadOnNodes(0.005), other});
  ByteReader in(bytes);
  const std::vector<SutureThread> back = takeSutures(3, in);
  EXPECT_TRUE(in.isAtEnd());
  EXPECT_EQ(bytesOf(back), bytes);
  EXPECT_TRUE(back[1].broken);
  EXPECT_EQ(back[0].length, 0.005);
}

TEST(Thread, IsRefusedFromDamagedBytes) {
  const auto refusalOf = [](const std::string& bytes, int nodes) {
    return inputErrorOf([&] {
      ByteReader in(bytes);
      takeSutures(nodes, in);
    });
  };
  const std::string good = bytesOf({threadOnNodes(0.005)});
  EXPECT_EQ(refusalOf(good, 3), "");
  EXPECT_TRUE(mentions(refusalOf(good, 2), "node that is not there"));
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_TRUE(isOneLine(refusalOf(good.substr(0, size), 3)));
  }
  EXPECT_TRUE(
      mentions(refusalOf(bytesOf({threadOnNodes(0.0), threadOnNodes(0.0)}), 3), "one name"));
  const auto refused = [&](const std::function<void(SutureThread&)>& spoil) {
    SutureThread thread = threadOnNodes(0.005);
    spoil(thread);
    return isOneLine(refusalOf(bytesOf({thread}), 3));
  };
  EXPECT_TRUE(refused([](SutureThread& thread) { thread.stiffness = 0.0; }));
  EXPECT_TRUE(refused([](SutureThread& thread) { thread.stiffness = std::nan(""); }));
  EXPECT_TRUE(refused([](SutureThread& thread) { thread.rest_length = -1.0; }));
  EXPECT_TRUE(refused([](SutureThread& thread) { thread.name = "a,b"; }));
  EXPECT_TRUE(refused([](SutureThread& thread) { thread.from.carriers[0].weight = 0.6; }));
  // Where what was between its ends is gone, these may have come to one point.
  SutureThread drawn_together = threadOnNodes(0.005);
  drawn_together.from = drawn_together.to;
  EXPECT_EQ(refusalOf(bytesOf({drawn_together}), 3), "");
}

}  // namespace
}  // namespace robot_tissue::test_suture_threads
