// Values of a few numbers out of many, and what is shared by one pointer.
#include <gtest/gtest.h>

#include <utility>

#include "robot_tissue/core/shared_const.h"
#include "robot_tissue/core/sparse_values.h"

namespace robot_tissue::test_sparse_values {
namespace {

TEST(SparseValues, HasWhatWasAddedAndNothingElse) {
  SparseValues<double> values;
  values.clearFor(1000);
  for (const int number : {999, 0, 500}) values.add(number) = 2.0 * number;
  for (int number = 0; number < 1000; ++number) {
    const double* value = values.find(number);
    const bool is_there = number == 999 || number == 0 || number == 500;
    ASSERT_EQ(value != nullptr, is_there) << number;
    EXPECT_TRUE(!is_there || *value == 2.0 * number);
  }
}

// What was there before does not come back where its room is taken again.
TEST(SparseValues, ForgetsAll) {
  SparseValues<int> values;
  values.clearFor(10);
  values.add(3) = 7;
  values.add(4) = 8;
  values.clearFor(10);
  EXPECT_EQ(values.find(3), nullptr);
  values.add(4) = 9;
  EXPECT_EQ(values.find(3), nullptr);
  EXPECT_EQ(*values.find(4), 9);
  values.clearFor(20);
  for (int number = 0; number < 20; ++number) EXPECT_EQ(values.find(number), nullptr);
}

struct Counted {
  explicit Counted(int* alive) : alive_(alive) { ++*alive_; }
  Counted(const Counted& other) : alive_(other.alive_) { ++*alive_; }
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --*alive_; }
  int* alive_;
};

TEST(SharedConst, LivesAsLongAsAnyOwner) {
  int alive = 0;
  {
    SharedConst<Counted> first{Counted(&alive)};
    EXPECT_EQ(alive, 1);
    SharedConst<Counted> second = first;
    const SharedConst<Counted> third = std::move(first);
    EXPECT_EQ(second.get(), third.get());
    EXPECT_EQ(alive, 1);
    second = SharedConst<Counted>();
    EXPECT_TRUE(second == nullptr);
    EXPECT_TRUE(third != nullptr);
    EXPECT_EQ(alive, 1);
  }
  EXPECT_EQ(alive, 0);
}

TEST(SharedConst, IsItsOwn) {
  int alive = 0;
  SharedConst<Counted> shared{Counted(&alive)};
  const SharedConst<Counted>& same = shared;
  shared = same;
  EXPECT_EQ(alive, 1);
  shared.reset();
  EXPECT_EQ(alive, 0);
}

}  // namespace
}  // namespace robot_tissue::test_sparse_values
