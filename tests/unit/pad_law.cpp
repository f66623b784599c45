// The pad's law with and without its tension cut-off, and its share per cell.
#include "proto/pad/pad_law.hpp"

#include <gtest/gtest.h>

using proto::PadLaw;

namespace {

TEST(PadLaw, is_spring_and_dashpot) {
  const PadLaw law{100.0, 10.0, 0.0, false};
  EXPECT_DOUBLE_EQ(law.force(-0.5, 2.0), -30.0);
  EXPECT_DOUBLE_EQ(law.force(0.5, 2.0), 70.0) << "it pulls as it presses";
  EXPECT_TRUE(law.engaged(0.5, 2.0));
}

TEST(PadLaw, with_the_cut_off_only_the_clip_pulls) {
  const PadLaw law{100.0, 10.0, 20.0, true};
  EXPECT_DOUBLE_EQ(law.force(-0.5, 0.0), -50.0);
  EXPECT_DOUBLE_EQ(law.force(0.1, 0.0), 10.0) << "relief of the preload";
  EXPECT_DOUBLE_EQ(law.force(0.2, 0.0), 20.0) << "continuous where it lets go";
  EXPECT_DOUBLE_EQ(law.force(5.0, 3.0), 20.0);
  EXPECT_TRUE(law.engaged(0.2, 0.0));
  EXPECT_FALSE(law.engaged(0.21, 0.0));
  EXPECT_FALSE(law.engaged(0.0, 2.1)) << "the dashpot counts";
}

}  // namespace
