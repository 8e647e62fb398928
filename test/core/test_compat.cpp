// What older compilers are given in place of what they lack does the same.
#include <gtest/gtest.h>

#include "robot_tissue/core/compat.h"

namespace robot_tissue::test_compat {
namespace {

TEST(Compat, NumbersAreReadAlike) {
  for (const char* word :
       {"0",        "-1",   "2.5",   "-.5", "1e3", "1E-3", "1e+2", "0.1", "123456789.123456789",
        "4.9e-300", "",     "+1",    "1 ",  " 1",  "1,5",  "1e",   "e1",  "--1",
        "1.2.3",    "0x10", "1e999", "-",   "a",   "1f"}) {
    double one = 0.0, other = 0.0;
    const bool is_number = compat::parsed<double>(word, one);
    EXPECT_EQ(compat::parsedByStream(word, other), is_number) << word;
    EXPECT_EQ(is_number ? one : 0.0, is_number ? other : 0.0) << word;
  }
}

}  // namespace
}  // namespace robot_tissue::test_compat
